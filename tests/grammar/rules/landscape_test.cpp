#include "models/grammar/objects/landscape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "experiments/grammar/maps/gesture.h"
#include "models/grammar/objects/spacing.h"
#include "solvers/grammar/grammar.h"
#include "solvers/grammar/rules/rules.h"
#include "tests/grammar/rules/deformed_objects.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using samples::deformed;
using samples::deviation;
using samples::is_same;
using samples::key_box;

std::vector<int> standing_of_type(const Hierarchy& h, const std::string& type) {
  std::vector<int> out;
  for (int e = 0; e < h.size(); ++e)
    if (h.present(e) && h.type(e).name == type) out.push_back(e);
  return out;
}

/// Where two of those that keep apart are too near, one leans, or is not on the ground.
void expect_kept(const Hierarchy& h, const std::string& where) {
  const Ground ground = ground_of(h, 0);
  std::vector<int> standing = standing_of_type(h, "house");
  for (const int e : standing)
    EXPECT_GE(h.parameter(e, HouseParameter::kPlinth), plinth_depth(ground, h, e, h.pose(e)) - 0.05)
        << where;
  for (const int e : standing_of_type(h, "pine")) standing.push_back(e);
  const auto keeps = [&](int e) {
    if (h.type(e).name == "house") return house_radius(h, e);
    return h.parameter(e, PineParameter::kSize) * h.parameter(e, PineParameter::kRadius);
  };
  for (std::size_t i = 0; i < standing.size(); ++i) {
    const Vector3d x = h.position(standing[i]);
    EXPECT_NEAR(ground.gap(x), 0, 1e-9) << where;
    EXPECT_EQ(h.turn(standing[i]).x(), 0);
    EXPECT_EQ(h.turn(standing[i]).y(), 0);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((x - h.position(standing[j])).norm(), keeps(standing[i]) + keeps(standing[j]))
          << where;
  }
}

void expect_path_kept(const Hierarchy& h, const std::string& where) {
  const double pitch = h.parameter(h.find("path-1", "test"), kPathPitch);
  std::vector<int> stones = standing_of_type(h, "stone");
  const Ground ground = ground_of(h, 0);
  std::stable_sort(stones.begin(), stones.end(), [&](int a, int b) {
    return h.parameter(a, StoneParameter::kAlong) < h.parameter(b, StoneParameter::kAlong);
  });
  for (std::size_t i = 0; i < stones.size(); ++i) {
    EXPECT_NEAR(ground.gap(h.position(stones[i])), 0, 1e-9) << where;
    if (i == 0) continue;
    const double step = (h.position(stones[i]) - h.position(stones[i - 1])).norm() / pitch;
    EXPECT_GE(step, kLeastStep - 1e-9) << where;
    EXPECT_LE(step, kLargestStep + 1e-9) << where;
  }
}

int nearest_pine_to(const Hierarchy& h, int pine) {
  const std::vector<int> pines = standing_of_type(h, "pine");
  const auto distance = [&](int e) {
    return e == pine ? 1e9 : (h.position(e) - h.position(pine)).norm();
  };
  return *std::min_element(pines.begin(), pines.end(),
                           [&](int a, int b) { return distance(a) < distance(b); });
}

TEST(GrammarLandscapeRules, AllConstraintsHoldAndTheMapIsFollowed) {
  const Hierarchy rest = make_landscape({}, 1);
  const auto box = key_box(rest);
  double ratio = 0;
  constexpr int kLandGestures = 25;
  for (int g = 0; g < kLandGestures; ++g) {
    const auto map = map_of(random_gesture(7, g, box), 1);
    const Hierarchy h = deformed(rest, landscape_rules(), map);
    h.require_valid();
    expect_kept(h, "gesture " + std::to_string(g));
    expect_path_kept(h, "gesture " + std::to_string(g));
    ratio += deviation(rest, h, *map) / deviation(rest, rest, *map) / kLandGestures;
  }
  EXPECT_LT(ratio, 0.5);
}

