#include "baselines/grammar/direct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "experiments/grammar/scene/arm.h"
#include "models/grammar/objects/surface_set.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

Eigen::Quaterniond quarter_turn(const Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, axis));
}

/// Of a quaternion and of its opposite, which is the same turn.
bool same_turn(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.toRotationMatrix().isApprox(b.toRotationMatrix(), 1e-14);
}

/// Two joints, at x = 0 and 1, each with a part of 1 m.
Hierarchy two_joint_arm() { return make_arm({.joints = 2, .length = 1}); }

/// Key points of a part: both ends, and two points beside the far one, in y and z.
Eigen::Matrix<double, 4, 3> keys_of_part(const Geometry& geometry, int part) {
  Eigen::Matrix<double, 4, 3> out;
  int found = 0;
  for (int k = 0; k < geometry.keys.rows(); ++k)
    if (geometry.key_element[k] == part) out.row(found++) = geometry.keys.row(k);
  EXPECT_EQ(found, 4);
  return out;
}

// x -> y about z at (1, 0, 0), then y -> z about x at the origin, then z -> x about the world's y
// at (1, 0, 0) again, asked of the part: by hand.
TEST(GrammarDirect, QuarterTurnsOfAnArmAreThoseDoneByHand) {
  const Hierarchy arm = two_joint_arm();
  const int upper = arm.find("part-1", "test"), lower = arm.find("part-2", "test");
  RigidParts parts(arm);
  Eigen::Matrix<double, 4, 3> expected;

  parts.turn(arm.find("joint-2", "test"), quarter_turn(Vector3d::UnitZ()));
  expected << 1, 0, 0, 1, 1, 0, 0.9, 1, 0, 1, 1, 0.1;
  EXPECT_TRUE(keys_of_part(parts.geometry(false), lower).isApprox(expected, 1e-15));
  parts.turn(arm.find("joint-1", "test"), quarter_turn(Vector3d::UnitX()));
  expected << 1, 0, 0, 1, 0, 1, 0.9, 0, 1, 1, -0.1, 1;
  EXPECT_TRUE(keys_of_part(parts.geometry(false), lower).isApprox(expected, 1e-15));
  parts.turn(lower, quarter_turn(Vector3d::UnitY()));
  expected << 1, 0, 0, 2, 0, 0, 2, 0, 0.1, 2, -0.1, 0;
  EXPECT_TRUE(keys_of_part(parts.geometry(false), lower).isApprox(expected, 1e-15));
  // The upper part was turned about its own axis alone: y -> z, z -> -y.
  expected << 0, 0, 0, 1, 0, 0, 1, 0, 0.1, 1, -0.1, 0;
  EXPECT_TRUE(keys_of_part(parts.geometry(false), upper).isApprox(expected, 1e-15));
}

TEST(GrammarDirect, ElementsArePlacedWhereTheirPointsAreSkinnedTo) {
  const Hierarchy arm = two_joint_arm();
  RigidParts parts(arm);
  parts.turn(arm.find("joint-2", "test"),
             Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector3d(2, 1, 2) / 3)));
  parts.turn(0, Eigen::Quaterniond(Eigen::AngleAxisd(-1.1, Vector3d::UnitY())));
  Hierarchy placed = arm;
  parts.place(placed);
  const Geometry skinned = parts.geometry(true), carried = geometry_of(placed, true);
  EXPECT_LT((skinned.keys - carried.keys).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT((skinned.surface.V - carried.surface.V).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GT((skinned.keys - geometry_of(arm, true).keys).cwiseAbs().maxCoeff(), 0.5);
}

/// A square of two triangles, the first edge of one along x and of the other along y, with an item
/// on the one and two on the other; the last stands off by 0.1 m.
Hierarchy items_on_a_square() {
  ElementType root{.name = "sheet"};
  root.triangles.resize(2, 3);
  root.triangles << 0, 1, 2, 3, 0, 2;
  ElementType item{.name = "item",
                   .parameters = {{"size"}, {"radius"}, {"triangle"}, {"b0"}, {"b1"}}};
  Hierarchy h({root, item});
  const std::array<Vector3d, 4> corners{Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1, 1, 0),
                                        Vector3d(0, 1, 0)};
  h.add(0, -1, {}, {}, corners);
  const auto add = [&](const Vector3d& x, double triangle, double b0, double b1) {
    h.add(1, 0, {x, quarter_turn(Vector3d::UnitX())}, std::array{1.0, 0.1, triangle, b0, b1});
  };
  add({0.75, 0.25, 0}, 0, 0.25, 0.5);
  add({0.5, 0.75, 0}, 1, 0.25, 0.25);
  add({0.25, 0.5, 0.1}, 1, 0.25, 0.5);
  return h;
}

/// y' = x + y, z' = z + 3.
AffineMap sheared_and_lifted() {
  Eigen::Affine3d a = Eigen::Affine3d::Identity();
  a.linear() << 1, 0, 0, 1, 1, 0, 0, 0, 1;
  a.translation() << 0, 0, 3;
  return AffineMap(a);
}

// The shear takes an edge along x to the diagonal, 45 degrees about z, and leaves one along y. (The
// rotation of its polar decomposition is by atan(1/2).)
TEST(GrammarDirect, ItemsTurnAsTheFirstEdgeOfTheirTriangle) {
  const Hierarchy before = items_on_a_square();
  const Hierarchy after = carried_details(before, sheared_and_lifted());
  const Eigen::Quaterniond eighth(Eigen::AngleAxisd(std::numbers::pi / 4, Vector3d::UnitZ()));
  EXPECT_TRUE(same_turn(eighth * before.turn(1), after.turn(1)));
  for (const int e : {2, 3}) EXPECT_TRUE(same_turn(before.turn(e), after.turn(e))) << e;
  EXPECT_TRUE(after.position(1).isApprox(Vector3d(0.75, 1, 3), 1e-15));
  EXPECT_TRUE(after.position(2).isApprox(Vector3d(0.5, 1.25, 3), 1e-15));
  EXPECT_EQ(after.points(0)[2], Vector3d(1, 2, 3));
}

TEST(GrammarDirect, ItemsKeepTheirOffsetInTheFrameOfTheTriangle) {
  const Hierarchy before = items_on_a_square();
  Eigen::Affine3d a = Eigen::Affine3d::Identity();
  a.linear() << 0, 0, 1, 0, 1, 0, -2, 0, 0;  // x -> -2 z, z -> x: normals from z to x
  const Hierarchy after = carried_details(before, AffineMap(a));
  EXPECT_TRUE(after.position(3).isApprox(Vector3d(0.1, 0.5, -0.5), 1e-15));
  EXPECT_TRUE(same_turn(quarter_turn(Vector3d::UnitY()) * before.turn(3), after.turn(3)));
}

TEST(GrammarDirect, ItemsThatAreNotThereStay) {
  Hierarchy before = items_on_a_square();
  const int hidden = before.add(1, 0, {{0.5, 0.25, 0}}, std::array{0.0, 0.1, 0.0, 0.5, 0.25});
  before.set_present(hidden, false);
  const Hierarchy after = carried_details(before, sheared_and_lifted());
  EXPECT_EQ(after.position(hidden), before.position(hidden));
  EXPECT_FALSE(after.present(hidden));
}

TEST(GrammarDirect, FewItemsHaveNoMeshOfDetails) {
  Hierarchy before = items_on_a_square();
  before.set_present(3, false);
  try {
    carried_details(before, sheared_and_lifted());
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("items on 'sheet-1': 2 details"));
  }
}

}  // namespace
}  // namespace geoprior::grammar
