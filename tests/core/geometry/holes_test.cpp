// Caps of holes: closed forms of plane loops, and what stays open.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/geometry/holes/cap_holes.h"
#include "core/geometry/topology.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior {
namespace {

/// A loop through points of the plane z = 0, counter-clockwise.
Eigen::MatrixX3d plane_loop(const std::vector<Eigen::Vector2d>& points) {
  Eigen::MatrixX3d V(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) V.row(i) << points[i].x(), points[i].y(), 0;
  return V;
}

std::vector<int> all_of(const Eigen::MatrixX3d& V) {
  std::vector<int> loop(V.rows());
  for (std::size_t i = 0; i < loop.size(); ++i) loop[i] = static_cast<int>(i);
  return loop;
}

bool no_edge(int /*u*/, int /*v*/) { return false; }

Eigen::MatrixX3i matrix_of(const std::vector<CapTriangle>& triangles) {
  Eigen::MatrixX3i F(triangles.size(), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) F(t, k) = triangles[t][k];
  return F;
}

/// Least z of the doubled area vectors: below zero where all face away.
double highest_facing(const Eigen::MatrixX3d& V, const std::vector<CapTriangle>& cap) {
  double highest = -1;
  for (const CapTriangle& t : cap) {
    const Eigen::Vector3d a = V.row(t[0]), b = V.row(t[1]), c = V.row(t[2]);
    highest = std::max(highest, (b - a).cross(c - a).z());
  }
  return highest;
}

TriMesh capped(TriMesh mesh) {
  const HoleCaps caps = cap_holes(mesh);
  const Eigen::Index first = mesh.F.rows();
  mesh.F.conservativeResize(first + std::ssize(caps.triangles), 3);
  mesh.F.bottomRows(std::ssize(caps.triangles)) = matrix_of(caps.triangles);
  return mesh;
}

TEST(LoopCap, OfAPlaneLoopHasItsAreaAndFacesOneWay) {
  // A U: the notch from (1, 3) down to y = 1 is no part of the area 9 - 2.
  const Eigen::MatrixX3d V =
      plane_loop({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}});
  const std::vector<CapTriangle> cap = cap_of_loop(V, all_of(V), no_edge);
  ASSERT_EQ(cap.size(), 6U);
  EXPECT_NEAR(triangle_areas(V, matrix_of(cap)).sum(), 7, 1e-12);
  EXPECT_LT(highest_facing(V, cap), 0) << "the skin beyond the border faces +z, the loop runs so";
}

TEST(LoopCap, HasNoTriangleWithoutAreaWhereThePointsOfASideAreInLine) {
  std::vector<Eigen::Vector2d> points;
  for (int side = 0; side < 4; ++side) {
    const double c = std::cos(side * std::numbers::pi / 2),
                 s = std::sin(side * std::numbers::pi / 2);
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector2d p(-1 + 0.4 * i, -1);
      points.emplace_back(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    }
  }
  const Eigen::MatrixX3d V = plane_loop(points);
  const std::vector<CapTriangle> cap = cap_of_loop(V, all_of(V), no_edge);
  ASSERT_EQ(cap.size(), 18U);
  EXPECT_GT(triangle_areas(V, matrix_of(cap)).minCoeff(), 1e-3);
  EXPECT_NEAR(triangle_areas(V, matrix_of(cap)).sum(), 4, 1e-12);
}

TEST(LoopCap, OfALongLoopIsThePolygonToo) {
  constexpr int kVertices = 4 * kExactLoop + 3;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < kVertices; ++i) {
    const double angle = 2 * std::numbers::pi * i / kVertices;
    points.emplace_back(std::cos(angle), std::sin(angle));
  }
  const Eigen::MatrixX3d V = plane_loop(points);
  const std::vector<CapTriangle> cap = cap_of_loop(V, all_of(V), no_edge);
  ASSERT_EQ(cap.size(), static_cast<std::size_t>(kVertices - 2));
  const double polygon = 0.5 * kVertices * std::sin(2 * std::numbers::pi / kVertices);
  EXPECT_NEAR(triangle_areas(V, matrix_of(cap)).sum(), polygon, 1e-12);
}

