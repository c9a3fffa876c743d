#pragma once

#include <optional>

#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// Resident memory of this process from here on, as the kernel counts it (VmHWM, VmRSS).
///
/// Variants run one after the other in one process. So that each is seen by itself, memory that
/// was freed before is given back to the system first (it would be used again unnoticed), and the
/// kernel's high-water mark is set back to what is resident now. `peak - start` is then what came
/// on top of what earlier variants still hold: their prepared methods stay for the benchmark.
class PeakMemory {
 public:
  PeakMemory();
  /// Absent where the kernel does not let a process set its mark back (Linux before 4.0, some
  /// containers, other systems).
  [[nodiscard]] std::optional<MemoryUse> use() const;

 private:
  std::optional<std::uint64_t> start_;
};

}  // namespace geoprior
