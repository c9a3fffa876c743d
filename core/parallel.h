#pragma once

#include <cstddef>
#include <functional>

namespace geoprior {

/// Calls `body(begin, end)` for blocks of `block` consecutive indices of [0, n), in parallel (TBB).
/// Blocks do not depend on the thread count, so results are reproducible when blocks write disjoint
/// ranges. Small ranges (one block) run on the calling thread.
void parallel_blocks(std::size_t n, std::size_t block,
                     const std::function<void(std::size_t, std::size_t)>& body);

/// Runs `body` with at most `threads` threads (0: all); the limit ends with the call.
void with_threads(int threads, const std::function<void()>& body);

}  // namespace geoprior
