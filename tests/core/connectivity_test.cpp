#include "core/connectivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior {
namespace {

TEST(EdgeConnectivity, EdgesAscendAndHoldEveryHalfEdgeOnce) {
  const TriMesh mesh = shapes::sphere(3);
  const EdgeConnectivity c(mesh.F);
  // Euler: V - E + F = 2.
  EXPECT_EQ(mesh.vertex_count() - c.edge_count() + mesh.triangle_count(), 2);
  EXPECT_TRUE(std::is_sorted(c.edges().begin(), c.edges().end()));
  std::map<Edge, std::vector<int>> expected;
  for (int h = 0; h < 3 * mesh.triangle_count(); ++h) {
    const int a = mesh.F(h / 3, h % 3), b = mesh.F(h / 3, (h % 3 + 1) % 3);
    EXPECT_EQ(c.origin(h), a);
    EXPECT_EQ(c.tip(h), b);
    EXPECT_EQ(c.ascends(h), a < b);
    expected[{std::min(a, b), std::max(a, b)}].push_back(h);
  }
  ASSERT_EQ(static_cast<std::size_t>(c.edge_count()), expected.size());
  int e = 0;
  for (const auto& [edge, half_edges] : expected) {
    EXPECT_EQ(c.edge(e), edge);
    EXPECT_TRUE(std::ranges::equal(c.half_edges(e), half_edges));
    for (const int h : half_edges) EXPECT_EQ(c.edge_of(h), e);
    ++e;
  }
}

TEST(EdgeConnectivity, TrianglesAcrossAnEdgeShareItInOppositeDirections) {
  const TriMesh mesh = shapes::square(4);
  const EdgeConnectivity c(mesh.F);
  const auto all = c.across();
  int border = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int h = 3 * t + k, other = c.twin(h);
      EXPECT_EQ(all[t][k], c.across(t, k));
      EXPECT_EQ(c.across(t, k), other < 0 ? -1 : other / 3);
      if (other < 0) {
        ++border;
        continue;
      }
      EXPECT_EQ(c.twin(other), h);
      EXPECT_EQ(c.origin(other), c.tip(h));
      EXPECT_EQ(c.tip(other), c.origin(h));
    }
  }
  EXPECT_EQ(border, 16);
  EXPECT_FALSE(c.first_repeated());
}

TEST(EdgeConnectivity, LeftOfAnEdgeIsTheTriangleThatRunsUpIt) {
  Eigen::MatrixX3i F(2, 3);
  F << 0, 1, 2, 2, 1, 3;  // the second runs down 1-2
  const EdgeConnectivity c(F);
  const auto between = c.find(2, 1);
  ASSERT_TRUE(between);
  EXPECT_EQ(c.edge(*between), (Edge{1, 2}));
  EXPECT_EQ(c.left(*between), 0);
  EXPECT_EQ(c.right(*between), 1);
  const auto border = c.find(0, 2);
  ASSERT_TRUE(border);
  EXPECT_EQ(c.left(*border), -1);
  EXPECT_EQ(c.right(*border), 0);
  EXPECT_FALSE(c.find(0, 3));
}

TEST(EdgeConnectivity, ThreeTrianglesAtAnEdgeAreAllListedAndTheRepeatedOneIsNamed) {
  Eigen::MatrixX3i F(3, 3);
  F << 0, 1, 2, 1, 0, 3, 0, 1, 4;
  const EdgeConnectivity c(F);
  ASSERT_EQ(c.half_edges(0).size(), 3U);
  EXPECT_EQ(c.across(0, 0), -1);
  ASSERT_TRUE(c.first_repeated());
  EXPECT_EQ(*c.first_repeated(), 6);  // runs 0 to 1, as half-edge 0 does
}

TEST(EdgeConnectivity, TrianglesThatTurnOppositeWaysRepeatAnEdgeAndAreNeighbours) {
  Eigen::MatrixX3i F(2, 3);
  F << 0, 1, 2, 3, 1, 2;
  const EdgeConnectivity c(F);
  EXPECT_EQ(c.across(0, 1), 1);
  ASSERT_TRUE(c.first_repeated());
  EXPECT_EQ(*c.first_repeated(), 4);
}

TEST(EdgeConnectivity, TakesTrianglesInEitherForm) {
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {2, 1, 3}};
  Eigen::MatrixX3i F(2, 3);
  F << 0, 1, 2, 2, 1, 3;
  EXPECT_EQ(EdgeConnectivity(triangles).edges(), EdgeConnectivity(F).edges());
}

TEST(EdgeConnectivity, NoTrianglesHaveNoEdges) {
  const EdgeConnectivity c(Eigen::MatrixX3i(0, 3));
  EXPECT_EQ(c.edge_count(), 0);
  EXPECT_TRUE(c.across().empty());
  EXPECT_FALSE(c.find(0, 1));
}

std::vector<int> ring_of(const EdgeConnectivity& edges, int vertex) {
  std::vector<int> neighbours;
  for (const int v : ring(edges, vertex)) neighbours.push_back(v);
  return neighbours;
}

