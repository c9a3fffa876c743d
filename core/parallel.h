#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <memory>
#include <type_traits>

namespace geoprior {

/// Refers to a callable `(begin, end)` for the duration of a call: a lambda of any size, no
/// allocation.
class BlockBody {
 public:
  template <class Body>
  requires(!std::same_as<std::remove_cvref_t<Body>, BlockBody> &&
           std::invocable<const Body&, std::size_t, std::size_t>)
      BlockBody(const Body& body)  // NOLINT(google-explicit-constructor): stands in for any lambda
      : object_(std::addressof(body)), call_([](const void* o, std::size_t begin, std::size_t end) {
          (*static_cast<const Body*>(o))(begin, end);
        }) {}
  void operator()(std::size_t begin, std::size_t end) const { call_(object_, begin, end); }

 private:
  const void* object_;
  void (*call_)(const void*, std::size_t, std::size_t);
};

/// Calls `body(begin, end)` for blocks of `block` consecutive indices of [0, n), in parallel (TBB).
/// Blocks do not depend on the thread count, so results are reproducible when blocks write disjoint
/// ranges. Small ranges (one block) run on the calling thread.
void parallel_blocks(std::size_t n, std::size_t block, BlockBody body);

/// Runs `body` with at most `threads` threads (0: all); the limit ends with the call.
void with_threads(int threads, const std::function<void()>& body);

}  // namespace geoprior
