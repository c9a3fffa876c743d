#pragma once

namespace geoprior {

/// Lets the C library keep memory that was freed, for the rest of the process: frames are of equal
/// size, and pages given back to the system after each are faulted in again for the next (a third
/// of the time in which a feature is pasted). Does nothing but on glibc.
void keep_freed_memory();

}  // namespace geoprior
