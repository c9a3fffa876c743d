#include "core/geometry/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior {
namespace {

/// Text of the Error that `body` throws, empty when it throws none.
template <class Body>
std::string error_of(const Body& body) {
  try {
    body();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(Topology, ClosedMeshHasNeitherBoundaryNorBadEdges) {
  const TriMesh mesh = shapes::octahedron();
  EXPECT_TRUE(boundary_edges(mesh.F).empty());
  EXPECT_TRUE(non_manifold_edges(mesh.F).empty());
  EXPECT_NO_THROW(require_closed_manifold(mesh, "test", "octahedron"));
}

TEST(Topology, MeanEdgeLengthCountsEveryEdgeOnce) {
  TriMesh square;  // of side 1, with a diagonal
  square.V.resize(4, 3);
  square.V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  square.F.resize(2, 3);
  square.F << 0, 1, 2, 0, 2, 3;
  EXPECT_NEAR(mean_edge_length(square.V, EdgeConnectivity(square.F)), (4 + std::sqrt(2)) / 5,
              1e-15);
  EXPECT_EQ(mean_edge_length(square.V, EdgeConnectivity(Eigen::MatrixX3i(0, 3))), 0);
}

TEST(Topology, MissingTriangleLeavesItsThreeEdgesOpen) {
  TriMesh mesh = shapes::octahedron();
  mesh.F.conservativeResize(7, 3);  // without 0, 3, 5
  const std::vector<Edge> open = boundary_edges(mesh.F);
  // The border runs along the hole as the remaining triangles see it: against the missing one.
  for (const Edge& e : {Edge{3, 0}, Edge{5, 3}, Edge{0, 5}})
    EXPECT_NE(std::find(open.begin(), open.end(), e), open.end()) << e[0] << "-" << e[1];
  EXPECT_EQ(open.size(), 3U);
  const std::vector<bool> border = boundary_vertices(mesh.F, 6);
  EXPECT_EQ(std::count(border.begin(), border.end(), true), 3);
  const std::string text = error_of([&] { require_closed_manifold(mesh, "volume", "bowl.obj"); });
  EXPECT_NE(text.find("bowl.obj"), std::string::npos);
  EXPECT_NE(text.find("3-0"), std::string::npos);
  EXPECT_NE(text.find("3 boundary edges"), std::string::npos);
}

TEST(Topology, ThirdTriangleOnAnEdgeIsNamed) {
  TriMesh mesh = shapes::octahedron();
  mesh.V.conservativeResize(7, 3);
  mesh.V.row(6) << 2, 2, 2;
  mesh.F.conservativeResize(9, 3);
  mesh.F.row(8) << 0, 2, 6;  // a third triangle at 0-2
  const std::vector<Edge> bad = non_manifold_edges(mesh.F);
  ASSERT_EQ(bad.size(), 1U);
  EXPECT_EQ(bad[0], (Edge{0, 2}));
  const std::string text = error_of([&] { require_closed_manifold(mesh, "test", "fin.obj"); });
  EXPECT_NE(text.find("0-2"), std::string::npos);
}

TEST(Topology, FlippedTriangleIsNotConsistentlyOriented) {
  TriMesh mesh = shapes::octahedron();
  std::swap(mesh.F(0, 0), mesh.F(0, 1));
  EXPECT_EQ(non_manifold_edges(mesh.F).size(), 3U);
  EXPECT_THROW(require_closed_manifold(mesh, "test", ""), Error);
}

TEST(Topology, RingsAreInCyclicOrderCounterClockwise) {
  const TriMesh mesh = shapes::sphere(2);
  const VertexGraph rings = one_rings(mesh.F, mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto ring = rings.of(v);
    ASSERT_GE(ring.size(), 4U);
    const Eigen::RowVector3d p = mesh.V.row(v);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::RowVector3d a = mesh.V.row(ring[i]) - p;
      const Eigen::RowVector3d b = mesh.V.row(ring[(i + 1) % ring.size()]) - p;
      EXPECT_GT(a.cross(b).dot(p), 0) << v;  // outward is p itself on the sphere
      // Neighbours that follow one another share a triangle, hence an edge.
      const auto of = rings.of(ring[i]);
      EXPECT_NE(std::find(of.begin(), of.end(), ring[(i + 1) % ring.size()]), of.end());
    }
  }
}

TEST(Topology, RingOfABorderVertexStartsAndEndsOnTheBorder) {
  const TriMesh mesh = shapes::square(4);
  const VertexGraph rings = one_rings(mesh.F, mesh.vertex_count());
  const std::vector<bool> border = boundary_vertices(mesh.F, mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (!border[v]) continue;
    const auto ring = rings.of(v);
    EXPECT_TRUE(border[ring.front()]) << v;
    EXPECT_TRUE(border[ring.back()]) << v;
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
      const Eigen::RowVector3d a = mesh.V.row(ring[i]) - mesh.V.row(v);
      const Eigen::RowVector3d b = mesh.V.row(ring[i + 1]) - mesh.V.row(v);
      EXPECT_GT(a.cross(b).z(), 0) << v;
    }
  }
}

TEST(Topology, WeldMergesSeamsAndKeepsTheOrder) {
  const TriMesh whole = shapes::octahedron();
  TriMesh split;  // every triangle with vertices of its own
  split.V.resize(24, 3);
  split.F.resize(8, 3);
  for (int t = 0; t < 8; ++t) {
    for (int k = 0; k < 3; ++k) {
      split.V.row(3 * t + k) = whole.V.row(whole.F(t, k));
      split.F(t, k) = 3 * t + k;
    }
  }
  split.V(0, 1) = -0.0;  // equal to +0
  const Weld weld = weld_by_position(split);
  EXPECT_EQ(weld.mesh.vertex_count(), 6);
  EXPECT_NO_THROW(require_closed_manifold(weld.mesh, "test", ""));
  for (int v = 0; v < 24; ++v) {
    const int w = weld.welded_of_split[v];
    EXPECT_EQ((weld.mesh.V.row(w) - split.V.row(v)).norm(), 0);
  }
  for (std::size_t w = 1; w < 6; ++w)
    EXPECT_LT(weld.split_of_welded[w - 1], weld.split_of_welded[w]);
}

TEST(Topology, WeldDropsTrianglesThatCollapse) {
  TriMesh mesh = shapes::octahedron();
  mesh.V.row(2) = mesh.V.row(0);
  EXPECT_EQ(weld_by_position(mesh).mesh.triangle_count(), 6);  // the two at edge 0-2 are gone
}

}  // namespace
}  // namespace geoprior
