#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "baselines/grammar/optimum/sets.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

/// Elements of radius 0.5 m and size 1 at places along x.
Hierarchy row_of(const std::vector<double>& places, bool with_tip) {
  Hierarchy h;
  const int root = h.add_type({.name = "volume-set"});
  const int kind =
      h.add_type({.name = with_tip ? "item" : "grain",
                  .parameters = {{"size", "1", 0, 1}, {"radius", "m", 0, 9}},
                  .keys = [with_tip](std::span<const double>, std::vector<Eigen::Vector3d>& out) {
                    out.emplace_back(0, 0, 0);
                    if (with_tip) out.emplace_back(0, 0, .25);
                  }});
  h.add(root, -1, {});
  for (const double x : places) h.add(kind, 0, {{x, 0, 0}}, std::array{1., .5});
  return h;
}

AffineMap squeezed_along_x(double factor) {
  Eigen::Affine3d a = Eigen::Affine3d::Identity();
  a.linear()(0, 0) = factor;
  return AffineMap(a);
}

TEST(GrammarOptimumOfSets, TwoThatAreSqueezedTouchAboutTheirMiddle) {
  const Hierarchy rest = row_of({-1, 1}, false);
  const OptimumResult result = optimise_set(rest, rest, squeezed_along_x(.1));
  // Targets are 0.2 m apart, the least distance is 1 m: each gives way by 0.4
  // m.
  EXPECT_NEAR((result.state.position(1) - Eigen::Vector3d(-.5, 0, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR((result.state.position(2) - Eigen::Vector3d(.5, 0, 0)).norm(), 0, 1e-6);
  EXPECT_NEAR(result.deviation, .4, 1e-6);
  EXPECT_LE(result.gradient, 1e-6);
}

TEST(GrammarOptimumOfSets, WhatHasRoomFollowsTheMap) {
  const Hierarchy rest = row_of({-1, 1}, true);
  Eigen::Affine3d turn(Eigen::AngleAxisd(.6, Eigen::Vector3d::UnitX()));
  const OptimumResult result = optimise_set(rest, rest, AffineMap(turn));
  EXPECT_LT(result.deviation, 1e-6);
}

TEST(GrammarOptimumOfSets, NewOnesGiveWay) {
  const Hierarchy rest = row_of({-1, 1}, false);
  Hierarchy given = row_of({-1, 1, 0}, false);
  given.set_position(3, {0, .1, 0});  // in line it could not tell which way to go
  const OptimumResult result = optimise_set(rest, given, squeezed_along_x(.6));
  EXPECT_LT(result.deviation, 1e-4);
  for (const int e : {1, 2})
    EXPECT_GE((result.state.position(3) - result.state.position(e)).norm(), 1 - 1e-9);
}

/// Conifers 2 m apart along x, of radius 0.5 m and 3 m high.
Hierarchy two_conifers(double spacing) {
  Hierarchy h;
  const int root = h.add_type({.name = "forest", .parameters = {{"spacing", "m", 0, 9}}});
  const int kind =
      h.add_type({.name = "conifer",
                  .parameters = {{"size", "1", 0, 1}, {"radius", "m", 0, 9}},
                  .keys = [](std::span<const double>, std::vector<Eigen::Vector3d>& out) {
                    out.emplace_back(0, 0, 0);
                    out.emplace_back(0, 0, 3);
                  }});
  h.add(root, -1, {}, std::array{spacing});
  for (const double x : {-1., 1.}) h.add(kind, 0, {{x, 0, 0}}, std::array{1., .5});
  return h;
}

TEST(GrammarOptimumOfSets, ConifersStayUprightOnTheGround) {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.linear()(0, 0) = .1;
  map.linear()(1, 2) = .2;  // leans towards y
  map.translation().z() = 1;
  for (const double spacing : {1., 0.}) {
    const Hierarchy rest = two_conifers(spacing);
    const Hierarchy found = optimise_set(rest, rest, AffineMap(map)).state;
    const double x = spacing > 0 ? .5 : .1;
    // Half of the top's lean of 0.6 m.
    EXPECT_NEAR((found.position(1) - Eigen::Vector3d(-x, .3, 0)).norm(), 0, 1e-6);
    EXPECT_NEAR((found.position(2) - Eigen::Vector3d(x, .3, 0)).norm(), 0, 1e-6);
    EXPECT_EQ(found.position(1).z(), 0);
    EXPECT_EQ(found.turn(1).coeffs(), rest.turn(1).coeffs());
  }
}

TEST(GrammarOptimumOfSets, AnObjectWithoutASetIsRefused) {
  const Hierarchy rest = row_of({}, false);
  test::expect_error([&] { optimise_set(rest, rest, squeezed_along_x(1)); },
                     {"no elements of a set"});
}

}  // namespace
}  // namespace geoprior::grammar
