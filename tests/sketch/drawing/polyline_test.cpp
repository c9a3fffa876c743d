#include "models/sketch/drawing/polyline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace geoprior::sketch {
namespace {

const std::vector<Eigen::Vector2d> kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};

// Beyond its ends an open stroke goes on straight, so that it can be joined to what it was drawn up
// to; a closed one has no ends, and beyond the corner where it closes the corner is the nearest.
TEST(Beside, OnlyOpenStrokesGoOnBeyondTheirEnds) {
  const Eigen::Vector2d below(-0.5, -0.5);
  const std::vector<Eigen::Vector2d> open(kSquare.begin(), kSquare.end() - 1);
  EXPECT_DOUBLE_EQ(beside(open, below).distance, -0.5);
  EXPECT_DOUBLE_EQ(beside(open, below).along, -0.5);
  EXPECT_DOUBLE_EQ(beside(kSquare, below).distance, -std::sqrt(0.5));
  EXPECT_GE(beside(kSquare, below).along, 0);
  EXPECT_LE(beside(kSquare, below).along, length(kSquare));
}

TEST(Beside, LeftOfAStrokeIsPositive) {
  EXPECT_DOUBLE_EQ(beside(kSquare, {0.5, 0.25}).distance, 0.25);
  EXPECT_DOUBLE_EQ(beside(kSquare, {0.5, -0.25}).distance, -0.25);
  EXPECT_DOUBLE_EQ(beside(kSquare, {0.5, -0.25}).along, 0.5);
}

}  // namespace
}  // namespace geoprior::sketch