TEST(LoopCap, TakesNoChordThatIsAnEdge) {
  const Eigen::MatrixX3d V = plane_loop({{0, 0}, {2, 0}, {2, 1}, {0, 1}});
  const auto diagonal = [](int from) {
    return [from](int u, int v) { return undirected(u, v) == Edge{from, from + 2}; };
  };
  const auto has = [&](const std::vector<CapTriangle>& cap, int vertex) {
    return std::ranges::count_if(cap, [&](const CapTriangle& t) {
             return std::ranges::find(t, vertex) != t.end();
           }) == 2;
  };
  EXPECT_TRUE(has(cap_of_loop(V, all_of(V), diagonal(0)), 1));
  EXPECT_TRUE(has(cap_of_loop(V, all_of(V), diagonal(1)), 0));
  EXPECT_TRUE(cap_of_loop(V, all_of(V), [](int, int) { return true; }).empty());
}

TEST(LoopCap, ClosesNoSlit) {
  const Eigen::MatrixX3d V = plane_loop({{0, 0}, {1, 0}, {2, 0}, {1, 1e-8}});
  EXPECT_TRUE(cap_of_loop(V, all_of(V), no_edge).empty());
}

TEST(BoundaryLoops, ThatTouchAreFoundApart) {
  // Two opposite faces of the octahedron at vertex 0 are missing: the holes meet there.
  TriMesh mesh = shapes::octahedron();
  Eigen::MatrixX3i F(6, 3);
  int kept = 0;
  for (Eigen::Index f = 0; f < 8; ++f)
    if (f != 0 && f != 7) F.row(kept++) = mesh.F.row(f);
  const BoundaryLoops border = boundary_loops(F);
  ASSERT_EQ(border.loops.size(), 2U);
  EXPECT_EQ(border.loops[0].size(), 3U);
  EXPECT_EQ(border.loops[1].size(), 3U);
  EXPECT_EQ(border.stray_edges, 0);
  mesh.F = F;
  const TriMesh closed = capped(mesh);
  EXPECT_NO_THROW(require_closed_manifold(closed, "test", ""));
  EXPECT_NEAR(signed_volume(closed.V, closed.F), 4.0 / 3, 1e-12) << "that of the octahedron";
}

TEST(CapHoles, ClosesTheSphereThatLacksACalotte) {
  TriMesh mesh = shapes::sphere(4);
  std::vector<Eigen::RowVector3i> kept;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const double z = (mesh.V(mesh.F(f, 0), 2) + mesh.V(mesh.F(f, 1), 2) + mesh.V(mesh.F(f, 2), 2));
    if (z < 3 * 0.8) kept.emplace_back(mesh.F.row(f));
  }
  mesh.F.resize(std::ssize(kept), 3);
  for (std::size_t f = 0; f < kept.size(); ++f) mesh.F.row(f) = kept[f];
  const HoleCaps caps = cap_holes(mesh);
  ASSERT_EQ(caps.capped.size(), 1U);
  EXPECT_TRUE(caps.open.empty());
  EXPECT_EQ(caps.triangles.size(), boundary_edges(mesh.F).size() - 2);
  const TriMesh closed = capped(mesh);
  EXPECT_NO_THROW(require_closed_manifold(closed, "test", ""));
  // The ball without the calotte of height 1/5: 4 pi / 3 - pi h^2 (3 - h) / 3.
  const double ball = 4 * std::numbers::pi / 3 - std::numbers::pi * 0.04 * 2.8 / 3;
  EXPECT_NEAR(signed_volume(closed.V, closed.F), ball, 0.02 * ball);
}

TEST(CapHoles, LeavesSheetsOpenAndSaysSo) {
  const HoleCaps sheet = cap_holes(shapes::square(3));
  EXPECT_TRUE(sheet.triangles.empty());
  ASSERT_EQ(sheet.open.size(), 1U);
  EXPECT_TRUE(sheet.open[0].is_sheet);
  EXPECT_FALSE(sheet.has_inside);
  EXPECT_TRUE(cap_holes(shapes::octahedron()).has_inside);
}

// Edges of three triangles have no next border to go on along.
TEST(CapHoles, CountsEdgesThatLeadIntoNoLoop) {
  TriMesh fin = shapes::octahedron();
  fin.V.conservativeResize(7, 3);
  fin.V.row(6) << 2, 2, 2;
  fin.F.conservativeResize(9, 3);
  fin.F.row(8) << 0, 2, 6;
  const HoleCaps caps = cap_holes(fin);
  EXPECT_EQ(caps.stray_edges, 2);
  EXPECT_TRUE(caps.capped.empty());
  EXPECT_TRUE(caps.has_inside);
}

}  // namespace
}  // namespace geoprior