TEST(GrammarLandscapeRules, WhatAGestureDoesNotReachStays) {
  const Hierarchy rest = make_landscape({}, 1);
  Gesture gesture;
  gesture.strokes.push_back({Stroke::Kind::grab, {{-20, -20, 2}, {-18, -17, 5}}, 12});
  const Hierarchy h = deformed(rest, landscape_rules(), map_of(gesture, 1));
  int changed = 0;
  for (int e = 2; e < rest.size(); ++e) {
    if ((rest.position(e) - Vector3d(-20, -20, 2)).norm() > 30) {
      EXPECT_TRUE(is_same(rest, h, e)) << rest.label(e);
    }
    changed += is_same(rest, h, e) ? 0 : 1;
  }
  EXPECT_GT(changed, 3);
  const Hierarchy same = deformed(rest, landscape_rules(), map_of(gesture, 0));
  for (int e = 0; e < rest.size(); ++e) EXPECT_TRUE(is_same(rest, same, e));
}

TEST(GrammarLandscapeRules, HousesThatAreBroughtTogetherAreMovedApart) {
  const Hierarchy rest = make_landscape({}, 1);
  const auto map = std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Scaling(0.6, 0.7, 1.0)));
  const Hierarchy h = deformed(rest, landscape_rules(), map);
  expect_kept(h, "squeezed");
  expect_path_kept(h, "squeezed");
  double moved = 0;
  for (const int e : standing_of_type(h, "house"))
    moved = std::max(moved, (h.position(e) - map->at(rest.position(e))).norm());
  EXPECT_GT(moved, 0.1);
}

TEST(GrammarLandscapeRules, NothingPopsFromFrameToFrame) {
  const Hierarchy rest = make_landscape({}, 1);
  const Gesture gesture = random_gesture(7, 4, key_box(rest));
  Hierarchy before = rest;
  for (int frame = 1; frame <= 20; ++frame) {
    const Hierarchy now = deformed(rest, landscape_rules(), map_of(gesture, frame / 60.));
    for (int e = 0; e < rest.size(); ++e) {
      if (rest.type(e).name != "pine" && rest.type(e).name != "stone") continue;
      const double a = before.present(e) ? before.parameter(e, 0) : 0;
      const double b = now.present(e) ? now.parameter(e, 0) : 0;
      EXPECT_LT(std::abs(a - b), 0.3) << rest.label(e) << " frame " << frame;
    }
    before = now;
  }
}

TEST(GrammarLandscapeRules, AMovedPineStaysOnTheGroundAndTheGroveBoundsIt) {
  const Hierarchy rest = make_landscape({}, 1);
  DeformationGrammar grammar(rest, landscape_rules(), {});
  const int pine = standing_of_type(rest, "pine")[4], other = nearest_pine_to(rest, pine);
  Vector3d shift = 0.9 * (rest.position(other) - rest.position(pine));
  shift.z() += 4;
  const auto report = grammar.edit({pine, Delta::translate(shift)}, Tag{1, Tag::Follow::rigid});
  const Hierarchy& h = grammar.state();
  EXPECT_EQ(h.type(report.turned_at).name, "grove");
  expect_kept(h, "edited");
  EXPECT_FALSE(h.present(other) && h.parameter(other, PineParameter::kSize) == 1);
  EXPECT_EQ(h.parameter(pine, PineParameter::kSize), 1);
  EXPECT_NEAR((h.position(pine) - rest.position(pine) - shift).head<2>().norm(), 0, 1e-9);
  for (const char* type : {"house", "stone", "terrain"})
    for (const int e : standing_of_type(rest, type)) EXPECT_TRUE(is_same(rest, h, e));
}

