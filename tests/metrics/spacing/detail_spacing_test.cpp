#include "metrics/spacing/detail_spacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

struct Pattern {
  Eigen::MatrixX3d x;
  Eigen::MatrixX3i triangles;
  std::vector<char> ghosts;
};

/// Rows of n points one apart, `shear` to the right from row to row and `rise` apart; the outermost
/// points are ghosts when asked for.
Pattern lattice(int n, double shear, double rise, bool ghosts) {
  Pattern p;
  p.x.resize(n * n, 3);
  p.triangles.resize(2 * (n - 1) * (n - 1), 3);
  int t = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int v = j * n + i;
      p.x.row(v) << i + shear * j, rise * j, 0;
      const bool outer = i == 0 || j == 0 || i == n - 1 || j == n - 1;
      p.ghosts.push_back(ghosts && outer ? 1 : 0);
      if (i + 1 == n || j + 1 == n) continue;
      p.triangles.row(t++) << v, v + 1, v + n;
      p.triangles.row(t++) << v + 1, v + n + 1, v + n;
    }
  }
  return p;
}

const double kRise = std::sqrt(0.75);

// Equilateral triangles: every edge is 1.
TEST(DetailSpacing, OfAHexagonalPatternIsItsConstant) {
  const Pattern p = lattice(9, 0.5, kRise, false);
  const DetailSpacing s = detail_spacing(p.x, p.triangles, p.ghosts);
  // 3 n^2 - 4 n + 1 = 208 edges in all, 4 (n - 1) = 32 of them on the border.
  EXPECT_EQ(s.edges, 208 - 32);
  EXPECT_NEAR(s.mean, 1, 1e-14);
  EXPECT_NEAR(s.smallest, 1, 1e-14);
  EXPECT_NEAR(s.variation, 0, 1e-13);
  for (const double d : s.deciles) EXPECT_NEAR(d, 1, 1e-14);
  EXPECT_EQ(s.outside, 0);
}

// A square grid with diagonals: of the inner edges (n-1)(n-2) lie along each axis, (n-1)^2 are
// diagonals of length sqrt 2, which is outside 0.7 … 1.4 of the grid's constant.
TEST(DetailSpacing, OfASquareGridHasTheMeanOfSidesAndDiagonals) {
  const int n = 11;
  const Pattern p = lattice(n, 0, 1, false);
  const DetailSpacing s = detail_spacing(p.x, p.triangles, p.ghosts, 1);
  const double sides = 2. * (n - 1) * (n - 2), diagonals = (n - 1.) * (n - 1);
  const double share = diagonals / (sides + diagonals);
  const double mean = 1 + share * (std::sqrt(2.) - 1);
  EXPECT_EQ(s.edges, static_cast<int>(sides + diagonals));
  EXPECT_NEAR(s.mean, mean, 1e-13);
  // Two values a, b with shares q, 1 - q: deviation |a - b| sqrt(q (1 - q)).
  EXPECT_NEAR(s.variation, (std::sqrt(2.) - 1) * std::sqrt(share * (1 - share)) / mean, 1e-13);
  EXPECT_EQ(s.smallest, 1);
  EXPECT_NEAR(s.outside, share, 1e-15);
  // The share of sides is 180 / 280 = 0.64: the sixth decile is a side, the seventh a diagonal.
  EXPECT_NEAR(s.deciles[5], 1, 1e-15);
  EXPECT_NEAR(s.deciles[6], std::sqrt(2.), 1e-15);
}

// With the outermost ring as ghosts, what counts is the pattern without that ring.
TEST(DetailSpacing, LeavesOutEdgesWithAGhostInATriangle) {
  const int n = 8;
  Pattern p = lattice(n, 0.5, kRise, true);
  for (int v = 0; v < n * n; ++v) {
    if (p.ghosts[v] != 0) p.x.row(v) *= 7;
  }
  const DetailSpacing s = detail_spacing(p.x, p.triangles, p.ghosts);
  const int inner = n - 2;
  EXPECT_EQ(s.edges, 3 * inner * inner - 4 * inner + 1 - 4 * (inner - 1));
  EXPECT_NEAR(s.mean, 1, 1e-14);
  EXPECT_NEAR(s.variation, 0, 1e-13);
}

