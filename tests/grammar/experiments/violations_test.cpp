#include "experiments/grammar/measures/violations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "experiments/grammar/scene/building.h"
#include "models/grammar/objects/tree.h"
#include "tests/grammar/experiments/small_objects.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using samples::lattice_set;
using samples::moved_state;
using samples::scaled;
using samples::small_tree;
using Numbers = std::vector<int>;

/// x' = x + share of the coordinate of that number.
AffineMap sheared(int coordinate, double share) {
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  out(0, coordinate) = share;
  return AffineMap(out);
}

/// Types as the sets' and the landscape's, with a terrain of two triangles, z = x / 2.
Hierarchy small_landscape() {
  using Keys = std::vector<Vector3d>;
  const auto standing = [](std::span<const double> p, Keys& out) {
    out.insert(out.end(), {{0, 0, 0}, {0, 0, p[2]}});
  };
  const auto house = [](std::span<const double> p, Keys& out) {
    const double w = p[0] / 2, d = p[1] / 2;
    out.insert(out.end(),
               {{0, 0, 0}, {-w, -d, 0}, {w, -d, 0}, {w, d, 0}, {-w, d, 0}, {0, 0, p[2] + 1}});
  };
  Hierarchy h;
  h.add_type({.name = "landscape"});
  ElementType terrain{.name = "terrain"};
  terrain.triangles.resize(2, 3);
  terrain.triangles << 0, 1, 2, 0, 2, 3;
  h.add_type(terrain);
  h.add_type({.name = "pine", .parameters = {{"size"}, {"radius"}, {"height"}}, .keys = standing});
  h.add_type({.name = "house",
              .parameters = {{"width"}, {"depth"}, {"height"}, {"plinth"}},
              .keys = house});
  h.add(0, -1, {});
  const Keys corners{{-10, -10, -5}, {10, -10, 5}, {10, 10, 5}, {-10, 10, -5}};
  h.add(1, 0, {}, {}, corners);
  const auto at = [](double x, double y) {
    return Pose{{x, y, x / 2}, Eigen::Quaterniond::Identity()};
  };
  h.add(2, 0, at(4, 0), std::array{1.0, 1.0, 3.0});
  h.add(2, 0, at(4, 3), std::array{0.5, 1.0, 3.0});
  // Its corners are 3 m aside, where the ground is 1.5 m lower.
  h.add(3, 0, at(-4, 0), std::array{6.0, 8.0, 3.0, 1.5});
  return h;
}

TEST(GrammarViolations, HoldOfObjectsAtRest) {
  for (const std::uint64_t seed : {1, 2}) {
    const Hierarchy grown = make_tree({}, seed), built = make_building({}, seed);
    const RecordedState tree(grown), building(built);
    const TreeViolations t = tree_violations(tree, tree);
    EXPECT_EQ(t.length.broken + t.attachment.broken + t.crossings.broken, 0);
    EXPECT_TRUE(t.length.worst && t.attachment.worst && t.crossings.worst);
    const BuildingViolations b = building_violations(building);
    for (const Tally* tally : {&b.wall_angle, &b.wall_gap, &b.storey_height, &b.storey_gap,
                               &b.overhang, &b.window_pitch, &b.window_outside, &b.door_gap}) {
      ASSERT_TRUE(tally->worst);
      EXPECT_EQ(tally->broken, 0) << *tally->worst;
    }
  }
}

TEST(GrammarViolations, AreAbsentWhereTheObjectHasNoSuchElements) {
  const Hierarchy h = small_tree(), lattice = lattice_set(2);
  const RecordedState tree(h);
  const BuildingViolations b = building_violations(tree);
  EXPECT_FALSE(b.wall_angle.worst || b.window_pitch.worst || b.storey_gap.worst);
  const ScatterViolations s = scatter_violations(tree);
  EXPECT_FALSE(s.spacing || s.too_close.worst || s.ground_gap.worst || s.path_pitch.worst);
  const RecordedState set(lattice);
  EXPECT_FALSE(tree_violations(set, set).crossings.worst);
}

// x' = x + y / 10 turns walls along y by atan(1/10), and leaves those along x.
TEST(GrammarViolations, AShearTurnsEveryOtherWall) {
  const Hierarchy h = make_building({}, 1);
  const BuildingViolations b = building_violations(moved_state(h, sheared(1, 0.1)));
  // Storeys are turned by a little of their own: walls along neither axis shear otherwise.
  EXPECT_NEAR(*b.wall_angle.worst, std::atan(0.1) * 180 / std::numbers::pi, 0.3);
  EXPECT_NEAR(*b.wall_gap.worst, 0, 1e-12);
}

