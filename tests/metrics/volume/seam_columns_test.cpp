#include "metrics/volume/seam_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace geoprior {
namespace {

/// A flat sheet with one vertex in the middle of each square of an n x n grid of edge 1.
TriMesh sheet(int n) {
  TriMesh mesh;
  mesh.V.resize(Eigen::Index{n} * n, 3);
  mesh.F.resize(Eigen::Index{2} * (n - 1) * (n - 1), 3);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) mesh.V.row(i + n * j) << i + 0.5, j + 0.5, 0;
  }
  Eigen::Index t = 0;
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const int v = i + n * j;
      mesh.F.row(t++) << v, v + 1, v + n;
      mesh.F.row(t++) << v + 1, v + n + 1, v + n;
    }
  }
  return mesh;
}

// A marked square of 5 x 5 in 9 x 9: its outermost ring, 16 columns, touches plain ones.
TEST(SeamColumns, OfAMarkedSquareAreItsRing) {
  constexpr int n = 9;
  const TriMesh mesh = sheet(n);
  const ColumnGrid grid{{0, 0}, 1, n, n};
  std::vector<char> marked(n * n, 0);
  for (int j = 2; j < 7; ++j) {
    for (int i = 2; i < 7; ++i) marked[i + n * j] = 1;
  }
  const std::vector<char> seam = seam_columns(grid, mesh, marked);
  EXPECT_EQ(std::count(seam.begin(), seam.end(), 1), 16);
  EXPECT_EQ(seam[grid.index(2, 4)], 1);
  EXPECT_EQ(seam[grid.index(4, 4)], 0);
  EXPECT_EQ(seam[grid.index(1, 4)], 0);
}

TEST(SeamColumns, AreNoneWhereEverythingOrNothingIsMarked) {
  const TriMesh mesh = sheet(5);
  const ColumnGrid grid{{0, 0}, 1, 5, 5};
  for (const char mark : {char{0}, char{1}}) {
    const std::vector<char> seam = seam_columns(grid, mesh, std::vector<char>(25, mark));
    EXPECT_EQ(std::count(seam.begin(), seam.end(), 1), 0);
  }
}

TEST(ValuesWhere, AreAbsentWithoutTheFlag) {
  const Eigen::VectorXd kept = values_where(Eigen::Vector3d(1, 2, 3), {1, 0, 1});
  EXPECT_EQ(kept[0], 1);
  EXPECT_TRUE(std::isnan(kept[1]));
  EXPECT_EQ(kept[2], 3);
}

}  // namespace
}  // namespace geoprior
