#include "testbed/runner/process/processor_time.h"

#include <sys/resource.h>

namespace geoprior {
namespace {

double seconds_of(int whom) {
  rusage use{};
  if (::getrusage(whom, &use) != 0) return 0;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

}  // namespace

double processor_seconds() { return seconds_of(RUSAGE_SELF) + seconds_of(RUSAGE_CHILDREN); }

}  // namespace geoprior
