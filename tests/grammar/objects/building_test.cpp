#include "experiments/grammar/scene/building.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/mesh.h"
#include "models/grammar/objects/building_layout.h"
#include "solvers/grammar/rules/building_stack.h"

namespace geoprior::grammar {
namespace {

std::vector<Opening> test_row(int count, double pitch, double length) {
  std::vector<Opening> row(count);
  for (int i = 0; i < count; ++i) {
    row[i].along = length / 2 + (i - (count - 1) / 2.) * pitch;
    row[i].width = 0.9;
    row[i].sill = 0.9;
    row[i].height = 1.5;
  }
  return row;
}

void expect_row_in_range(const std::vector<LaidOpening>& row, double length) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    const Opening& o = row[i].opening;
    EXPECT_GE(std::min(o.along, length - o.along), kWallEnd + o.width / 2 - 1e-9);
    if (i == 0) continue;
    const double pitch = o.along - row[i - 1].opening.along;
    EXPECT_GE(pitch, least_pitch(row[i - 1].opening, o) - 1e-9);
    EXPECT_LE(pitch, kMostPitch + 1e-9);
  }
}

TEST(GrammarBuilding, HasFourWallsAStoreyOneDoorAndARoof) {
  BuildingOptions options;
  options.storeys = 4;
  const Hierarchy h = make_building(options, 3);
  h.require_valid();
  const std::vector<int> storeys = storeys_of(h, 0);
  ASSERT_EQ(storeys.size(), 4u);
  int doors = 0;
  for (const int storey : storeys) {
    const std::vector<int> walls = present_children(h, storey, "wall");
    EXPECT_EQ(walls.size(), 4u);
    for (const int wall : walls) {
      doors += static_cast<int>(present_children(h, wall, "door").size());
      EXPECT_FALSE(h.children(wall).empty());
    }
  }
  EXPECT_EQ(doors, 1);
  EXPECT_EQ(present_children(h, 0, "roof").size(), 1u);
}

TEST(GrammarBuilding, StoreysStandOnOneAnotherAndWallsMeetAtTheirCorners) {
  const Hierarchy h = make_building({.storeys = 6}, 5);
  const std::vector<int> storeys = storeys_of(h, 0);
  for (std::size_t i = 0; i < storeys.size(); ++i) {
    std::vector<Eigen::Vector3d> box;
    h.keys(storeys[i], box);
    for (const int wall : present_children(h, storeys[i], "wall")) {
      std::vector<Eigen::Vector3d> keys;
      h.keys(wall, keys);
      const int side = static_cast<int>(h.parameter(wall, WallParameter::side));
      const int next = (side + 1) % 4;
      EXPECT_LT((keys[0] - box[side]).norm(), 1e-12);
      EXPECT_LT((keys[1] - box[next]).norm(), 1e-12);
      EXPECT_LT((keys[2] - box[next + 4]).norm(), 1e-12);
      EXPECT_LT((keys[3] - box[side + 4]).norm(), 1e-12);
    }
    if (i == 0) continue;
    std::vector<Eigen::Vector3d> below;
    h.keys(storeys[i - 1], below);
    EXPECT_NEAR(below[4].z(), box[0].z(), 1e-12);
    const auto of = [&](int s) {
      return storey_box(h.pose(s), h.parameter(s, 0), h.parameter(s, 1), h.parameter(s, 2));
    };
    EXPECT_LE(overhang(of(storeys[i - 1]), of(storeys[i])), kMostOverhang);
  }
}

TEST(GrammarBuilding, SurfacesAreClosedAndPointOutwards) {
  const Hierarchy h = make_building({}, 1);
  for (int e = 1; e < h.size(); ++e) {
    const TriMesh mesh = h.type(e).mesh(h.parameters(e));
    ASSERT_GT(mesh.triangle_count(), 0);
    EXPECT_GT(signed_volume(mesh.V, mesh.F), 0) << h.label(e);
  }
}

TEST(GrammarBuilding, SeedsDifferAndRepeat) {
  const Hierarchy a = make_building({}, 1), b = make_building({}, 1), c = make_building({}, 2);
  ASSERT_EQ(a.size(), b.size());
  bool differs = a.size() != c.size();
  for (int e = 0; e < a.size(); ++e) {
    EXPECT_EQ(a.position(e), b.position(e));
    differs = differs || a.position(e) != c.position(e);
  }
  EXPECT_TRUE(differs);
}

