#include "core/geometry/subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/geometry/procedural.h"
#include "core/geometry/simplify.h"
#include "core/geometry/topology.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior {
namespace {

/// Triangles whose centre lies at x > `least`.
std::vector<bool> right_of(const TriMesh& mesh, double least) {
  std::vector<bool> region;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const double x = (mesh.V(mesh.F(t, 0), 0) + mesh.V(mesh.F(t, 1), 0) + mesh.V(mesh.F(t, 2), 0));
    region.push_back(x / 3 > least);
  }
  return region;
}

void expect_partition_of_unity(const Subdivision& step) {
  for (int v = 0; v < step.stencil.rows(); ++v)
    EXPECT_NEAR(step.stencil.row(v).sum(), 1, 1e-15) << v;
}

TEST(LoopSubdivision, QuadruplesTrianglesAndKeepsTheTopology) {
  RiggedMesh rig = shapes::bare_rig(shapes::octahedron());
  for (int level = 1; level <= 4; ++level) {
    const Subdivision step = loop_subdivision(rig.mesh.F, rig.mesh.vertex_count());
    expect_partition_of_unity(step);
    rig = loop_subdivide(rig);
    EXPECT_EQ(rig.mesh.triangle_count(), 8 << (2 * level));
    EXPECT_EQ(shapes::euler_characteristic(rig.mesh), 2);
    EXPECT_NO_THROW(require_closed_manifold(rig.mesh, "test", ""));
    EXPECT_NO_THROW(validate(rig.weights, rig.mesh.vertex_count(), 1));
  }
}

// Valence 4: beta = 5/8 - (3/8 + cos(pi/2)/4)^2 = 31/64, the neighbours' mean is the centre: every
// old vertex goes to 1 - 31/64 of its radius. New ones: 3/8 (a + b) + 1/8 (c + d), c + d = 0.
TEST(LoopSubdivision, MovesTheOctahedronAsTheWeightsSay) {
  const TriMesh octahedron = shapes::octahedron();
  const Subdivision step = loop_subdivision(octahedron.F, 6);
  const Eigen::MatrixX3d V = step.stencil * octahedron.V;
  for (int v = 0; v < 6; ++v) EXPECT_NEAR(V.row(v).norm(), 33.0 / 64, 1e-15);
  for (int v = 6; v < V.rows(); ++v) EXPECT_NEAR(V.row(v).norm(), 0.375 * std::sqrt(2.0), 1e-15);
}

// On a regular lattice Loop's scheme reproduces linear functions: a flat grid stays itself inside.
TEST(LoopSubdivision, ReproducesThePlane) {
  const TriMesh mesh = shapes::square(6);
  const Subdivision step = loop_subdivision(mesh.F, mesh.vertex_count());
  const Eigen::MatrixX3d V = step.stencil * mesh.V;
  const std::vector<bool> border = boundary_vertices(mesh.F, mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (border[v]) continue;
    EXPECT_LE((V.row(v) - mesh.V.row(v)).norm(), 1e-15) << v;
  }
  EXPECT_EQ(boundary_edges(step.F).size(), 48U);  // 24 border edges, halved
  // Straight borders stay straight; the corner follows the spline: 3/4 c + 1/8 (a + b).
  EXPECT_LE((V.row(0) - Eigen::RowVector3d(1.0 / 48, 1.0 / 48, 0)).norm(), 1e-15);
}

TEST(LoopSubdivision, ConvergesToASmoothSurface) {
  RiggedMesh rig = shapes::bare_rig(shapes::octahedron());
  double last = 10;
  for (int level = 0; level < 4; ++level) {
    rig = loop_subdivide(rig);
    const Eigen::MatrixX3d normals = triangle_normals(rig.mesh);
    double widest = 0;
    for (Eigen::Index t = 0; t < rig.mesh.F.rows(); ++t) {
      const Eigen::RowVector3d p = rig.mesh.V.row(rig.mesh.F(t, 0));
      widest = std::max(widest, normals.row(t).cross(p.normalized()).norm());
    }
    EXPECT_LT(widest, last);
    last = widest;
  }
}

