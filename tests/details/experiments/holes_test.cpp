#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "experiments/details/drawing/cut_holes.h"
#include "tests/core/geometry/shapes.h"
#include "tests/details/detail_scenes.h"
#include "tests/details/experiments/drawing_checks.h"

namespace geoprior::details {
namespace {

using namespace drawing_checks;

std::vector<DrawnAnchor> anchors_at(const std::vector<Detail>& details, double weight = 1) {
  std::vector<DrawnAnchor> anchors(details.size());
  for (std::size_t i = 0; i < details.size(); ++i) {
    anchors[i].at = details[i].at;
    anchors[i].weight = weight;
  }
  return anchors;
}

CutSurface cut(const TriMesh& mesh, const std::vector<DrawnAnchor>& anchors, double radius) {
  return cut_holes(SurfaceTopology(mesh), points_of(mesh), anchors, radius);
}

int holes_of(const CutSurface& surface) {
  return static_cast<int>(
      std::count_if(surface.radius.begin(), surface.radius.end(), [](double r) { return r > 0; }));
}

/// What must hold whatever is cut: a manifold, one border more a hole, Euler characteristic one
/// less.
void expect_holes(const TriMesh& before, const CutSurface& after) {
  const TriMesh& mesh = after.drawn.mesh;
  const int holes = holes_of(after);
  EXPECT_TRUE(manifold(mesh));
  EXPECT_EQ(euler(mesh), euler(before) - holes);
  EXPECT_EQ(border_loops(mesh), border_loops(before) + holes);
}

double area(const TriMesh& mesh) { return triangle_areas(mesh.V, mesh.F).sum(); }

/// Details on a jittered lattice in the middle of the unit square, at least 0.1 apart.
std::vector<DrawnAnchor> lattice(const TriMesh& square, double weight) {
  const SurfaceTopology topology(square);
  const auto x = points_of(square);
  RandomStream random(1, "lattice");
  std::vector<DrawnAnchor> anchors;
  for (int i = 1; i <= 6; ++i) {
    for (int j = 1; j <= 6; ++j) {
      const Eigen::Vector3d p(0.14 * i + 0.03 * random.uniform(),
                              0.14 * j + 0.03 * random.uniform(), 0);
      DrawnAnchor anchor;
      anchor.at = walk_to_nearest({0, {0.4, 0.3, 0.3}}, p, topology, x);
      anchor.weight = weight;
      anchors.push_back(anchor);
    }
  }
  return anchors;
}

/// The border is a polygon of about n corners on the circle; it has sin(2 pi / n) / (2 pi / n) of
/// the area of the disc: 0.994 for n = 32.
TEST(Holes, TakeTheAreaOfDiscsFromAPlane) {
  for (const int cells : {2, 7, 40, 160}) {
    const TriMesh square = shapes::square(cells);
    for (const double weight : {1.0, 0.5, 0.1}) {
      const CutSurface after = cut(square, lattice(square, weight), 0.04);
      expect_holes(square, after);
      ASSERT_EQ(holes_of(after), 36);
      const double expected = 36 * std::numbers::pi * std::pow(0.04 * weight, 2);
      EXPECT_NEAR((1 - area(after.drawn.mesh)) / expected, 1, 0.015)
          << cells << " cells, weight " << weight;
    }
  }
}

/// Area of a cap: 2 pi (1 - cos(r)) on the unit sphere, whose polyhedron here has 0.9995 of its
/// area.
TEST(Holes, TakeTheAreaOfCapsFromASphere) {
  const TriMesh sphere = shapes::sphere(6);
  std::vector<DrawnAnchor> anchors(6);
  const SurfaceTopology topology(sphere);
  const auto x = points_of(sphere);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d axis = (i % 2 == 0 ? 1 : -1) * turn.col(i / 2);
    Eigen::Index nearest = 0;
    (sphere.V * axis).maxCoeff(&nearest);
    const int face = topology.corners_of(static_cast<int>(nearest))[0] / 3;
    anchors[i].at = walk_to_nearest({face, {0.4, 0.3, 0.3}}, axis, topology, x);
  }
  for (const double r : {0.1, 0.3, 0.6}) {
    const CutSurface after = cut(sphere, anchors, r);
    expect_holes(sphere, after);
    ASSERT_EQ(holes_of(after), 6);
    const double expected = 6 * 2 * std::numbers::pi * (1 - std::cos(r));
    EXPECT_NEAR((area(sphere) - area(after.drawn.mesh)) / expected, 1, 0.02) << r;
  }
}

TEST(Holes, BorderLiesAtTheRadius) {
  const TriMesh square = shapes::square(13);
  const auto anchors = lattice(square, 1);
  const CutSurface after = cut(square, anchors, 0.04);
  int border = 0;
  for (std::size_t v = 0; v < after.drawn.detail.size(); ++v) {
    const int i = after.drawn.detail[v];
    if (i < 0) continue;
    ++border;
    const Eigen::Vector3d p = after.drawn.mesh.V.row(v);
    const Eigen::Vector3d centre = position_of(anchors[i].at, square.V, square.F);
    // A border vertex keeps 1/1000 of its edge from a vertex; edges there are below the radius.
    EXPECT_NEAR((p - centre).norm(), 0.04, 1e-3 * 0.04);
  }
  EXPECT_GT(border, 36 * 20);
  EXPECT_LT(border, 36 * 48);
}

/// Poisson points: many are closer than two radii. The surface stays a manifold, holes do not
/// touch.
TEST(Holes, ShrinkWhereTheyAreClose) {
  for (const int levels : {2, 4, 6}) {
    const TriMesh sphere = shapes::sphere(levels);
    for (const std::uint64_t seed : {1, 2}) {
      auto anchors = anchors_at(detail_scenes::random_details(sphere, 400, seed));
      RandomStream random(seed, "weights");
      for (DrawnAnchor& a : anchors) a.weight = random.uniform();
      const CutSurface after = cut(sphere, anchors, 0.12);
      expect_holes(sphere, after);
      EXPECT_GT(holes_of(after), 200);
      for (std::size_t i = 0; i < anchors.size(); ++i) {
        EXPECT_LE(after.radius[i], 0.12 * anchors[i].weight);
        for (std::size_t j = 0; j < i; ++j) {
          if (after.radius[i] == 0 || after.radius[j] == 0) continue;
          const double d = (position_of(anchors[i].at, sphere.V, sphere.F) -
                            position_of(anchors[j].at, sphere.V, sphere.F))
                               .norm();
          EXPECT_LE(after.radius[i] + after.radius[j], 0.85 * d + 1e-12);
        }
      }
    }
  }
}

/// A hole that begins to open inside the range of another changes the other's radius by less than
/// its own squared share: no jump.
TEST(Holes, ANewbornDoesNotMakeItsNeighbourJump) {
  const TriMesh square = shapes::square(10);
  std::vector<DrawnAnchor> anchors(2);
  const SurfaceTopology topology(square);
  const auto x = points_of(square);
  anchors[0].at = walk_to_nearest({0, {0.4, 0.3, 0.3}}, {0.5, 0.5, 0}, topology, x);
  anchors[1].at = walk_to_nearest({0, {0.4, 0.3, 0.3}}, {0.62, 0.5, 0}, topology, x);
  double before = 0.15;
  for (int i = 0; i <= 100; ++i) {
    anchors[1].weight = i / 100.0;
    const double now = cut(square, anchors, 0.15).radius[0];
    EXPECT_LE(std::abs(now - before), 0.02 * 0.15) << i;
    before = now;
  }
  EXPECT_NEAR(before, 0.5 * 0.85 * 0.12, 1e-9);  // equals share the room
}

TEST(Holes, StayInsideAnOpenSurface) {
  const TriMesh square = shapes::square(9);
  const CutSurface after =
      cut(square, anchors_at(detail_scenes::random_details(square, 300, 5)), 0.05);
  expect_holes(square, after);
  EXPECT_GT(holes_of(after), 100);
}

/// A tube of circumference 0.63 cannot take a hole of radius 0.5: it is shrunk, and stays a tube.
TEST(Holes, DoNotCutAThinPartInTwo) {
  TriMesh tube = shapes::square(40);
  for (Eigen::Index v = 0; v < tube.V.rows(); ++v) {
    const double angle = 2 * std::numbers::pi * tube.V(v, 1);
    tube.V.row(v) << 2 * tube.V(v, 0), 0.1 * std::cos(angle), 0.1 * std::sin(angle);
  }
  // Rows 0 and 40 of vertices are the same line.
  for (Eigen::Index t = 0; t < tube.F.size(); ++t)
    if (tube.F.data()[t] >= 41 * 40) tube.F.data()[t] -= 41 * 40;
  tube.V.conservativeResize(41 * 40, 3);
  ASSERT_EQ(euler(tube), 0);
  std::vector<DrawnAnchor> anchors(1);
  const SurfaceTopology topology(tube);
  anchors[0].at =
      walk_to_nearest({40 * 40, {0.4, 0.3, 0.3}}, {1, 0.07, 0.07}, topology, points_of(tube));
  const CutSurface after = cut(tube, anchors, 0.5);
  expect_holes(tube, after);
  EXPECT_EQ(holes_of(after), 1);
  EXPECT_LT(after.radius[0], std::numbers::pi * 0.1);
  EXPECT_GT(after.radius[0], 0.6 * std::numbers::pi * 0.1);
}

/// A disc of thickness 0.04 with a sharp rim: near in space, the two sides are far apart along the
/// surface, but for the rim, over which holes would meet. Radii up to 4 thicknesses.
TEST(Holes, StayApartOverASharpRim) {
  TriMesh disc = shapes::sphere(4);
  disc.V.col(2) *= 0.02;
  auto anchors = anchors_at(detail_scenes::random_details(disc, 300, 4));
  const CutSurface after = cut(disc, anchors, 0.16);
  expect_holes(disc, after);
  EXPECT_GT(holes_of(after), 80);
}

TEST(Holes, AreNotCutForTinyWeights) {
  const TriMesh square = shapes::square(5);
  const CutSurface after = cut(square, lattice(square, 0.03), 0.04);
  EXPECT_EQ(holes_of(after), 0);
  EXPECT_EQ(after.drawn.mesh.F, square.F);
  EXPECT_EQ(after.drawn.mesh.V, square.V);
}

/// Right-angled isosceles triangles stay such under bisection; cuts and collapses may make thinner
/// ones, but no needles.
TEST(Holes, LeaveNoNeedles) {
  for (const int cells : {2, 7, 40, 160}) {
    const TriMesh square = shapes::square(cells);
    const CutSurface after = cut(square, lattice(square, 1), 0.04);
    EXPECT_GT(shapes::smallest_angle(after.drawn.mesh), 5) << cells;
  }
}

TEST(Holes, AreTheSameForAnyThreadCount) {
  const TriMesh sphere = shapes::sphere(5);
  const auto anchors = anchors_at(detail_scenes::random_details(sphere, 500, 9));
  CutSurface one, two;
  with_threads(1, [&] { one = cut(sphere, anchors, 0.1); });
  with_threads(2, [&] { two = cut(sphere, anchors, 0.1); });
  EXPECT_EQ(one.drawn.mesh.V, two.drawn.mesh.V);
  EXPECT_EQ(one.drawn.mesh.F, two.drawn.mesh.F);
  EXPECT_EQ(one.radius, two.radius);
}

}  // namespace
}  // namespace geoprior::details