// The same upwards: walls' ends lean by atan(1/10).
TEST(GrammarViolations, ALeanTiltsWallsAndMovesStoreysAside) {
  BuildingOptions plain;
  plain.variety = 0;
  const Hierarchy h = make_building(plain, 1);
  const BuildingViolations b = building_violations(moved_state(h, sheared(2, 0.1)));
  EXPECT_NEAR(*b.wall_angle.worst, std::atan(0.1) * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(*b.overhang.worst, 0, 1e-12);
  EXPECT_EQ(b.storey_height.broken, 0);
}

TEST(GrammarViolations, AStretchUpwardsBreaksHeights) {
  BuildingOptions plain;
  plain.variety = 0;
  const Hierarchy h = make_building(plain, 1);
  const BuildingViolations b = building_violations(moved_state(h, scaled(1, 1, 2)));
  EXPECT_NEAR(*b.storey_height.worst, 2 * plain.storey_height - 4.5, 1e-12);
  EXPECT_EQ(b.storey_height.broken, 4 * plain.storeys);
  const int storey = h.find_type("storey");
  for (const int number : b.storey_height.elements) EXPECT_EQ(h.type_number(number), storey);
  EXPECT_NEAR(*b.storey_gap.worst, 0, 1e-12);
}

TEST(GrammarViolations, ANarrowWallCrowdsItsWindows) {
  BuildingOptions plain;
  plain.variety = 0;
  const Hierarchy h = make_building(plain, 1);
  double least = std::numeric_limits<double>::infinity();
  const int window = h.find_type("window"), wall = h.find_type("wall");
  for (int e = 0; e < h.size(); ++e) {
    if (h.type_number(e) != wall) continue;
    std::vector<double> along;
    for (const int c : h.children(e))
      if (h.type_number(c) == window) along.push_back(h.parameter(c, 2));
    for (std::size_t i = 1; i < along.size(); ++i) least = std::min(least, along[i] - along[i - 1]);
  }
  const RecordedState half = moved_state(h, scaled(0.5, 0.5, 0.5));
  EXPECT_NEAR(*building_violations(half).window_pitch.worst, 1.2 - least / 2, 1e-12);
}

TEST(GrammarViolations, AWindowThatIsMovedSticksOut) {
  Hierarchy h = make_building({}, 1);
  const int window = h.find("window-1", "test");
  const Vector3d across = h.turn(window) * Vector3d::UnitY();
  h.set_position(window, h.position(window) + 0.25 * across);
  const BuildingViolations b = building_violations(RecordedState(h));
  EXPECT_NEAR(*b.window_outside.worst, 0.25, 1e-12);
  EXPECT_EQ(b.window_outside.elements, Numbers{window});
}

TEST(GrammarViolations, ALargerTreeHasTooLongBranches) {
  const Hierarchy h = small_tree();
  const RecordedState rest(h);
  const TreeViolations t = tree_violations(moved_state(h, scaled(2, 2, 2)), rest);
  EXPECT_NEAR(*t.length.worst, 0.5, 1e-14);
  EXPECT_EQ(t.length.broken, 3);
  EXPECT_EQ(t.length.elements, (Numbers{1, 2, 3}));
  // An affine map keeps what lies on an axis at its place.
  EXPECT_NEAR(*t.attachment.worst, 0, 1e-14);
}

TEST(GrammarViolations, ABranchThatIsMovedHangsInTheAir) {
  const Hierarchy at_rest = small_tree();
  Hierarchy h = at_rest;
  h.set_position(3, {0, 0.3, 0.9});
  const TreeViolations t = tree_violations(RecordedState(h), RecordedState(at_rest));
  EXPECT_NEAR(*t.attachment.worst, 0.5, 1e-14);
  // It is the branch that hangs, not what it is to hang on.
  EXPECT_EQ(t.attachment.broken, 1);
  EXPECT_EQ(t.attachment.elements, Numbers{3});
}

TEST(GrammarViolations, BranchesThatMeetInANodeDoNotCross) {
  const Hierarchy h = small_tree();
  const RecordedState rest(h);
  EXPECT_EQ(*tree_violations(rest, rest).crossings.worst, 0);
  // The side branch now leaves the trunk where the next one goes on from it, and then passes
  // through it: as a child of the same place it may.
  Hierarchy meeting = h;
  meeting.set_parameter(3, BranchParameter::kAttach, 1);
  meeting.set_pose(3, meeting.pose(2));
  EXPECT_EQ(*tree_violations(RecordedState(meeting), rest).crossings.worst, 0);
  meeting.set_parameter(3, BranchParameter::kAttach, 0.5);
  const Tally crossings = tree_violations(RecordedState(meeting), rest).crossings;
  EXPECT_EQ(*crossings.worst, 1);
  EXPECT_EQ(crossings.elements, (Numbers{2, 3}));
}

TEST(GrammarViolations, SpacingIsTheDistanceOverSizesTimesRadii) {
  const Hierarchy h = lattice_set(3);
  EXPECT_DOUBLE_EQ(*scatter_violations(RecordedState(h)).spacing, 1);
  EXPECT_EQ(scatter_violations(RecordedState(h)).too_close.broken, 0);
  const ScatterViolations s = scatter_violations(moved_state(h, scaled(0.9, 0.9, 0.9)));
  EXPECT_DOUBLE_EQ(*s.spacing, 0.9);
  EXPECT_NEAR(*s.too_close.worst, 0.1, 1e-15);
  EXPECT_EQ(s.too_close.broken, 3 * 9 * 2);
  EXPECT_EQ(s.too_close.elements.size(), 2 * 3 * 9 * 2);
}

TEST(GrammarViolations, WhatStandsOnASlopeStandsUprightOnIt) {
  const Hierarchy h = small_landscape();
  const ScatterViolations s = scatter_violations(RecordedState(h));
  EXPECT_NEAR(*s.ground_gap.worst, 0, 1e-14);
  EXPECT_EQ(s.ground_gap.broken + s.upright.broken + s.too_close.broken, 0);
  // Half the diagonal of a floor of 6 m by 8 m is 5 m: a pine of 1 m is 8 m aside and 4 m above.
  EXPECT_DOUBLE_EQ(*s.spacing, std::hypot(8, 4) / 6);
}

TEST(GrammarViolations, WhatIsLiftedLeavesTheGround) {
  Hierarchy h = small_landscape();
  h.set_position(2, h.position(2) + Vector3d(0, 0, 0.2));
  EXPECT_NEAR(*scatter_violations(RecordedState(h)).ground_gap.worst, 0.2, 1e-14);
  h = small_landscape();
  h.set_parameter(4, 3, 1.1);
  const ScatterViolations s = scatter_violations(RecordedState(h));
  EXPECT_NEAR(*s.ground_gap.worst, 0.4, 1e-14);
  EXPECT_EQ(s.ground_gap.broken, 2);
  EXPECT_EQ(s.ground_gap.elements, (Numbers{4, 4}));
}

TEST(GrammarViolations, WhatLeansIsNotUpright) {
  Hierarchy h = small_landscape();
  const Eigen::Quaterniond lean(Eigen::AngleAxisd(0.1, Vector3d::UnitX()));
  h.set_pose(3, {h.position(3), lean});
  EXPECT_NEAR(*scatter_violations(RecordedState(h)).upright.worst, 0.1 * 180 / std::numbers::pi,
              1e-12);
  EXPECT_EQ(scatter_violations(RecordedState(h)).upright.elements, Numbers{3});
  h.set_position(4, {1, 0, 0.5});
  const ScatterViolations s = scatter_violations(RecordedState(h));
  EXPECT_DOUBLE_EQ(*s.spacing, std::hypot(3, 1.5) / 6);
  EXPECT_EQ(s.too_close.elements, (Numbers{2, 4, 3, 4}));
}

// Stones 0.9, 0.4 and 1.5 m apart along a path of pitch 1 m, given in another order; the one of
// size 0 between them is not there.
TEST(GrammarViolations, StonesAreApartByTheirPitch) {
  Hierarchy h = small_landscape();
  const int path = h.add_type({.name = "path", .parameters = {{"pitch"}}});
  const int stone = h.add_type({.name = "stone",
                                .parameters = {{"size"}, {"radius"}, {"along"}},
                                .keys = [](std::span<const double>, std::vector<Vector3d>& out) {
                                  out.emplace_back(0, 0, 0);
                                }});
  const int along_y = h.add(path, 0, {}, std::array{1.0});
  const auto add = [&](double y, double size) {
    h.add(stone, along_y, {{0, y, 0}, Eigen::Quaterniond::Identity()}, std::array{size, 0.5, y});
  };
  add(1.3, 0.5);
  add(0, 1);
  add(2.8, 1);
  add(0.1, 0);
  add(0.9, 1);
  const ScatterViolations s = scatter_violations(RecordedState(h));
  EXPECT_NEAR(*s.path_pitch.worst, 0.2, 1e-15);
  // The path is element 5, its stones are 6 to 10: the second and third, the third and fourth along
  // it.
  EXPECT_EQ(s.path_pitch.elements, (Numbers{10, 6, 6, 8}));
  EXPECT_EQ(s.ground_gap.broken, 0);
}

}  // namespace
}  // namespace geoprior::grammar
