// How far assemblies are from what a user wants of them.

#include "models/assembly/search/guide.h"

#include <gtest/gtest.h>

#include "tests/assembly/assemblies.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

/// Four straights of 1 m along a unit square, moved by `x`.
Assembly square_of_tracks(double x) {
  Assembly out;
  for (int i = 0; i < 4; ++i)
    out.parts.push_back({0, plane_pose(x + (i == 1 || i == 2), i >= 2, i * std::numbers::pi / 2)});
  return out;
}

Guide guided_by(Target::Kind kind, std::vector<double> x, std::vector<double> y, double spacing) {
  Guide out;
  out.target = Target{kind, std::move(x), std::move(y), spacing};
  return out;
}

TEST(Objective, OfAnOutlineIsZeroOnItAndTheDistanceItIsMovedBy) {
  const std::vector<PartType> types{straight_track("side", 1)};
  const Objective objective(guided_by(Target::Kind::outline, {0, 1, 1, 0}, {0, 0, 1, 1}, 0.1),
                            types);
  EXPECT_NEAR(objective(square_of_tracks(0)), 0, 1e-14);
  // Of points 0.1 apart each stays the nearest of the one it was moved from.
  for (const double moved : {0.01, 0.04})
    EXPECT_NEAR(objective(square_of_tracks(moved)), moved, 1e-3 * moved);
  EXPECT_GT(objective(square_of_tracks(5)), 4);
}

TEST(Objective, OfAnOvalToItselfIsZero) {
  const std::vector<PartType> types{curved_track("curve", 0.5, std::numbers::pi / 8)};
  const Assembly ring = track_row(std::vector<int>(16, 0), types, true);
  std::vector<double> x, y;
  for (int i = 0; i < 16; ++i) {
    const Eigen::Vector3d at = port_pose(ring, types, {i, 0}).translation();
    x.push_back(at.x());
    y.push_back(at.y());
  }
  EXPECT_NEAR(Objective(guided_by(Target::Kind::outline, x, y, 1), types)(ring), 0, 1e-14);
}

TEST(Objective, OfARegionIsTheShareMissedAndTheShareOutside) {
  // Lattice points at 0.25 and 0.75 in x and y; parts are points.
  std::vector<PartType> types{abstract_type("point", 1)};
  const Objective objective(guided_by(Target::Kind::region, {0, 1, 1, 0}, {0, 0, 1, 1}, 0.5),
                            types);
  Assembly points;
  points.parts = {{0, plane_pose(0.25, 0.25, 0)}};
  EXPECT_DOUBLE_EQ(objective(points), 0.25);
  points.parts.push_back({0, plane_pose(0.75, 0.75, 0)});
  EXPECT_DOUBLE_EQ(objective(points), 0);
  points.parts[1] = {0, plane_pose(5, 5, 0)};
  EXPECT_DOUBLE_EQ(objective(points), 0.25 + 0.5);
}

TEST(Objective, AddsOneForEachLabelThatIsWantedAndMissing) {
  Guide guide;
  guide.use = {"curve", "straight", "bridge"};
  const std::vector<PartType> types = oval_types();
  const Objective objective(guide, types);
  EXPECT_EQ(objective(track_row({0, 1}, types, false)), 1);
  EXPECT_EQ(objective(track_row({0, 2}, types, false)), 2);
  EXPECT_EQ(objective(track_row({2}, types, false)), 3);
}

TEST(Objective, KeepsTheLabelsThatAreMeant) {
  Guide guide;
  guide.keep = {"pillar-*", "basin"};
  const std::vector<PartType>& types = marble_run().set.types;
  const Objective objective(guide, types);
  for (std::size_t t = 0; t < types.size(); ++t)
    EXPECT_EQ(objective.keeps(static_cast<int>(t)),
              types[t].label.starts_with("pillar-") || types[t].label == "basin");
}

TEST(Guide, RefusesATargetThatIsNoPolygon) {
  EXPECT_NO_THROW(require_valid(Guide{}, "scene.guide"));
  test::expect_error(
      [] {
        require_valid(guided_by(Target::Kind::outline, {0, 1}, {0, 1}, 1), "scene.guide");
      },
      {"scene.guide.target", "2 corners", "3 or more"});
  test::expect_error(
      [] {
        require_valid(guided_by(Target::Kind::outline, {0, 1, 1}, {0, 1}, 1), "scene.guide");
      },
      {"scene.guide.target", "3 x and 2 y"});
}

TEST(Guide, UseTakesAStar) {
  Guide guide;
  guide.use = {"str*"};
  const auto types = oval_types();
  EXPECT_EQ(Objective(guide, types)(track_row({0, 1}, types, false)), 0);
}

}  // namespace
}  // namespace geoprior::assembly
