#pragma once

namespace geoprior {

/// Processor time of this process and of its children that have ended: user and system, all
/// threads, s. Unlike the clock it does not grow while other programs are served.
double processor_seconds();

}  // namespace geoprior