TEST(GrammarLandscapeRules, PinesMakeRoomForAMovedHouse) {
  const Hierarchy rest = make_landscape({}, 1);
  DeformationGrammar grammar(rest, landscape_rules(), {});
  const int house = standing_of_type(rest, "house")[0];
  const int pine = standing_of_type(rest, "pine")[0];
  const Vector3d shift = rest.position(pine) - rest.position(house);
  const auto report = grammar.edit({house, Delta::translate(shift)}, Tag{1, Tag::Follow::rigid});
  EXPECT_EQ(grammar.state().type(report.turned_at).name, "landscape");
  EXPECT_FALSE(grammar.state().present(pine));
  expect_kept(grammar.state(), "edited");
}

TEST(GrammarLandscapeRules, ParametersOfATaggedHouseStayUnderAGesture) {
  const Hierarchy rest = make_landscape({}, 1);
  DeformationGrammar grammar(rest, landscape_rules(), {});
  const int house = standing_of_type(rest, "house")[2];
  grammar.edit({house, Delta::set(HouseParameter::kHeight, 6)}, Tag{1, Tag::Follow::rigid});
  const auto held = grammar.state().parameters(house);
  const std::vector<double> before(held.begin(), held.end());
  for (int g = 0; g < 5; ++g) {
    const auto map = map_of(random_gesture(7, g, key_box(rest)), 1);
    grammar.gesture(0, map, map);
    const auto now = grammar.state().parameters(house);
    EXPECT_TRUE(std::equal(before.begin(), before.end(), now.begin()));
    expect_kept(grammar.state(), "gesture " + std::to_string(g));
  }
}

TEST(GrammarLandscapeRules, AMovedStoneBendsThePath) {
  const Hierarchy rest = make_landscape({}, 1);
  DeformationGrammar grammar(rest, landscape_rules(), {});
  const std::vector<int> stones = standing_of_type(rest, "stone");
  const int stone = stones[stones.size() / 2];
  grammar.edit({stone, Delta::translate({0.5, 1.5, 0})}, Tag{1, Tag::Follow::rigid});
  expect_path_kept(grammar.state(), "edited");
  EXPECT_TRUE(is_same(rest, grammar.state(), stones.front()));
  const auto map = map_of(random_gesture(7, 3, key_box(rest)), 1);
  grammar.gesture(0, map, map);
  expect_path_kept(grammar.state(), "edited and deformed");
}

TEST(GrammarLandscapeRules, EditsThatCannotBeAreRefused) {
  const Hierarchy rest = make_landscape({}, 1);
  DeformationGrammar grammar(rest, landscape_rules(), {});
  const int pine = standing_of_type(rest, "pine")[0], house = standing_of_type(rest, "house")[0];
  EXPECT_THROW(grammar.edit({pine, Delta::translate({200, 0, 0})}, {}), Error);
  EXPECT_THROW(grammar.edit({house, Delta::set(HouseParameter::kTriangle, 3)}, {}), Error);
  grammar.edit({house, Delta::translate({0.1, 0, 0})}, Tag{1, Tag::Follow::rigid});
  const Vector3d onto = grammar.state().position(house) - rest.position(pine);
  EXPECT_THROW(grammar.edit({pine, Delta::translate(onto)}, {}), Error);
  EXPECT_TRUE(is_same(rest, grammar.state(), pine));
}

TEST(GrammarLandscapeRules, AGestureOnTheVillageLeavesTheGroundAlone) {
  const Hierarchy rest = make_landscape({}, 1);
  DeformationGrammar grammar(rest, landscape_rules(), {});
  const int village = rest.find("village-1", "test");
  const auto map = std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Scaling(1.15, 1.1, 1.0)));
  grammar.gesture(village, map, map);
  expect_kept(grammar.state(), "village");
  EXPECT_TRUE(is_same(rest, grammar.state(), 1));
  const int house = standing_of_type(rest, "house")[0];
  EXPECT_NE(grammar.state().position(house), rest.position(house));
}

}  // namespace
}  // namespace geoprior::grammar
