#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace geoprior {
namespace {

TEST(ParallelBlocks, CoverEveryIndexOnce) {
  for (const std::size_t n : {0U, 1U, 7U, 8U, 9U, 1000U}) {
    std::vector<std::atomic<int>> visits(n);
    parallel_blocks(n, 8, [&](std::size_t begin, std::size_t end) {
      EXPECT_LE(end, n);
      EXPECT_LE(end - begin, 8U);
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelBlocks, BlocksDoNotDependOnTheThreadCount) {
  const auto starts = [](int threads) {
    std::vector<std::size_t> end_of(100, 0);
    with_threads(threads, [&] {
      parallel_blocks(100, 13, [&](std::size_t begin, std::size_t end) { end_of[begin] = end; });
    });
    return end_of;
  };
  EXPECT_EQ(starts(1), starts(2));
}

TEST(WithThreads, PassesExceptionsOn) {
  EXPECT_THROW(with_threads(1, [] { throw std::runtime_error("out"); }), std::runtime_error);
}

}  // namespace
}  // namespace geoprior
