// Patches of a pattern are continued cell by cell, each by itself.

#include "solvers/sketch/photo/continued_patches.h"

#include <gtest/gtest.h>

namespace geoprior::sketch {
namespace {

constexpr int kColumns = 40, kRows = 24;
const Eigen::Vector3d kRed(200, 40, 30), kBlue(20, 60, 220);

std::size_t pixel(int x, int y) { return static_cast<std::size_t>(y) * kColumns + x; }

/// Red left of column 10, blue right of column 30; what lies between is wanted of either.
ContinuedPatches two_patches(int step, double reach) {
  ContinuedPatches patches(kColumns, kRows, step, 2);
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < 10; ++x) patches.know(pixel(x, y), 0, kRed);
    for (int x = 30; x < kColumns; ++x) patches.know(pixel(x, y), 1, kBlue);
  }
  for (int y = 0; y < kRows; ++y) {
    for (int x = 10; x < 30; ++x) {
      patches.want(pixel(x, y), 0);
      patches.want(pixel(x, y), 1);
    }
  }
  patches.fill(reach);
  return patches;
}

TEST(ContinuedPatches, KeepTheirColoursWhereTheyShareCells) {
  for (const int step : {1, 2, 3, 4}) {
    const ContinuedPatches patches = two_patches(step, 100);
    for (int y = 0; y < kRows; ++y) {
      for (int x = 10; x < 30; ++x) {
        const auto red = patches.colour(pixel(x, y), 0), blue = patches.colour(pixel(x, y), 1);
        ASSERT_TRUE(red && blue) << step << ": " << x << ", " << y;
        EXPECT_LT((*red - kRed).norm(), 1e-3);
        EXPECT_LT((*blue - kBlue).norm(), 1e-3);
      }
    }
  }
}

TEST(ContinuedPatches, EndAtTheirReachInCells) {
  const ContinuedPatches patches = two_patches(2, 3);
  // The last known cell of red has its middle in column 9.
  EXPECT_TRUE(patches.colour(pixel(15, 12), 0).has_value());
  EXPECT_FALSE(patches.colour(pixel(18, 12), 0).has_value());
}

// Grey by the column: between the middles of cells it is as it was.
TEST(ContinuedPatches, AreReadBetweenTheMiddlesOfCells) {
  ContinuedPatches patches(kColumns, kRows, 4, 1);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x)
      patches.know(pixel(x, y), 0, Eigen::Vector3d::Constant(4 * x));
  patches.fill(10);
  for (int x = 2; x < kColumns - 2; ++x) {
    const auto colour = patches.colour(pixel(x, 12), 0);
    ASSERT_TRUE(colour.has_value());
    EXPECT_NEAR((*colour)(1), 4 * x, 0.5);
  }
}

}  // namespace
}  // namespace geoprior::sketch
