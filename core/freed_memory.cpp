#include "core/freed_memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace geoprior {

void keep_freed_memory() {
#ifdef M_TRIM_THRESHOLD
  constexpr int kBytes = 1 << 30;
  // Setting either ends glibc's own adjustment of both.
  mallopt(M_TRIM_THRESHOLD, kBytes);
  mallopt(M_MMAP_THRESHOLD, kBytes);
#endif
}

}  // namespace geoprior
