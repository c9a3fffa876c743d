#include "metrics/arrangement/terrain_gap.h"

#include <gtest/gtest.h>

#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

/// The plane z = x + 2 y over n x n squares of side 1, corner at the origin.
TriMesh slope(int n) {
  TriMesh m;
  m.V.resize((n + 1) * (n + 1), 3);
  m.F.resize(2 * n * n, 3);
  int f = 0;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const int v = y * (n + 1) + x;
      m.V.row(v) << x, y, x + 2 * y;
      if (x == n || y == n) continue;
      m.F.row(f++) << v, v + 1, v + n + 2;
      m.F.row(f++) << v, v + n + 2, v + n + 1;
    }
  return m;
}

TEST(ArrangementTerrain, GapIsTheHeightOverTheSlope) {
  const TerrainHeights terrain(slope(5));
  EXPECT_NEAR(*terrain.height_near({1.25, 3.5, 0}), 1.25 + 7, 1e-14);
  EXPECT_NEAR(terrain.gap({1.25, 3.5, 9}), 0.75, 1e-14);
  EXPECT_NEAR(terrain.gap({1.25, 3.5, 8}), -0.25, 1e-14);
}

TEST(ArrangementTerrain, HasNoGapsAtItsEdges) {
  const TerrainHeights terrain(slope(5));
  for (double y = 0; y <= 5; ++y)
    for (double x = 0; x <= 5; ++x) EXPECT_NEAR(terrain.gap({x, y, x + 2 * y}), 0, 1e-14);
  EXPECT_NEAR(terrain.gap({0.1 + 0.2, 0.3, 0.9}), 0, 1e-14);
}

TEST(ArrangementTerrain, BesideItCountsTheNearestVertex) {
  const TerrainHeights terrain(slope(2));
  EXPECT_FALSE(terrain.height_near({5, 6, 0}));
  EXPECT_DOUBLE_EQ(terrain.gap({5, 6, 6}), 5);  // from (2, 2, 6)
}

TEST(ArrangementTerrain, OfTwoHeightsTheNearerCounts) {
  TriMesh m = slope(1);
  TriMesh above = m;
  above.V.col(2).array() += 10;
  TriMesh both;
  both.V.resize(8, 3);
  both.V << m.V, above.V;
  both.F.resize(4, 3);
  both.F << m.F, above.F.array() + 4;
  const TerrainHeights terrain(both);
  EXPECT_NEAR(terrain.gap({0.5, 0.5, 2}), 0.5, 1e-14);
  EXPECT_NEAR(terrain.gap({0.5, 0.5, 11}), -0.5, 1e-14);
}

TEST(ArrangementTerrain, NeedsATriangleThatIsSeenFromAbove) {
  TriMesh upright;
  upright.V.resize(3, 3);
  upright.V << 0, 0, 0, 1, 0, 0, 1, 0, 1;
  upright.F.resize(1, 3);
  upright.F << 0, 1, 2;
  test::expect_error([&] { (void)TerrainHeights(upright); }, {"no triangle is seen from above"});
}

}  // namespace
}  // namespace geoprior
