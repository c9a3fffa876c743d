#include "baselines/grammar/rigid_as_possible.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "baselines/grammar/free_form.h"
#include "core/error.h"
#include "core/geometry/procedural.h"
#include "core/parallel.h"

namespace geoprior::grammar {
namespace {

/// An element that shows a mesh, with key points.
Geometry drawn_by(const TriMesh& mesh, const std::vector<Eigen::Vector3d>& keys) {
  Hierarchy h;
  const int type =
      h.add_type({.name = "piece",
                  .keys =
                      [keys](std::span<const double>, std::vector<Eigen::Vector3d>& out) {
                        out.insert(out.end(), keys.begin(), keys.end());
                      },
                  .mesh = [mesh](std::span<const double>) { return mesh; }});
  h.add(type, -1, {});
  return geometry_of(h, true);
}

/// A tube of 1 m along x with key points along its axis.
Geometry tube() {
  CylinderOptions options;
  options.segments = 16;
  options.rings_per_half = 12;
  std::vector<Eigen::Vector3d> keys;
  for (int k = 0; k <= 10; ++k) keys.emplace_back(-.5 + .1 * k, 0, 0);
  return drawn_by(two_bone_cylinder(options).mesh, keys);
}

/// Three triangles on one edge: no manifold.
TriMesh three_on_an_edge() {
  TriMesh mesh{Eigen::MatrixX3d(5, 3), Eigen::MatrixX3i(3, 3)};
  mesh.V << 0, 0, 0, 0, 0, 1, 1, 0, 0, -1, 1, 0, -1, -1, 0;
  mesh.F << 0, 1, 2, 0, 1, 3, 0, 1, 4;
  return mesh;
}

/// x sheared by z, harder the further along x.
class GrowingShear final : public SpatialMap {
 public:
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override {
    return x + Eigen::Vector3d(0, 0, 1.5 * std::max(0., x.x()));
  }
};

AffineMap quarter_turn() {
  Eigen::Affine3d a(Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, 3).normalized()));
  a.translation() = Eigen::Vector3d(1, -2, .5);
  return AffineMap(a);
}

/// Mean over the triangles' edges of |length after / length before - 1|.
double mean_edge_strain(const TriMesh& before, const TriMesh& after) {
  double sum = 0;
  for (int f = 0; f < before.triangle_count(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = before.F(f, k), b = before.F(f, (k + 1) % 3);
      const double length = (before.V.row(a) - before.V.row(b)).norm();
      sum += std::abs((after.V.row(a) - after.V.row(b)).norm() / length - 1);
    }
  return sum / (3. * before.triangle_count());
}

TEST(GrammarRigidAsPossible, ReproducesARigidMotion) {
  const AffineMap map = quarter_turn();
  for (const Geometry& before : {tube(), drawn_by(three_on_an_edge(), {{0, 0, 0}, {0, 0, .5}})}) {
    const Geometry expected = free_form(before, map), after = rigid_as_possible(before, map);
    EXPECT_LT((after.surface.V - expected.surface.V).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((after.keys - expected.keys).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(GrammarRigidAsPossible, StrainsEdgesLessThanFreeFormDeformation) {
  const Geometry before = tube();
  const GrowingShear map;
  const double strain = mean_edge_strain(before.surface, rigid_as_possible(before, map).surface);
  const double free = mean_edge_strain(before.surface, free_form(before, map).surface);
  EXPECT_GT(free, .05);
  EXPECT_LT(strain, .8 * free);
}

TEST(GrammarRigidAsPossible, HoldsVerticesNearestToKeyPoints) {
  Geometry before = tube();
  const std::array<int, 4> held{3, 40, 200, 300};
  std::vector<Eigen::Vector3d> keys;
  for (const int v : held) keys.push_back(before.surface.V.row(v).transpose());
  before = drawn_by(before.surface, keys);
  const GrowingShear map;
  const Geometry after = rigid_as_possible(before, map);
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT((after.surface.V.row(held[k]).transpose() - map.at(keys[k])).norm(), 1e-12);
    EXPECT_EQ(after.keys.row(k), after.surface.V.row(held[k]));
  }
}

TEST(GrammarRigidAsPossible, APieceThatIsNotManifoldMovesRigidly) {
  const Geometry before = drawn_by(three_on_an_edge(), {{0, 0, 0}, {1, 0, 0}});
  const Geometry after = rigid_as_possible(before, GrowingShear());
  EXPECT_GT((after.surface.V - before.surface.V).norm(), .1);
  EXPECT_LT(mean_edge_strain(before.surface, after.surface), 1e-9);
}

TEST(GrammarRigidAsPossible, WhatIsNotMovedStaysBitForBit) {
  const Geometry before = drawn_by(three_on_an_edge(), {{-1, 1, 0}, {-1, -1, 0}, {0, 0, .5}});
  const Geometry after = rigid_as_possible(before, GrowingShear());
  EXPECT_EQ(after.surface.V, before.surface.V);
  EXPECT_EQ(after.keys, before.keys);
}

TEST(GrammarRigidAsPossible, SameBytesWithOneThreadAndTwo) {
  const Geometry before = tube();
  Geometry one, two;
  with_threads(1, [&] { one = rigid_as_possible(before, GrowingShear()); });
  with_threads(2, [&] { two = rigid_as_possible(before, GrowingShear()); });
  EXPECT_EQ(one.surface.V, two.surface.V);
  EXPECT_EQ(one.keys, two.keys);
}

TEST(GrammarRigidAsPossible, WhatIsNotToMoveStays) {
  Hierarchy h;
  const TriMesh mesh = tube().surface;
  const int type =
      h.add_type({.name = "piece", .mesh = [mesh](std::span<const double>) { return mesh; }});
  h.add(type, -1, {});
  h.add(type, 0, {});
  const Geometry before = geometry_of(h, true);
  Eigen::Affine3d shear = Eigen::Affine3d::Identity();
  shear(1, 0) = 0.5;
  const Geometry after = rigid_as_possible(before, AffineMap(shear), {}, elements_below(h, 1));
  const int half = before.surface.vertex_count() / 2;
  EXPECT_EQ(after.surface.V.topRows(half), before.surface.V.topRows(half));
  EXPECT_GT((after.surface.V - before.surface.V).bottomRows(half).cwiseAbs().maxCoeff(), 0.1);
  EXPECT_THROW(rigid_as_possible(before, AffineMap(shear), {}, std::vector<char>{1}), Error);
}

}  // namespace
}  // namespace geoprior::grammar
