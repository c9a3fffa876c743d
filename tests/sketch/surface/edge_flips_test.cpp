#include "models/sketch/ridges/edge_flips.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/connectivity.h"

namespace geoprior::sketch {
namespace {

/// n x n squares, each of two triangles.
Eigen::MatrixX3i squares(int n) {
  Eigen::MatrixX3i F(2 * n * n, 3);
  for (int i = 0, t = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int v = i * (n + 1) + j, w = v + n + 1;
      F.row(t++) << v, v + 1, w + 1;
      F.row(t++) << v, w + 1, w;
    }
  }
  return F;
}

TEST(EdgeFlips, GiveADiamondItsOtherDiagonal) {
  Eigen::MatrixX3i F = squares(4);
  const EdgeConnectivity before(F);
  EdgeDiamond made{};
  const int flips = flip_edges(F, [&](const EdgeDiamond& of) {
    if (std::min(of.a, of.b) != 6 || std::max(of.a, of.b) != 12) return false;
    made = of;
    return true;
  });
  ASSERT_EQ(flips, 1);
  const EdgeConnectivity after(F);
  EXPECT_FALSE(after.find(6, 12));
  EXPECT_TRUE(after.find(made.c, made.d));
  EXPECT_EQ(made.c + made.d, 7 + 11) << "the other corners of the square";
  EXPECT_EQ(after.edge_count(), before.edge_count());
}

TEST(EdgeFlips, LeaveAManifoldWhateverIsWanted) {
  Eigen::MatrixX3i F = squares(6);
  const int edges = EdgeConnectivity(F).edge_count();
  int flips = 0;
  for (int pass = 0; pass < 20; ++pass) flips += flip_edges(F, [](const auto&) { return true; });
  EXPECT_GT(flips, 100);
  const EdgeConnectivity after(F);
  EXPECT_EQ(after.edge_count(), edges);
  EXPECT_FALSE(after.first_repeated());
  for (int e = 0; e < after.edge_count(); ++e) EXPECT_LE(after.half_edges(e).size(), 2U);
  for (int v = 0; v < 49; ++v) EXPECT_TRUE(after.has_ring(v)) << v;
}

TEST(EdgeFlips, AskForNothingAtABorderAndAtCornersOfThree) {
  Eigen::MatrixX3i F = squares(1);
  EXPECT_EQ(flip_edges(F, [](const auto&) { return true; }), 0);
  EXPECT_EQ(F, squares(1));
}

}  // namespace
}  // namespace geoprior::sketch