/// A fan about vertex 0: triangle k is 0, k + 1, k + 2, and the last one closes it or not.
Eigen::MatrixX3i fan(int triangles, bool closed) {
  Eigen::MatrixX3i F(triangles, 3);
  for (int k = 0; k < triangles; ++k) F.row(k) << 0, k + 1, k + 2;
  if (closed) F(triangles - 1, 2) = 1;
  return F;
}

TEST(Ring, GoesCounterClockwiseAroundAVertexInside) {
  const TriMesh mesh = shapes::square(2);
  const EdgeConnectivity edges(mesh.F);
  EXPECT_EQ(edges.vertex_count(), 9);
  EXPECT_EQ(edges.valence(4), 6);
  const std::vector<int> neighbours = ring_of(edges, 4);
  ASSERT_EQ(neighbours.size(), 6U);
  EXPECT_EQ(neighbours[0], *std::min_element(neighbours.begin(), neighbours.end()));
  double turned = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const Eigen::RowVector3d a = mesh.V.row(neighbours[i]) - mesh.V.row(4);
    const Eigen::RowVector3d b = mesh.V.row(neighbours[(i + 1) % 6]) - mesh.V.row(4);
    const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    EXPECT_GT(turn, 0);
    turned += turn;
  }
  EXPECT_NEAR(turned, 2 * std::numbers::pi, 1e-12);
}

TEST(Ring, RunsFromBorderEdgeToBorderEdge) {
  const EdgeConnectivity edges(fan(3, false));
  EXPECT_EQ(ring_of(edges, 0), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(ring_of(edges, 1), (std::vector<int>{2, 0}));
  EXPECT_EQ(ring_of(edges, 3), (std::vector<int>{4, 0, 2}));
  const EdgeConnectivity whole(fan(3, true));
  EXPECT_EQ(ring_of(whole, 0), (std::vector<int>{1, 2, 3}));
}

TEST(Ring, OfAClosedMeshHasEveryEdgeFromBothEnds) {
  const TriMesh mesh = shapes::sphere(2);
  const EdgeConnectivity edges(mesh.F);
  int sum = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const std::vector<int> neighbours = ring_of(edges, v);
    ASSERT_EQ(static_cast<int>(neighbours.size()), edges.valence(v));
    sum += edges.valence(v);
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      const auto edge = edges.find(v, neighbours[i]);
      ASSERT_TRUE(edge);
      // The triangle on the left of the way out holds the next one.
      const int out = edges.half_edge_from(v, *edge);
      EXPECT_EQ(edges.origin(EdgeConnectivity::previous(out)),
                neighbours[(i + 1) % neighbours.size()]);
    }
  }
  EXPECT_EQ(sum, 2 * edges.edge_count());
}

TEST(Ring, OfAVertexWithoutTrianglesIsEmpty) {
  Eigen::MatrixX3i F(1, 3);
  F << 0, 1, 3;
  const EdgeConnectivity edges(F);
  EXPECT_TRUE(ring_of(edges, 2).empty());
  EXPECT_TRUE(ring_of(edges, 9).empty());
  EXPECT_EQ(edges.valence(9), 0);
}

TEST(Ring, IsRefusedWhereFansMeetOrAnEdgeHasThreeTriangles) {
  Eigen::MatrixX3i open(2, 3), closed(8, 3), three(3, 3), turned(2, 3);
  open << 0, 1, 2, 0, 3, 4;
  const TriMesh tetrahedron = shapes::tetrahedron();
  closed << tetrahedron.F, (tetrahedron.F.array() == 0).select(0, tetrahedron.F.array() + 3);
  three << 0, 1, 2, 1, 0, 3, 0, 1, 4;
  turned << 0, 1, 2, 0, 3, 2;  // two triangles that turn opposite ways
  for (const Eigen::MatrixX3i& F : {open, closed, three, turned}) {
    const EdgeConnectivity edges(F);
    EXPECT_FALSE(edges.has_ring(0)) << F;
    EXPECT_THROW(ring(edges, 0), Error) << F;
  }
  EXPECT_EQ(ring_of(EdgeConnectivity(closed), 5).size(), 3U) << "elsewhere there is one";
}

TEST(VertexCorners, HoldEveryCornerOnceAscending) {
  const TriMesh mesh = shapes::square(3);
  const int n = mesh.vertex_count() + 1;  // the last vertex has no triangle
  const VertexCorners corners(mesh.F, n);
  int seen = 0;
  for (int v = 0; v < n; ++v) {
    const std::span<const int> here = corners.of(v);
    EXPECT_EQ(corners.begin(v), seen);
    EXPECT_EQ(corners.count(v), static_cast<int>(here.size()));
    EXPECT_TRUE(std::is_sorted(here.begin(), here.end()));
    for (const int c : here) EXPECT_EQ(mesh.F(c / 3, c % 3), v);
    seen += corners.count(v);
  }
  EXPECT_EQ(seen, 3 * mesh.triangle_count());
  EXPECT_TRUE(corners.of(n - 1).empty());
}

TEST(EdgeConnectivity, NegativeIndexIsRefused) {
  Eigen::MatrixX3i F(1, 3);
  F << 0, 1, -1;
  EXPECT_THROW(EdgeConnectivity{F}, Error);
}

}  // namespace
}  // namespace geoprior
