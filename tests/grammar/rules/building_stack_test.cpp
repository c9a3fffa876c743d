#include "solvers/grammar/rules/building_stack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "models/grammar/objects/building_layout.h"

namespace geoprior::grammar {
namespace {

StoreyWish wish_at(const StoreyBox& rest, const StoreyBox& target) {
  StoreyWish wish;
  wish.rest = rest;
  wish.moved = true;
  wish_for(wish, target, 1);
  return wish;
}

// A tower of ten whose storeys are asked to lean by 1 m each: 0.6 m is allowed. What is nearest to
// the targets is symmetric about the middle, so the mean of all shifts is kept.
TEST(GrammarBuildingStack, LeaningStackKeepsItsOverhangAndItsMean) {
  std::vector<StoreyWish> wishes;
  std::vector<StoreyBox> boxes;
  for (int i = 0; i < 10; ++i) {
    StoreyBox rest{{0, 0, 3. * i}, 0, 10, 8, 3}, target = rest;
    target.bottom.x() = i;
    wishes.push_back(wish_at(rest, target));
    boxes.push_back(rest);
  }
  ASSERT_TRUE(fit_plans(wishes, boxes));
  double mean = 0;
  for (int i = 0; i < 10; ++i) {
    mean += boxes[i].bottom.x() / 10;
    EXPECT_NEAR(boxes[i].width, 10, 1e-3);
    if (i == 0) continue;
    EXPECT_LE(overhang(boxes[i - 1], boxes[i]), kMostOverhang + 1e-11);
    EXPECT_NEAR(boxes[i].bottom.x() - boxes[i - 1].bottom.x(), kMostOverhang, 1e-4);
  }
  EXPECT_NEAR(mean, 4.5, 1e-3);
}

TEST(GrammarBuildingStack, StoreyFitsATurnedAndStretchedBox) {
  const StoreyBox rest{{1, 2, 0}, 0.1, 10, 8, 3};
  const StoreyBox target{{3, -1, 0}, 2.5, 13, 6, 4};
  std::vector<StoreyWish> wishes{wish_at(rest, target)};
  std::vector<StoreyBox> boxes{rest};
  ASSERT_TRUE(fit_plans(wishes, boxes));
  EXPECT_NEAR(boxes[0].bottom.x(), 3, 1e-9);
  EXPECT_NEAR(std::remainder(boxes[0].yaw - 2.5, 2 * std::numbers::pi), 0, 1e-9);
  EXPECT_NEAR(boxes[0].width, 13, 1e-9);
  EXPECT_NEAR(boxes[0].depth, 6, 1e-9);
}

TEST(GrammarBuildingStack, StackWithoutWishesStaysBitForBit) {
  std::vector<StoreyWish> wishes(3);
  std::vector<StoreyBox> boxes(3);
  for (int i = 0; i < 3; ++i) wishes[i].rest = {{0.1, 0.7, 3.1 * i}, 0.3, 10.1, 8.3, 3.1};
  ASSERT_TRUE(fit_plans(wishes, boxes));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(boxes[i].width, 10.1);
    EXPECT_EQ(boxes[i].yaw, 0.3);
    EXPECT_EQ(boxes[i].bottom.x(), 0.1);
  }
}

// Two storeys over a ground that wants to stay, asked for 6 m and 2 m: limits are 4.5 m and 2.6 m.
// With weights 1 at floors and ceilings the minimum is found by hand below: levels g, g + 4.5,
// g + 7.1 for targets 0, 6 (twice) and 8.
TEST(GrammarBuildingStack, HeightsAreAtTheirLimits) {
  std::vector<StoreyWish> wishes(2);
  wishes[0].rest.height = wishes[1].rest.height = 3;
  wishes[0].rise.add(0, 1, 0);
  wishes[0].rise.add(1, 1, 6);
  wishes[1].rise.add(0, 1, 6);
  wishes[1].rise.add(1, 1, 8);
  const std::vector<double> levels = fit_levels(wishes);
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_NEAR(levels[1] - levels[0], kMostStoreyHeight, 1e-9);
  EXPECT_NEAR(levels[2] - levels[1], kLeastStoreyHeight, 1e-9);
  // Stationary in g: g + 2 (g + 4.5 - 6) + (g + 7.1 - 8) = 0.
  EXPECT_NEAR(levels[0], (2 * 1.5 + 0.9) / 4, 1e-9);
}

}  // namespace
}  // namespace geoprior::grammar