TEST(LoopSubdivision, RegionStaysConformingAndLeavesTheRestAlone) {
  const RiggedMesh rig = two_bone_cylinder({.segments = 24, .rings_per_half = 20});
  const std::vector<bool> region = right_of(rig.mesh, 0.1);
  const Subdivision step = loop_subdivision(rig.mesh.F, rig.mesh.vertex_count(), region);
  expect_partition_of_unity(step);
  const RiggedMesh refined = loop_subdivide(rig, region);
  EXPECT_NO_THROW(require_closed_manifold(refined.mesh, "test", ""));
  EXPECT_EQ(shapes::euler_characteristic(refined.mesh), 2);
  EXPECT_NO_THROW(validate(refined.weights, refined.mesh.vertex_count(), 2));
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    if (rig.mesh.V(v, 0) >= 0.05) continue;
    EXPECT_EQ((refined.mesh.V.row(v) - rig.mesh.V.row(v)).norm(), 0);
  }
  for (std::size_t t = 0; t < region.size(); ++t) {
    const auto children = std::count(step.parent.begin(), step.parent.end(), static_cast<int>(t));
    EXPECT_EQ(children == 4, region[t]) << t;  // a straight border needs no further quartering
  }
}

TEST(LoopSubdivision, TriangleWithTwoSplitEdgesIsQuarteredToo) {
  const TriMesh mesh = shapes::octahedron();
  std::vector<bool> refine(8, false);
  refine[1] = refine[3] = true;  // 2 1 4 and 3 0 4: triangles 0 and 2 lie between them
  const Subdivision step = loop_subdivision(mesh.F, 6, refine);
  EXPECT_EQ(std::count(step.parent.begin(), step.parent.end(), 0), 4);
  EXPECT_EQ(std::count(step.parent.begin(), step.parent.end(), 2), 4);
  EXPECT_TRUE(boundary_edges(step.F).empty());
  EXPECT_TRUE(non_manifold_edges(step.F).empty());
}

// Quartered triangles are similar to their parents (smoothing aside), halved ones lose half an
// angle once. So no halved triangle may be split again, and however many steps follow, the smallest
// angle stays what the first step left.
TEST(LoopSubdivision, RepeatedRefinementOfARegionMakesNoSlivers) {
  const RiggedMesh rig = shapes::bare_rig(shapes::sphere(3));
  const std::vector<bool> region = right_of(rig.mesh, 0.3);
  const RefinedRig refined = loop_subdivide_region(rig, region, 3);
  ASSERT_EQ(refined.steps.size(), 3U);
  EXPECT_NO_THROW(require_closed_manifold(refined.rig.mesh, "test", ""));

  TriMesh mesh = rig.mesh;
  std::vector<bool> halved(mesh.triangle_count(), false);
  std::vector<double> angles;
  for (const Subdivision& step : refined.steps) {
    std::vector<int> children(halved.size(), 0);
    for (const int parent : step.parent) ++children[parent];
    std::vector<bool> next;
    for (const int parent : step.parent) {
      const std::size_t p = parent;
      EXPECT_FALSE(halved[p] && children[p] > 1) << "a halved triangle is split again";
      next.push_back(halved[p] || children[p] == 2);
    }
    halved = next;
    mesh.V = Eigen::MatrixX3d(step.stencil * mesh.V);
    mesh.F = step.F;
    angles.push_back(shapes::smallest_angle(mesh));
  }
  EXPECT_GT(angles[2], 0.9 * angles[0]);
  EXPECT_LE((mesh.V - refined.rig.mesh.V).norm(), 1e-14);
  const auto marked = std::count(region.begin(), region.end(), true);
  EXPECT_GE(mesh.triangle_count(), 64 * marked);
}

