#include "models/sketch/surface/visual_hull.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/random.h"
#include "models/sketch/drawing/align_views.h"
#include "models/sketch/surface/nets.h"
#include "tests/sketch/surface/drawn_solids.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;

double hull_uniform(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

TEST(Outline, AgreesWithAllSegmentsOneByOne) {
  RandomStream random(1, "outline");
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 97; ++i) {
    const double a = 2 * std::numbers::pi * i / 97, r = 1 + 0.4 * std::sin(5 * a);
    points.emplace_back(r * std::cos(a), r * std::sin(a));
  }
  const Outline outline(points);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d x(hull_uniform(random, -2, 2), hull_uniform(random, -2, 2));
    double least = std::numeric_limits<double>::infinity();
    int crossings = 0;
    for (std::size_t s = 0; s < points.size(); ++s) {
      const Eigen::Vector2d a = points[s], b = points[(s + 1) % points.size()];
      const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      least = std::min(least, (x - a - t * (b - a)).norm());
      if ((a.y() > x.y()) != (b.y() > x.y()) &&
          x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        ++crossings;
    }
    const Outline::Nearest nearest = outline.nearest(x);
    EXPECT_NEAR(nearest.distance, crossings % 2 == 1 ? -least : least, 1e-12);
    EXPECT_LT((outline.at(nearest.arc_length) - nearest.point).norm(), 1e-12);
  }
}

TEST(Outline, TurnsCounterClockwiseAndRefusesWhatHasNoArea) {
  const Outline outline({{0, 0}, {0, 1}, {2, 1}, {2, 0}});
  EXPECT_LT(outline.nearest({1, 0.5}).distance, 0);
  EXPECT_NEAR(outline.nearest({1, -3}).distance, 3, 1e-15);
  EXPECT_EQ(outline.nearest({1, -3}).normal, Eigen::Vector2d(0, -1));
  EXPECT_NEAR(outline.length(), 6, 1e-15);
  EXPECT_THROW(Outline({{0, 0}, {1, 0}}), Error);
  EXPECT_THROW(Outline({{0, 0}, {1, 0}, {2, 0}}), Error);
}

GridFunction sphere_function(int n) {
  GridFunction f;
  f.size = {n, n, n};
  f.spacing = 3.0 / (n - 1);
  f.origin = Eigen::Vector3d::Constant(-1.5);
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i)
        f.values.push_back((f.origin + f.spacing * Eigen::Vector3d(i, j, k)).norm() - 1);
    }
  }
  return f;
}

TriMesh triangles_of(const QuadMesh& quads) {
  TriMesh mesh{quads.V, Eigen::MatrixX3i(2 * quads.quads.size(), 3)};
  for (std::size_t q = 0; q < quads.quads.size(); ++q) {
    const auto& [a, b, c, d] = quads.quads[q];
    mesh.F.row(2 * q) << a, b, c;
    mesh.F.row(2 * q + 1) << a, c, d;
  }
  return mesh;
}

// Vertices are means of points that lie a chord's height inside: the volume converges as h^2.
TEST(SurfaceNets, SphereConvergesAndIsClosed) {
  double before = 0;
  for (const int n : {17, 33, 65}) {
    const TriMesh mesh = triangles_of(surface_nets(sphere_function(n)));
    EXPECT_TRUE(boundary_edges(mesh.F).empty());
    EXPECT_TRUE(non_manifold_edges(mesh.F).empty());
    EXPECT_EQ(mesh.vertex_count() - mesh.triangle_count() / 2, 2) << "genus 0";
    const double error = std::abs(signed_volume(mesh.V, mesh.F) - 4 * std::numbers::pi / 3);
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / error), 2, 0.3);
    }
    before = error;
  }
}

// Cells that share a corner or an edge only: sheets are kept apart, the surface stays closed.
TEST(SurfaceNets, RandomSolidsAreClosed) {
  RandomStream random(1, "solids");
  for (int trial = 0; trial < 20; ++trial) {
    GridFunction f;
    f.size = {8, 8, 8};
    for (int i = 0; i < 512; ++i) {
      const int x = i % 8, y = i / 8 % 8, z = i / 64;
      const bool rim = x == 0 || y == 0 || z == 0 || x == 7 || y == 7 || z == 7;
      f.values.push_back(rim || random.uniform() < 0.5 ? 1 : -1);
    }
    const TriMesh mesh = triangles_of(surface_nets(f));
    EXPECT_TRUE(boundary_edges(mesh.F).empty());
    EXPECT_GT(signed_volume(mesh.V, mesh.F), 0);
  }
}

