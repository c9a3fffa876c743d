#include "tests/core/allocations.h"

#include <cerrno>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

namespace geoprior::test {

std::optional<std::size_t> allocations_of(const std::function<void()>& body) {
  body();
  return {};
}

}  // namespace geoprior::test

#else

namespace {

thread_local constinit std::size_t allocations_of_thread = 0;

}  // namespace

// Defined in the executable, these come before those of the C library, which keeps the rest (free,
// statistics): the pointers are its own.
extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++allocations_of_thread;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  ++allocations_of_thread;
  return __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) noexcept {
  ++allocations_of_thread;
  return __libc_realloc(old, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++allocations_of_thread;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}

int posix_memalign(void** place, std::size_t alignment, std::size_t size) noexcept {
  *place = memalign(alignment, size);
  return *place == nullptr ? ENOMEM : 0;
}

}  // extern "C"

namespace geoprior::test {

std::optional<std::size_t> allocations_of(const std::function<void()>& body) {
  const std::size_t before = allocations_of_thread;
  body();
  return allocations_of_thread - before;
}

}  // namespace geoprior::test

#endif
