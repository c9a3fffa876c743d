#include "models/sketch/surface/cut_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "models/sketch/surface/shortest_cut.h"
#include "tests/core/geometry/shapes.h"
#include "tests/sketch/pattern/flat_surfaces.h"

namespace geoprior::sketch {
namespace {

using ::geoprior::shapes::octahedron;
using ::geoprior::shapes::sphere;
using ::geoprior::shapes::square;
using ::geoprior::shapes::tetrahedron;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Facts of any cut: triangles are shared out, places are kept, stretches cover the borders, and
/// the two sides of a seam run the opposite ways through the same vertices of the surface.
void expect_consistent(const TriMesh& surface, const std::vector<CutPiece>& pieces) {
  std::vector<int> seen(surface.triangle_count(), 0);
  for (int p = 0; p < std::ssize(pieces); ++p) {
    const CutPiece& piece = pieces[p];
    for (std::size_t i = 0; i < piece.surface_triangle.size(); ++i) {
      const int t = piece.surface_triangle[i];
      ++seen[t];
      for (int k = 0; k < 3; ++k) {
        const int v = piece.mesh.F(i, k);
        EXPECT_EQ(piece.surface_vertex[v], surface.F(t, k));
        EXPECT_EQ(piece.mesh.V.row(v), surface.V.row(surface.F(t, k)));
      }
    }
    std::size_t border = 0, stretches = 0;
    for (const std::vector<int>& loop : piece.borders) border += loop.size();
    for (int e = 0; e < std::ssize(piece.edges); ++e) {
      const PieceEdge& edge = piece.edges[e];
      stretches += edge.vertices.size() - 1;
      EXPECT_EQ(edge.seam < 0, edge.partner_piece < 0);
      if (edge.partner_piece < 0) continue;
      const CutPiece& other = pieces[edge.partner_piece];
      const PieceEdge& partner = other.edges[edge.partner_edge];
      EXPECT_EQ(partner.seam, edge.seam);
      EXPECT_EQ(partner.partner_piece, p);
      EXPECT_EQ(partner.partner_edge, e);
      ASSERT_EQ(partner.vertices.size(), edge.vertices.size());
      for (std::size_t i = 0; i < edge.vertices.size(); ++i) {
        EXPECT_EQ(piece.surface_vertex[edge.vertices[i]],
                  other.surface_vertex[partner.vertices[edge.vertices.size() - 1 - i]]);
      }
    }
    EXPECT_EQ(stretches, border);
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

std::vector<CutPiece> cut(const TriMesh& surface, const std::vector<SeamEdge>& seams) {
  std::vector<CutPiece> pieces = cut_surface(surface, seams);
  expect_consistent(surface, pieces);
  return pieces;
}

std::vector<SeamEdge> joined(std::vector<SeamEdge> a, const std::vector<SeamEdge>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(CutSurface, WithoutSeamsCopiesTheSurface) {
  const TriMesh mesh = square(3);
  const std::vector<CutPiece> pieces = cut(mesh, {});
  ASSERT_THAT(pieces, SizeIs(1));
  EXPECT_TRUE(pieces[0].is_disc());
  EXPECT_EQ(pieces[0].mesh.vertex_count(), 16);
  ASSERT_THAT(pieces[0].edges, SizeIs(1));
  EXPECT_THAT(pieces[0].edges[0].vertices, SizeIs(13)) << "12 edges of a closed stretch";
  EXPECT_EQ(pieces[0].edges[0].vertices.front(), pieces[0].edges[0].vertices.back());
  EXPECT_EQ(pieces[0].edges[0].seam, -1);
}

TEST(CutSurface, SeamAcrossMakesTwoPiecesThatAreSewnTogether) {
  const TriMesh mesh = square(4);
  const std::vector<CutPiece> pieces = cut(mesh, flats::seam_along({2, 7, 12, 17, 22}, 5));
  ASSERT_THAT(pieces, SizeIs(2));
  EXPECT_EQ(pieces[0].mesh.vertex_count() + pieces[1].mesh.vertex_count(), 25 + 5);
  for (const CutPiece& piece : pieces) {
    EXPECT_TRUE(piece.is_disc());
    ASSERT_THAT(piece.edges, SizeIs(2)) << "the seam and the rest of the border";
    EXPECT_NE(piece.edges[0].seam, piece.edges[1].seam);
  }
}

// A dart of n edges inside a disc doubles the n - 1 vertices between its ends and the one at the
// border; its tip stays one vertex.
TEST(CutSurface, DartStaysOnePieceAndIsSewnToItself) {
  const TriMesh mesh = square(4);
  const std::vector<CutPiece> pieces = cut(mesh, flats::seam_along({2, 7, 12}, 0));
  ASSERT_THAT(pieces, SizeIs(1));
  const CutPiece& piece = pieces[0];
  EXPECT_TRUE(piece.is_disc());
  EXPECT_EQ(piece.mesh.vertex_count(), 25 + 2);
  ASSERT_THAT(piece.edges, SizeIs(3)) << "two sides of the dart, the rest of the border";
  const auto side = std::find_if(piece.edges.begin(), piece.edges.end(),
                                 [](const PieceEdge& e) { return e.seam == 0; });
  EXPECT_EQ(side->partner_piece, 0);
  EXPECT_THAT(side->vertices, SizeIs(3));
  EXPECT_EQ(side->vertices.back(), piece.edges[side->partner_edge].vertices.front())
      << "both sides meet at the tip";
}

// A slit that does not reach the border makes a second border of twice its edges.
TEST(CutSurface, SlitInsideMakesAnAnnulus) {
  const TriMesh mesh = square(4);
  const std::vector<CutPiece> pieces = cut(mesh, flats::seam_along({11, 12, 13}, 0));
  ASSERT_THAT(pieces, SizeIs(1));
  EXPECT_FALSE(pieces[0].is_disc());
  EXPECT_EQ(pieces[0].genus(), 0);
  ASSERT_EQ(pieces[0].border_count(), 2);
  EXPECT_THAT(pieces[0].borders[0], SizeIs(16)) << "the longest border first";
  EXPECT_THAT(pieces[0].borders[1], SizeIs(4));
}

TEST(CutSurface, ClosedSeamCutsOutADiscAndLeavesAHole) {
  const TriMesh mesh = square(4);
  const std::vector<CutPiece> pieces =
      cut(mesh, flats::seam_along({6, 7, 8, 13, 18, 17, 16, 11, 6}, 0));
  ASSERT_THAT(pieces, SizeIs(2));
  EXPECT_EQ(pieces[0].border_count(), 2);
  EXPECT_TRUE(pieces[1].is_disc());
  ASSERT_THAT(pieces[1].edges, SizeIs(1));
  EXPECT_EQ(pieces[1].surface_vertex[pieces[1].edges[0].vertices.front()], 6)
      << "a closed stretch starts at the vertex lowest in the surface, on both sides";
  EXPECT_EQ(pieces[1].edges[0].vertices.front(), pieces[1].edges[0].vertices.back());
}

// Two loops with one vertex in common: two discs and what is left around them, whose border passes
// the crossing twice.
TEST(CutSurface, FigureEightIsCutAtItsCrossing) {
  const TriMesh mesh = square(6);
  const auto v = [](int i, int j) { return 7 * j + i; };
  std::vector<int> eight{v(3, 3), v(2, 3), v(1, 3), v(1, 2), v(1, 1), v(2, 1),
                         v(3, 1), v(3, 2), v(3, 3), v(4, 3), v(5, 3), v(5, 4),
                         v(5, 5), v(4, 5), v(3, 5), v(3, 4), v(3, 3)};
  const std::vector<CutPiece> pieces = cut(mesh, flats::seam_along(eight, 1));
  ASSERT_THAT(pieces, SizeIs(3));
  int discs = 0;
  for (const CutPiece& piece : pieces) {
    if (!piece.is_disc()) {
      // The plane corners of the crossing belong to two fans: its border there is one loop of 16.
      ASSERT_EQ(piece.border_count(), 2);
      EXPECT_THAT(piece.borders[1], SizeIs(16));
      EXPECT_EQ(std::count(piece.surface_vertex.begin(), piece.surface_vertex.end(), v(3, 3)), 2);
      continue;
    }
    ++discs;
    ASSERT_THAT(piece.edges, SizeIs(1));
    EXPECT_EQ(piece.surface_vertex[piece.edges[0].vertices.front()], v(3, 3));
  }
  EXPECT_EQ(discs, 2);
}

// Three seams that meet in a vertex: the sides of the branches end there.
TEST(CutSurface, BranchEndsStretchesOfOneSeam) {
  const TriMesh mesh = square(4);
  std::vector<SeamEdge> seams = flats::seam_along({10, 11, 12, 13, 14}, 0);
  seams = joined(seams, flats::seam_along({12, 17, 22}, 0));
  const std::vector<CutPiece> pieces = cut(mesh, seams);
  ASSERT_THAT(pieces, SizeIs(3));
  EXPECT_THAT(pieces[0].edges, SizeIs(3)) << "the seam is cut where the branch leaves";
}

TEST(CutSurface, TwoGreatCirclesCutASphereIntoFourAndTwoParallelsIntoThree) {
  const TriMesh ball = sphere(3);
  const std::vector<CutPiece> four =
      cut(ball, joined(flats::great_circle(ball, 0, 0), flats::great_circle(ball, 1, 1)));
  ASSERT_THAT(four, SizeIs(4));
  for (const CutPiece& piece : four) {
    EXPECT_TRUE(piece.is_disc());
    EXPECT_THAT(piece.edges, SizeIs(2));
  }
  // Borders of the triangles above and below two heights.
  std::vector<SeamEdge> parallels;
  const EdgeConnectivity edges(ball.F);
  const auto band = [&](int t) {
    const double z =
        (ball.V(ball.F(t, 0), 2) + ball.V(ball.F(t, 1), 2) + ball.V(ball.F(t, 2), 2)) / 3;
    return z > 0.5 ? 2 : (z > -0.5 ? 1 : 0);
  };
  for (int e = 0; e < edges.edge_count(); ++e) {
    const int left = band(edges.left(e)), right = band(edges.right(e));
    if (left != right) parallels.push_back({edges.edge(e), std::max(left, right)});
  }
  const std::vector<CutPiece> three = cut(ball, parallels);
  ASSERT_THAT(three, SizeIs(3));
  std::vector<int> borders;
  for (const CutPiece& piece : three) {
    borders.push_back(piece.border_count());
    EXPECT_EQ(piece.genus(), 0);
  }
  std::sort(borders.begin(), borders.end());
  EXPECT_THAT(borders, ElementsAre(1, 1, 2)) << "two caps and a belt";
}

TEST(CutSurface, CountsHandles) {
  // A torus of 8 x 6 cells.
  TriMesh torus = flats::tube(1, 1, 1, 8, 6);
  for (Eigen::Index i = 0; i < torus.F.size(); ++i) torus.F.data()[i] %= 48;
  torus.V.conservativeResize(48, 3);
  const std::vector<CutPiece> pieces = cut(torus, {});
  ASSERT_THAT(pieces, SizeIs(1));
  EXPECT_EQ(pieces[0].genus(), 1);
  EXPECT_EQ(pieces[0].border_count(), 0);
  std::vector<SeamEdge> seams;
  for (const Edge& edge : shortest_cut(torus)) seams.push_back({edge, 0});
  const std::vector<CutPiece> opened = cut(torus, seams);
  ASSERT_THAT(opened, SizeIs(1));
  EXPECT_TRUE(opened[0].is_disc());
}

TEST(CutSurface, RefusesWhatIsNoSeamAndNoManifold) {
  const auto refusal = [](const TriMesh& mesh, const std::vector<SeamEdge>& seams) -> std::string {
    try {
      cut_surface(mesh, seams);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(refusal(square(2), {{{0, 8}, 0}}), HasSubstr("edge 0 8"));
  EXPECT_THAT(refusal(square(2), {{{0, 4}, -2}}), HasSubstr("seam is negative"));
  TriMesh turned = tetrahedron();
  std::swap(turned.F(0, 0), turned.F(0, 1));
  EXPECT_THAT(refusal(turned, {}), HasSubstr("no consistently oriented manifold"));
  EXPECT_THAT(cut_surface(square(2), std::vector<SeamEdge>{{{0, 1}, 0}}), SizeIs(1))
      << "an edge at the border is open already";
}

TEST(ShortestCut, OfATubeIsOneColumn) {
  const TriMesh tube = flats::tube(1, 1, 2, 12, 5);
  const std::vector<Edge> path = shortest_cut(tube);
  ASSERT_THAT(path, SizeIs(5));
  double length = 0;
  for (const Edge& edge : path) length += (tube.V.row(edge[0]) - tube.V.row(edge[1])).norm();
  EXPECT_NEAR(length, 2, 1e-12);
  EXPECT_THAT(shortest_cut(square(3)), SizeIs(0)) << "a disc needs none";
}

TEST(ShortestCut, MakesDiscsOfClosedSurfacesAndOfManyBorders) {
  for (const TriMesh& mesh : {tetrahedron(), octahedron(), sphere(2),
                              flats::part(sphere(3), [](const Eigen::Vector3d& c) {
                                return c.cwiseAbs().maxCoeff() < 0.9;
                              })}) {
    std::vector<SeamEdge> seams;
    for (const Edge& edge : shortest_cut(mesh)) seams.push_back({edge, 0});
    const std::vector<CutPiece> pieces = cut(mesh, seams);
    ASSERT_THAT(pieces, SizeIs(1));
    EXPECT_TRUE(pieces[0].is_disc());
  }
}

// Gauss-Bonnet: the turnings of the borders and the angle defects inside add up to 2 pi chi. The
// frustum's facets have no defect; a plane polygon turns by 2 pi, and the hole in it by -2 pi.
TEST(BorderTurnings, FollowGaussBonnet) {
  const std::vector<double> flat = border_turnings(cut_surface(square(3), {})[0]);
  EXPECT_THAT(flat, ElementsAre(::testing::DoubleNear(kFullTurn, 1e-12)));
  const std::vector<double> tube = border_turnings(cut_surface(flats::tube(1, 1, 1, 9, 2), {})[0]);
  EXPECT_THAT(tube, ElementsAre(::testing::DoubleNear(0, 1e-12), ::testing::DoubleNear(0, 1e-12)));
  const std::vector<double> frustum =
      border_turnings(cut_surface(flats::tube(2, 1, 1, 9, 3), {})[0]);
  EXPECT_NEAR(frustum[0] + frustum[1], 0, 1e-12);
  EXPECT_GT(frustum[0], 1);
  const std::vector<CutPiece> ring =
      cut_surface(square(4), flats::seam_along({6, 7, 8, 13, 18, 17, 16, 11, 6}, 0));
  EXPECT_NEAR(border_turnings(ring[0])[1], -kFullTurn, 1e-12);
}

}  // namespace
}  // namespace geoprior::sketch
