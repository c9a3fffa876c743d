#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>

#include "baselines/fluid/liquid/surface/isosurface.h"
#include "baselines/fluid/liquid/surface/isosurface_table.h"
#include "baselines/fluid/liquid/surface/liquid_surface.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior::fluid {
namespace {

/// The exact statement "closed, oriented 2-manifold": every directed edge once and with its
/// opposite, and the triangles around each vertex form a single fan.
testing::AssertionResult is_closed_manifold(const TriMesh& mesh) {
  std::set<std::array<int, 2>> directed;
  std::vector<std::map<int, int>> link(mesh.vertex_count());
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int c = 0; c < 3; ++c) {
      const int a = mesh.F(t, c), b = mesh.F(t, (c + 1) % 3), d = mesh.F(t, (c + 2) % 3);
      if (a == b) return testing::AssertionFailure() << "triangle " << t << " repeats a vertex";
      if (!directed.insert({a, b}).second)
        return testing::AssertionFailure() << "edge " << a << " -> " << b << " twice";
      link[a][b] = d;
    }
  for (const auto& [a, b] : directed)
    if (!directed.contains({b, a}))
      return testing::AssertionFailure() << "edge " << a << " -> " << b << " has no opposite";
  for (std::size_t v = 0; v < link.size(); ++v) {
    if (link[v].empty()) return testing::AssertionFailure() << "vertex " << v << " is unused";
    std::size_t length = 0;
    int at = link[v].begin()->first;
    do {
      at = link[v].at(at);
      ++length;
    } while (at != link[v].begin()->first && length <= link[v].size());
    if (length != link[v].size())
      return testing::AssertionFailure() << "vertex " << v << " has more than one fan";
  }
  return testing::AssertionSuccess();
}

ScalarGrid sampled(int n, const std::function<double(const Eigen::Vector3d&)>& f) {
  ScalarGrid grid({n + 1, n + 1, n + 1}, 0);
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        grid(i, j, k) = static_cast<float>(f(Eigen::Vector3d(i, j, k) / n));
  return grid;
}

TEST(SurfaceIsosurface, EveryOneOfThe256CubesIsClosedManifold) {
  // The eight nodes in the middle of a 4^3 grid take every set of signs; the rest is outside.
  for (int set = 0; set < 256; ++set) {
    ScalarGrid grid({4, 4, 4}, 1);
    for (int c = 0; c < 8; ++c)
      if ((set >> c) & 1) grid(1 + (c & 1), 1 + ((c >> 1) & 1), 1 + (c >> 2)) = -0.7F;
    const TriMesh mesh = isosurface(grid, Eigen::Vector3d::Zero(), 1);
    EXPECT_TRUE(is_closed_manifold(mesh)) << set;
    EXPECT_EQ(mesh.triangle_count() == 0, set == 0);
    if (set > 0) {
      EXPECT_GT(signed_volume(mesh.V, mesh.F), 0) << set;
    }
  }
}

TEST(SurfaceIsosurface, TheTableUsesEveryCrossedEdgeAndNoDiagonalInAFace) {
  for (std::size_t set = 0; set < 256; ++set) {
    const auto& edges = cube_table().edges[set];
    std::set<int> used, crossed;
    for (const CubeEdge& e : edges) used.insert(8 * e.axis + e.corner);
    for (int axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 8; ++corner) {
        if ((corner >> axis) & 1) continue;
        const bool low = (set >> corner) & 1, high = (set >> (corner | (1 << axis))) & 1;
        if (low != high) crossed.insert(8 * axis + corner);
      }
    EXPECT_EQ(used, crossed) << set;
    // A side of a triangle that lies in a face must be on the border of the cube's piece: it
    // occurs once. Inner sides occur twice, in both directions.
    std::map<std::array<int, 2>, int> sides;
    for (std::size_t t = 0; t < edges.size(); t += 3)
      for (std::size_t c = 0; c < 3; ++c) {
        const CubeEdge &a = edges[t + c], &b = edges[t + (c + 1) % 3];
        ++sides[{8 * a.axis + a.corner, 8 * b.axis + b.corner}];
      }
    for (const auto& [side, count] : sides) {
      EXPECT_EQ(count, 1);
      if (!sides.contains({side[1], side[0]})) continue;
      const int a = side[0], b = side[1];
      for (int axis = 0; axis < 3; ++axis) {
        if (axis == a / 8 || axis == b / 8) continue;
        EXPECT_NE((a % 8 >> axis) & 1, (b % 8 >> axis) & 1) << set;
      }
    }
  }
}

