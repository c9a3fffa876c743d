#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/grammar/measures/violations.h"
#include "tests/grammar/experiments/small_objects.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using samples::kStay;
using samples::moved_state;
using samples::scaled;
using samples::shifted;

/// Boxes of 2 m x 1 m x 0.5 m, one a kind of part, and two links of a spring 3 m apart.
Hierarchy parts() {
  Hierarchy h;
  h.add_type({.name = "scene"});
  h.add(0, -1, {});
  const auto corners = [](std::span<const double>, std::vector<Vector3d>& out) {
    for (const double z : {0., 0.5})
      out.insert(out.end(), {{0, 0, z}, {2, 0, z}, {2, 1, z}, {0, 1, z}});
  };
  const std::array<std::string, 5> names{"body", "Piston a", "Lifter b", "rod c", "Spring_Link d"};
  for (const std::string& name : names) {
    const int type = h.add_type({.name = name, .keys = corners});
    h.add(type, 0, {});
    if (name == names.back()) h.add(type, 0, {{3, 0, 0}, Eigen::Quaterniond::Identity()});
  }
  return h;
}

MachineViolations after(const SpatialMap& map) {
  const Hierarchy h = parts();
  return machine_violations(moved_state(h, map), moved_state(h, kStay), true);
}

AffineMap turned_about_z(double degrees) {
  return AffineMap(Eigen::Affine3d(
      Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vector3d::UnitZ()).toRotationMatrix()));
}

TEST(GrammarMachineViolations, RestHasNone) {
  const MachineViolations v = after(kStay);
  for (const Tally& tally : {v.shape, v.turn, v.slide, v.links}) {
    EXPECT_EQ(tally.worst, 0);
    EXPECT_EQ(tally.broken, 0);
  }
}

TEST(GrammarMachineViolations, ShiftIsMeasuredAcrossWhereAPartSlides) {
  const MachineViolations v = after(shifted(0.1, 0.2, 0.3));
  // Across x of the piston sqrt(.2^2 + .3^2), across y of the lifter less, along y of the rod .2.
  EXPECT_NEAR(*v.slide.worst, std::sqrt(0.13), 1e-12);
  EXPECT_EQ(v.slide.broken, 3);
  EXPECT_EQ(v.slide.elements.size(), 3);
  EXPECT_NEAR(*v.shape.worst, 0, 1e-12);
  EXPECT_NEAR(*v.links.worst, 0, 1e-12);
}

TEST(GrammarMachineViolations, WhereAPartMaySlideThereIsNone) {
  EXPECT_EQ(after(shifted(0.1, 0, 0)).slide.broken, 1);  // the lifter
  EXPECT_EQ(after(shifted(0, 0.1, 0)).slide.broken, 2);  // piston and rod
}

TEST(GrammarMachineViolations, EdgesOfAllButTheBodyKeepTheirLength) {
  const MachineViolations v = after(scaled(1.5, 1, 1));
  EXPECT_NEAR(*v.shape.worst, 1, 1e-12);  // 2 m became 3 m
  EXPECT_EQ(v.shape.broken, 5);
  EXPECT_NEAR(*v.links.worst, 1.5, 1e-12);  // 3 m became 4.5 m
  EXPECT_EQ(v.links.elements.size(), 2 * v.links.broken);
}

TEST(GrammarMachineViolations, TurnIsTheAngleOfTheEdges) {
  const MachineViolations v = after(turned_about_z(30));
  EXPECT_NEAR(*v.turn.worst, 30, 1e-9);
  EXPECT_EQ(v.turn.broken, 6);  // two edges of body, piston and lifter each
  EXPECT_NEAR(*v.shape.worst, 0, 1e-12);
}

TEST(GrammarMachineViolations, ShearBendsTheRightAngles) {
  Eigen::Affine3d shear = Eigen::Affine3d::Identity();
  shear(0, 1) = 0.25;  // the edge of 1 m along y leans by 0.25 m
  EXPECT_NEAR(*after(AffineMap(shear)).shape.worst, 0.25, 1e-12);
}

TEST(GrammarMachineViolations, OtherObjectsHaveNone) {
  const Hierarchy h = parts();
  const MachineViolations v =
      machine_violations(moved_state(h, scaled(2, 2, 2)), moved_state(h, kStay), false);
  EXPECT_FALSE(v.shape.worst || v.turn.worst || v.slide.worst || v.links.worst);
}

}  // namespace
}  // namespace geoprior::grammar