TEST(LoopSubdivision, SplitMeshesFollowTheirWeldedOne) {
  // A cylinder cut open along triangles on both sides of y = 0: every vertex on the cut twice.
  const RiggedMesh rig = two_bone_cylinder({.segments = 24, .rings_per_half = 4});
  TriMesh split = rig.mesh;
  std::vector<int> welded_of_split;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) welded_of_split.push_back(v);
  std::vector<int> copy(rig.mesh.vertex_count(), -1);
  for (Eigen::Index t = 0; t < split.F.rows(); ++t) {
    double y = 0;
    for (int k = 0; k < 3; ++k) y += rig.mesh.V(rig.mesh.F(t, k), 1);
    if (y < 0) continue;
    for (int k = 0; k < 3; ++k) {
      int& c = copy[split.F(t, k)];
      if (c < 0) {
        c = static_cast<int>(welded_of_split.size());
        welded_of_split.push_back(split.F(t, k));
      }
      split.F(t, k) = c;
    }
  }
  split.V.resize(welded_of_split.size(), 3);
  for (Eigen::Index v = 0; v < split.V.rows(); ++v)
    split.V.row(v) = rig.mesh.V.row(welded_of_split[v]);

  const Subdivision step =
      loop_subdivision(rig.mesh.F, rig.mesh.vertex_count(), right_of(rig.mesh, 0.0));
  const Eigen::MatrixX3d V = step.stencil * rig.mesh.V;
  const SplitSubdivision followed = subdivide_split(split, welded_of_split, rig.mesh.F, step, V);
  ASSERT_EQ(followed.mesh.F.rows(), step.F.rows());
  for (Eigen::Index t = 0; t < step.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t v = followed.mesh.F(t, k);
      EXPECT_EQ(followed.welded_of_split[v], step.F(t, k));
    }
  }
  // The cut is still one: as many boundary edges as the seam has, on both sides.
  const std::vector<Edge> open = boundary_edges(followed.mesh.F);
  EXPECT_GT(open.size(), boundary_edges(split.F).size());
  std::multiset<std::set<int>> seam;
  for (const Edge& e : open) {
    seam.insert({followed.welded_of_split[e[0]], followed.welded_of_split[e[1]]});
  }
  for (const std::set<int>& edge : seam) EXPECT_EQ(seam.count(edge), 2U);
  split.F.row(0).reverseInPlace();
  EXPECT_THROW(subdivide_split(split, welded_of_split, rig.mesh.F, step, V), Error);
}

TEST(LoopSubdivision, RefusesWhatItCannotSubdivide) {
  TriMesh mesh = shapes::octahedron();
  EXPECT_THROW(loop_subdivision(mesh.F, 6, std::vector<bool>(3, true)), Error);
  std::swap(mesh.F(0, 0), mesh.F(0, 1));
  EXPECT_THROW(loop_subdivision(mesh.F, 6), Error);
}

TEST(Simplify, ReachesTheTargetAndStaysAClosedManifold) {
  const TriMesh sphere = shapes::sphere(5);
  for (const int target : {2000, 500, 100, 12}) {
    const TriMesh coarse = simplify(sphere, target);
    EXPECT_EQ(coarse.vertex_count(), target);
    EXPECT_NO_THROW(require_closed_manifold(coarse, "test", ""));
    EXPECT_EQ(shapes::euler_characteristic(coarse), 2);
  }
}

// The error of a triangulated sphere falls with the square of the edge length, that is as 1 / n:
// about 2 pi / (sqrt(3) n) of the radius for an even mesh (a sixth of l^2 / 8 ... twice that here).
TEST(Simplify, KeepsTheShapeOfTheSphere) {
  const TriMesh sphere = shapes::sphere(5);
  const double full = signed_volume(sphere.V, sphere.F);
  for (const int target : {1000, 250}) {
    const TriMesh coarse = simplify(sphere, target);
    const Eigen::VectorXd radius = coarse.V.rowwise().norm();
    EXPECT_NEAR(radius.minCoeff(), 1, 8.0 / target);
    EXPECT_NEAR(radius.maxCoeff(), 1, 8.0 / target);
    EXPECT_NEAR(signed_volume(coarse.V, coarse.F) / full, 1, 8.0 / target);
    EXPECT_GT(shapes::smallest_angle(coarse), 5);
  }
}

TEST(Simplify, FlatSquareKeepsItsBorder) {
  const TriMesh coarse = simplify(shapes::square(20), 30);
  EXPECT_NEAR(triangle_areas(coarse.V, coarse.F).sum(), 1, 1e-6);
  EXPECT_NEAR(bounding_box_diagonal(coarse.V), std::sqrt(2.0), 1e-6);
  EXPECT_TRUE(non_manifold_edges(coarse.F).empty());
}

TEST(Simplify, StopsWhereTheManifoldWouldEnd) {
  EXPECT_EQ(simplify(shapes::octahedron(), 4).vertex_count() >= 4, true);
  EXPECT_NO_THROW(require_closed_manifold(simplify(shapes::octahedron(), 4), "test", ""));
  EXPECT_THROW(simplify(shapes::octahedron(), 3), Error);
}

}  // namespace
}  // namespace geoprior
