#include "tests/core/allocations.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace geoprior::test {
namespace {

TEST(Allocations, AreCountedWhateverAsksForMemory) {
  const auto counted = allocations_of([] {});
  if (!counted) GTEST_SKIP() << "a sanitizer build";
  EXPECT_EQ(counted, 0U);
  std::vector<double> values(3);
  Eigen::MatrixX3d matrix;
  EXPECT_EQ(allocations_of([&] { values.resize(100); }), 1U);
  EXPECT_EQ(allocations_of([&] { values.resize(50); }), 0U);
  EXPECT_EQ(allocations_of([&] { matrix.setZero(10, 3); }), 1U);
  EXPECT_EQ(allocations_of([&] { matrix.setOnes(10, 3); }), 0U);
  struct alignas(64) Line {
    double values[8];
  };
  std::unique_ptr<Line> line;
  EXPECT_EQ(allocations_of([&] { line = std::make_unique<Line>(); }), 1U);
}

}  // namespace
}  // namespace geoprior::test