// A tetrahedron has six edges, each of two triangles.
TEST(EdgesAmongDetails, OfAClosedMeshAreAllAndOnce) {
  Eigen::MatrixX3i f(4, 3);
  f << 0, 1, 2, 0, 3, 1, 1, 3, 2, 0, 2, 3;
  EXPECT_EQ(edges_among_details(f, {}).size(), 6U);
}

// Points 0 and 1 joined by two different edges: the square around a thin tube, four triangles with
// both half-edges of (0, 1) twice.
TEST(EdgesAmongDetails, CountsTwoPointsThatAreJoinedTwiceTwice) {
  Eigen::MatrixX3i f(4, 3);
  f << 0, 1, 2, 1, 0, 3, 0, 1, 3, 1, 0, 2;
  const auto edges = edges_among_details(f, {});
  EXPECT_EQ(std::count(edges.begin(), edges.end(), std::pair(0, 1)), 2);
}

// Stretched by 2 along x, edges along x double, the two others of a hexagonal pattern go from 1 to
// sqrt(1 + 3/4): the mean of the three is known. Shrunk uniformly, all change alike.
TEST(SpacingChange, OfAStretchedHexagonalPatternIsKnown) {
  Pattern p = lattice(40, 0.5, kRise, false);
  const auto at = [&](double sx, double sy) {
    Eigen::MatrixX3d x = p.x;
    x.col(0) *= sx;
    x.col(1) *= sy;
    return detail_spacing(x, p.triangles, p.ghosts);
  };
  const DetailSpacing original = at(1, 1);
  const double edges = original.edges;
  const double along = 38 * 39, slanted = edges - along;
  const double expected = (along * 2 + slanted * std::sqrt(1.75)) / edges - 1;
  EXPECT_NEAR(spacing_change(original, at(2, 1)).mean, expected, 1e-12);
  const SpacingChange shrunk = spacing_change(original, at(0.8, 0.8));
  EXPECT_NEAR(shrunk.mean, -0.2, 1e-13);
  for (const double d : shrunk.deciles) EXPECT_NEAR(d, -0.2, 1e-13);

  const std::vector<DetailSpacing> frames{original, at(1.1, 1.1), at(0.8, 0.8), at(1, 1)};
  const WorstChange worst = worst_mean_change(frames);
  EXPECT_NEAR(worst.change, -0.2, 1e-13);
  EXPECT_EQ(worst.frame, 2);
}

// Six details, four where the area triples, two where it halves: 13 keep the density.
TEST(DensityRatio, IsOneWhenTheNumberFollowsTheAreaUnderTheDetails) {
  const Eigen::Vector3d then(1, 2, 5), now(3, 1, 5);
  const std::vector<int> faces{0, 0, 1, 0, 1, 0};
  EXPECT_NEAR(density_ratio(13, faces, then, now), 1, 1e-15);
  EXPECT_NEAR(density_ratio(6, faces, then, then), 1, 1e-15);
  EXPECT_NEAR(density_ratio(6, faces, then, now), 6. / 13, 1e-15);
}

TEST(DetailSpacing, NamesWhatIsWrong) {
  Pattern p = lattice(3, 0, 1, false);
  p.triangles(2, 1) = 9;
  EXPECT_THROW(detail_spacing(p.x, p.triangles, p.ghosts), Error);
  EXPECT_THROW(worst_mean_change({}), Error);
  EXPECT_THROW(spacing_change({}, {}), Error);
  const std::vector<int> nowhere{3};
  EXPECT_THROW(density_ratio(1, nowhere, Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones()), Error);
  EXPECT_EQ(detail_spacing(Eigen::MatrixX3d(0, 3), Eigen::MatrixX3i(0, 3), {}).edges, 0);
}

}  // namespace
}  // namespace geoprior