TEST(SurfaceIsosurface, RandomFieldsGiveClosedManifolds) {
  // 2000 fields of independent signs meet every ambiguous face from both sides, many times; a third
  // of the values is exactly 0, and the border holds liquid too.
  RandomStream random(11, "fields");
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = 2 + static_cast<int>(random.below(4));
    ScalarGrid grid({n, n + static_cast<int>(random.below(3)), n}, 0);
    for (float& v : grid.values)
      v = trial % 3 == 0 ? static_cast<float>(static_cast<int>(random.below(3)) - 1)
                         : static_cast<float>(random.normal());
    const TriMesh mesh = isosurface(grid, Eigen::Vector3d::Zero(), 1);
    ASSERT_TRUE(is_closed_manifold(mesh)) << trial;
    ASSERT_TRUE(mesh.V.allFinite());
    ASSERT_GE(
        triangle_areas(mesh.V, mesh.F).size() == 0 ? 1 : triangle_areas(mesh.V, mesh.F).minCoeff(),
        1e-5);  // half of 0.01 x 0.01 edges, halved again
  }
}

TEST(SurfaceIsosurface, AllNegativeIsClosedOnTheBorder) {
  const TriMesh mesh = isosurface(ScalarGrid({6, 7, 8}, -1), {1, 2, 3}, 0.5);
  EXPECT_TRUE(is_closed_manifold(mesh));
  // A hundredth of a cell off the six sides, ribs cut by as little.
  EXPECT_NEAR(signed_volume(mesh.V, mesh.F), 2.49 * 2.99 * 3.49, 0.01);
  EXPECT_NEAR(mesh.V.col(0).minCoeff(), 1.005, 1e-9);
  EXPECT_NEAR(mesh.V.col(2).maxCoeff(), 3 + 3.495, 1e-9);
}

TEST(SurfaceIsosurface, NothingInsideIsAnEmptyMesh) {
  EXPECT_EQ(isosurface(ScalarGrid({6, 6, 6}, 1), {0, 0, 0}, 1).vertex_count(), 0);
  EXPECT_EQ(isosurface(ScalarGrid({1, 2, 2}, -1), {0, 0, 0}, 1).vertex_count(), 0);
}

TEST(SurfaceIsosurface, ASphereConvergesToSecondOrder) {
  constexpr double kRadius = 0.31;
  const double exact = 4.0 / 3 * std::numbers::pi * std::pow(kRadius, 3);
  std::array<double, 3> errors{};
  for (std::size_t l = 0; l < 3; ++l) {
    const int n = 16 << l;
    const ScalarGrid grid = sampled(n, [](const Eigen::Vector3d& x) {
      return (x - Eigen::Vector3d(0.51, 0.48, 0.503)).norm() - kRadius;
    });
    const TriMesh mesh = isosurface(grid, Eigen::Vector3d::Zero(), 1.0 / n);
    EXPECT_TRUE(is_closed_manifold(mesh));
    EXPECT_EQ(mesh.vertex_count() - mesh.triangle_count() / 2, 2);  // Euler, genus 0
    errors[l] = std::abs(signed_volume(mesh.V, mesh.F) - exact);
  }
  EXPECT_NEAR(0.5 * std::log2(errors[0] / errors[2]), 2, 0.2);
}

TEST(SurfaceIsosurface, IsTheSameForAnyNumberOfThreads) {
  const ScalarGrid grid = sampled(40, [](const Eigen::Vector3d& x) {
    return std::sin(11 * x.x()) * std::sin(13 * x.y()) + std::cos(9 * x.z());
  });
  std::array<TriMesh, 2> meshes;
  for (const int threads : {1, 2})
    with_threads(threads, [&] { meshes[threads - 1] = isosurface(grid, {0, 0, 0}, 0.1); });
  EXPECT_EQ(meshes[0].V, meshes[1].V);
  EXPECT_EQ(meshes[0].F, meshes[1].F);
}

}  // namespace
}  // namespace geoprior::fluid
