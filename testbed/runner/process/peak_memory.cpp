#include "testbed/runner/process/peak_memory.h"

#include <algorithm>
#include <fstream>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace geoprior {
namespace {

/// A line "VmHWM:     1234 kB" of /proc/self/status, in bytes.
std::optional<std::uint64_t> status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string name; status >> name; status.ignore(4096, '\n')) {
    std::uint64_t kilobytes = 0;
    if (name == key + ":" && status >> kilobytes) return 1024 * kilobytes;
  }
  return std::nullopt;
}

void give_back_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/// "5" sets VmHWM to VmRSS (proc(5)).
bool reset_high_water_mark() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

}  // namespace

PeakMemory::PeakMemory() {
  give_back_freed_memory();
  if (reset_high_water_mark()) start_ = status_bytes("VmRSS");
}

std::optional<MemoryUse> PeakMemory::use() const {
  const std::optional<std::uint64_t> peak = status_bytes("VmHWM");
  if (!start_ || !peak) return std::nullopt;
  return MemoryUse{*start_, std::max(*peak, *start_)};
}

}  // namespace geoprior