TEST(SurfaceNets, RefusesASurfaceThatLeavesTheGrid) {
  GridFunction f = sphere_function(9);
  for (double& value : f.values) value -= 1;
  EXPECT_THROW(surface_nets(f), Error);
}

// Vertices of cells that the box's edges and corners pass are put onto them.
TEST(VisualHull, BoxHasItsEdgesAndCorners) {
  const VisualHull hull =
      visual_hull(align_views(solids::drawn_box(0.2, 0.3, 0.1)), {.triangles = 1500});
  // A quadrilateral at a corner may be split across an edge of the box, never by more than a cell.
  EXPECT_NEAR(signed_volume(hull.mesh.V, hull.mesh.F), 0.2 * 0.3 * 0.1, 1e-4 * 0.006);
  EXPECT_EQ(hull.mesh.V.colwise().minCoeff(), Eigen::RowVector3d(-0.1, 0, -0.05));
  EXPECT_EQ(hull.mesh.V.colwise().maxCoeff(), Eigen::RowVector3d(0.1, 0.3, 0.05));
  EXPECT_NEAR(hull.mesh.triangle_count(), 1500, 300);
  EXPECT_TRUE(boundary_edges(hull.mesh.F).empty());
  EXPECT_GT(triangle_areas(hull.mesh.V, hull.mesh.F).minCoeff(), 0);
}

// Chords of a circle of radius r with edges of length h lie h^2 / 8r inside.
TEST(VisualHull, CylinderIsThatOfItsChords) {
  const VisualHull hull = visual_hull(align_views(solids::drawn_cylinder(0.2, 0.3, 720)), {});
  const double volume = std::numbers::pi * 0.01 * 0.3;
  EXPECT_LT(signed_volume(hull.mesh.V, hull.mesh.F), volume);
  EXPECT_GT(signed_volume(hull.mesh.V, hull.mesh.F),
            volume * (1 - hull.spacing * hull.spacing / 0.04));
  for (Eigen::Index v = 0; v < hull.mesh.V.rows(); ++v) {
    for (const OutlinedView& view : hull.views)
      EXPECT_LT(view.outline.nearest(view.project(hull.mesh.V.row(v).transpose())).distance, 1e-9);
  }
}

TEST(VisualHull, NamesWhatIsMissing) {
  Drawing one = solids::drawn_box(1, 1, 1);
  one.views.pop_back();
  try {
    visual_hull(align_views(one), {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("too few views"));
  }
}

TEST(AlignViews, PutsViewsIntoOneFrameAndTakesOutSmallDifferences) {
  Drawing drawing = solids::drawn_box(0.2, 0.3, 0.1);
  for (Eigen::Vector2d& p : drawing.views[1].strokes[0].points)
    p = 1.005 * p + Eigen::Vector2d(7, -3);
  const Drawing aligned = align_views(drawing);
  const std::vector<Eigen::Vector2d>& side = aligned.views[1].strokes[0].points;
  EXPECT_LT((side[0] - Eigen::Vector2d(-0.05025, 0)).norm(), 1e-12);
  EXPECT_LT((side[2] - Eigen::Vector2d(0.05025, 0.3)).norm(), 1e-12);
}

TEST(AlignViews, NamesBothViewsWhenTheirExtentsDiffer) {
  Drawing drawing = solids::drawn_box(0.2, 0.3, 0.1);
  for (Eigen::Vector2d& p : drawing.views[1].strokes[0].points) p.y() *= 1.1;
  try {
    align_views(drawing);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("view side"));
    EXPECT_THAT(error.what(),
                HasSubstr("extent along y differs from that in view front by 10.0 %"));
  }
  drawing.views[1].strokes.clear();
  EXPECT_THROW(align_views(drawing), Error);
}

}  // namespace
}  // namespace geoprior::sketch
