#include "models/grammar/objects/landscape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/error.h"
#include "models/grammar/objects/spacing.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

std::vector<int> present_of_type(const Hierarchy& h, const std::string& type) {
  std::vector<int> out;
  for (int e = 0; e < h.size(); ++e)
    if (h.present(e) && h.type(e).name == type) out.push_back(e);
  return out;
}

/// Two triangles over the unit square, z = x.
Ground slope() {
  const std::vector<Vector3d> points{{0, 0, 0}, {1, 0, 1}, {1, 1, 1}, {0, 1, 0}};
  Eigen::MatrixX3i F(2, 3);
  F << 0, 1, 2, 0, 2, 3;
  return {points, F};
}

TEST(GrammarLandscape, TheGroundIsFoundBelowAndAbove) {
  const Ground ground = slope();
  for (const double z : {-5., 0.3, 7.}) {
    const auto place = ground.below({0.3, 0.6, z});
    ASSERT_TRUE(place);
    EXPECT_NEAR((ground.at(*place) - Vector3d(0.3, 0.6, 0.3)).norm(), 0, 1e-15);
    EXPECT_NEAR(ground.gap({0.3, 0.6, z}), z - 0.3, 1e-15);
  }
  EXPECT_FALSE(ground.below({1.1, 0.5, 0}));
  EXPECT_NEAR(ground.gap({2, 0, 1}), 1, 1e-15);  // from the vertex (1, 0, 1)
}

TEST(GrammarLandscape, OfSeveralGroundsTheNearestCounts) {
  std::vector<Vector3d> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  Eigen::MatrixX3i F(2, 3);
  F << 0, 1, 2, 3, 4, 5;
  const Ground ground(points, F);
  EXPECT_EQ(ground.below({0.2, 0.2, 0.9})->triangle, 0);
  EXPECT_EQ(ground.below({0.2, 0.2, 1.1})->triangle, 1);
}

/// On z = x a floor of depth d along x has its lower edge d / 2 over the ground.
TEST(GrammarLandscape, APlinthReachesIntoTheGroundAtAllCorners) {
  const std::vector<Vector3d> points{{-9, -9, -9}, {9, -9, 9}, {9, 9, 9}, {-9, 9, -9}};
  Eigen::MatrixX3i F(2, 3);
  F << 0, 1, 2, 0, 2, 3;
  const double depth = plinth_depth(Ground(points, F), {}, 6, 4);
  EXPECT_GE(depth, 3);
  EXPECT_LT(depth, 3.2);
}

TEST(GrammarLandscape, IsValidAndTheSameForASeed) {
  const Hierarchy a = make_landscape({}, 1), b = make_landscape({}, 1), c = make_landscape({}, 2);
  a.require_valid();
  ASSERT_EQ(a.size(), b.size());
  for (int e = 0; e < a.size(); ++e) EXPECT_EQ(a.position(e), b.position(e));
  EXPECT_NE(a.points(1)[0], c.points(1)[0]);
}

TEST(GrammarLandscape, HasAWoodAVillageAndAPath) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Hierarchy h = make_landscape({}, seed);
    EXPECT_GE(present_of_type(h, "pine").size(), 60U);
    EXPECT_LE(present_of_type(h, "pine").size(), 220U);
    EXPECT_EQ(present_of_type(h, "house").size(), 8U);
    EXPECT_GE(present_of_type(h, "stone").size(), 50U);
  }
}

TEST(GrammarLandscape, FeetAreOnTheGroundAndFarEnoughApart) {
  const Hierarchy h = make_landscape({}, 1);
  const Ground ground = ground_of(h, 0);
  std::vector<int> standing = present_of_type(h, "house");
  for (const int e : standing) EXPECT_GE(h.parameter(e, HouseParameter::kPlinth), 0.2);
  for (const int e : present_of_type(h, "pine")) standing.push_back(e);
  const auto keeps = [&](int e) {
    return h.type(e).name == "house" ? house_radius(h, e) : h.parameter(e, PineParameter::kRadius);
  };
  for (std::size_t i = 0; i < standing.size(); ++i) {
    const Vector3d x = h.position(standing[i]);
    EXPECT_NEAR(ground.gap(x), 0, 1e-12);
    EXPECT_EQ(h.turn(standing[i]).x(), 0);
    EXPECT_EQ(h.turn(standing[i]).y(), 0);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((x - h.position(standing[j])).norm(), keeps(standing[i]) + keeps(standing[j]));
  }
}

TEST(GrammarLandscape, StonesAreAPitchApart) {
  const LandscapeOptions o;
  const Hierarchy h = make_landscape(o, 1);
  const std::vector<int> stones = present_of_type(h, "stone");
  for (std::size_t i = 1; i < stones.size(); ++i) {
    const double step = (h.position(stones[i]) - h.position(stones[i - 1])).norm();
    EXPECT_GT(step, 0.95 * o.pitch);
    EXPECT_LT(step, 1.01 * o.pitch);
  }
}

TEST(GrammarLandscape, OptionsOutOfRangeAreErrors) {
  EXPECT_THROW(make_landscape({.width = 5}, 1), Error);
  EXPECT_THROW(make_landscape({.relief = 40}, 1), Error);
  EXPECT_THROW(make_landscape({.width = 25, .depth = 25, .houses = 30}, 1), Error);
}

}  // namespace
}  // namespace geoprior::grammar