TEST(GrammarBuilding, OptionOutOfRangeIsAnError) {
  EXPECT_THROW(make_building({.storeys = 0}, 1), Error);
  EXPECT_THROW(make_building({.pitch = 3}, 1), Error);
}

TEST(GrammarBuildingLayout, SameWallKeepsItsRowBitForBit) {
  const std::vector<Opening> row = test_row(5, 1.73, 9.1);
  const std::vector<LaidOpening> laid = lay_out_row(row, 9.1, 3.1, 9.1, 3.1);
  ASSERT_EQ(laid.size(), row.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    EXPECT_EQ(laid[i].opening.along, row[i].along);
    EXPECT_EQ(laid[i].opening.sill, row[i].sill);
    EXPECT_EQ(laid[i].origin, static_cast<int>(i));
  }
}

// The pitch follows the wall from 1.8 m to 2.4 m, at a length of 12 m; two openings come where
// 2.4 m + 0.45 m + 0.15 m fit beside the outermost one, 4.8 m from the middle: from 15.6 m on.
TEST(GrammarBuildingLayout, LongerWallGetsOpeningsAtItsEnds) {
  const std::vector<Opening> row = test_row(5, 1.8, 9);
  EXPECT_EQ(lay_out_row(row, 9, 3, 15.59, 3).size(), 5u);
  const std::vector<LaidOpening> laid = lay_out_row(row, 9, 3, 15.61, 3);
  ASSERT_EQ(laid.size(), 7u);
  EXPECT_LT(laid.front().origin, 0);
  EXPECT_LT(laid.back().origin, 0);
  EXPECT_NEAR(laid[3].opening.along - laid[2].opening.along, kMostPitch, 1e-12);
  expect_row_in_range(laid, 15.61);
}

TEST(GrammarBuildingLayout, ShorterWallsLoseOpeningsInPairsAndNothingElseJumps) {
  const std::vector<Opening> row = test_row(7, 1.8, 12.6);
  std::vector<LaidOpening> before = lay_out_row(row, 12.6, 3, 12.6, 3);
  constexpr double kStep = 0.01;
  for (double length = 12.6 - kStep; length > 3; length -= kStep) {
    const std::vector<LaidOpening> laid = lay_out_row(row, 12.6, 3, length, 3);
    expect_row_in_range(laid, length);
    EXPECT_EQ(laid.size() % 2, 1u);
    for (const LaidOpening& now : laid) {
      const auto was = std::find_if(before.begin(), before.end(),
                                    [&](const auto& o) { return o.origin == now.origin; });
      ASSERT_NE(was, before.end());
      // The wall's ends come nearer by half a step each, and the middle with them.
      EXPECT_LT(std::abs(now.opening.along - was->opening.along), 0.1);
    }
    before = laid;
  }
  EXPECT_LT(before.size(), 7u);
}

TEST(GrammarBuildingLayout, HeldOpeningStaysAndNeighboursMakeRoom) {
  std::vector<Opening> row = test_row(5, 1.5, 8);
  row[2].held = true;
  row[2].width = 2;
  row[2].along += 0.3;
  const std::vector<LaidOpening> laid = lay_out_row(row, 8, 3, 8.4, 3.3);
  const auto held =
      std::find_if(laid.begin(), laid.end(), [](const auto& o) { return o.origin == 2; });
  ASSERT_NE(held, laid.end());
  EXPECT_EQ(held->opening.along, row[2].along);
  EXPECT_EQ(held->opening.height, row[2].height);
  expect_row_in_range(laid, 8.4);
}

TEST(GrammarBuildingLayout, DoorIsNeverDropped) {
  std::vector<Opening> row = test_row(5, 1.8, 9);
  row[2].door = true;
  for (const double length : {9., 6., 4., 3.}) {
    const std::vector<LaidOpening> laid = lay_out_row(row, 9, 3, length, 3);
    EXPECT_EQ(std::count_if(laid.begin(), laid.end(),
                            [](const LaidOpening& o) { return o.opening.door; }),
              1);
  }
}

}  // namespace
}  // namespace geoprior::grammar
