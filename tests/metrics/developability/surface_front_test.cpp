#include "metrics/developability/surface_front.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "tests/metrics/sampled_surfaces.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

using sampled::on_cells;

double along(SurfaceFront& front, const UnfoldedSurface& surface, const SurfacePoint& place) {
  return front.within(place.face).distance(surface.layout(place));
}

/// Largest |distance / expected - 1| over pairs of places not farther than the reach.
template <class Expected>
double worst(const TriMesh& mesh, double reach, const Expected& expected) {
  const UnfoldedSurface surface(mesh);
  const auto places = sampled::uniform(mesh, 60, 3);
  SurfaceFront front(surface);
  double largest = 0;
  int pairs = 0;
  for (const SurfacePoint& a : places) {
    front.spread(a, reach);
    for (const SurfacePoint& b : places) {
      const double d = expected(surface.position(a), surface.position(b));
      if (d > reach || d == 0) continue;
      largest = std::max(largest, std::abs(along(front, surface, b) / d - 1));
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 100);
  return largest;
}

double chord(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).norm(); }

// A plane unfolds into itself, whatever its triangles.
TEST(SurfaceFront, IsExactInThePlane) {
  EXPECT_LT(worst(sampled::sheet(1, 1, 20, 20, 0.3), 3, chord), 1e-7);
  EXPECT_LT(worst(sampled::sheet(1, 1, 20, 20, 0.3), 0.3, chord), 1e-7);
  EXPECT_LT(worst(sampled::sheet(4, 1, 8, 16, 0.2), 1.2, chord), 1e-7);
  EXPECT_LT(worst(sampled::sheet(1, 1, 1, 1, 0), 0.4, chord), 1e-7);
}

// A prism unrolls into a strip: the shorter of two straight ways around it. A reach of less than
// half the circumference stays clear of where both meet.
TEST(SurfaceFront, IsExactAroundAPrism) {
  const double around = 2, height = 3;
  const int n = 12, m = 9;
  const UnfoldedSurface surface(sampled::prism(around, height, n, m));
  SurfaceFront front(surface);
  RandomStream random(5, "prism");
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector2d a(around * random.uniform(), height * random.uniform());
    const Eigen::Vector2d b(around * random.uniform(), height * random.uniform());
    const double dx = std::abs(a.x() - b.x());
    const double d = std::hypot(std::min(dx, around - dx), a.y() - b.y());
    if (d > 0.8) continue;
    front.spread(on_cells(a.x(), a.y(), around / n, height / m, n, m), 0.8);
    const SurfacePoint there = on_cells(b.x(), b.y(), around / n, height / m, n, m);
    EXPECT_NEAR(along(front, surface, there), d, 1e-7);
  }
}

// Distances on the unit sphere are angles. Polyhedron and front both err by the square of the edge
// length: four times less for each level.
TEST(SurfaceFront, ConvergesToAnglesOnTheSphere) {
  const auto angle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  const double coarse = worst(shapes::sphere(1, {0, 0, 0}, 3), 1.5, angle);
  const double fine = worst(shapes::sphere(1, {0, 0, 0}, 4), 1.5, angle);
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(fine, 0.5 * coarse);
}

// Triangles as large as the surface: from the middle of one face of a cube to that of the next is
// half an edge on either side.
TEST(SurfaceFront, UnfoldsTheFacesOfACube) {
  const UnfoldedSurface surface(shapes::box({0, 0, 0}, {2, 2, 2}));
  SurfaceFront front(surface);
  const SurfacePoint bottom{0, {0, 0.5, 0.5}}, side{4, {0, 0.5, 0.5}};
  ASSERT_TRUE(surface.position(bottom).isApprox(Eigen::Vector3d(1, 1, 0)));
  ASSERT_TRUE(surface.position(side).isApprox(Eigen::Vector3d(1, 0, 1)));
  front.spread(bottom, 5);
  EXPECT_NEAR(along(front, surface, side), 2, 1e-9);
}

// A triangle without height between two others: vertex 4 lies on the edge (0, 1).
TEST(SurfaceFront, CrossesATriangleWithoutArea) {
  TriMesh mesh;
  mesh.V.resize(5, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.5, -1, 0, 0.5, 0, 0;
  mesh.F.resize(4, 3);
  mesh.F << 0, 4, 2, 4, 1, 2, 0, 1, 4, 0, 3, 1;
  const UnfoldedSurface surface(mesh);
  SurfaceFront front(surface);
  for (const SurfacePoint& a : sampled::uniform(mesh, 20, 1)) {
    front.spread(a, 4);
    for (const SurfacePoint& b : sampled::uniform(mesh, 20, 2)) {
      const double d = (surface.position(a) - surface.position(b)).norm();
      EXPECT_NEAR(along(front, surface, b), d, 1e-7);
    }
  }
}

// Around the inner corner of an L the shortest way is two straight legs. Behind the corner the
// front is long (the header says why; measured: 1.4 %), never short; before it, exact.
TEST(SurfaceFront, GoesAroundACorner) {
  TriMesh mesh = sampled::sheet(2, 2, 40, 40, 0);
  Eigen::MatrixX3i kept(mesh.F.rows(), 3);
  int count = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
    for (const int v : mesh.F.row(t)) middle += mesh.V.row(v) / 3;
    if (middle.x() < 1 || middle.y() < 1) kept.row(count++) = mesh.F.row(t);
  }
  mesh.F = kept.topRows(count);
  const UnfoldedSurface surface(mesh);
  SurfaceFront front(surface);
  const auto place = [&](double x, double y) {
    SurfacePoint p = on_cells(x, y, 0.05, 0.05, 40, 40);
    for (p.face = 0; p.face < count; ++p.face) {
      if ((surface.position(p) - Eigen::Vector3d(x, y, 0)).norm() < 1e-9) return p;
    }
    throw Error("no such place", "test");
  };
  front.spread(place(1.81, 0.52), 3);
  const double legs = std::hypot(0.81, 0.48) + std::hypot(0.48, 0.83);
  EXPECT_GT(along(front, surface, place(0.52, 1.83)), legs);
  EXPECT_LT(along(front, surface, place(0.52, 1.83)), 1.03 * legs);
  EXPECT_NEAR(along(front, surface, place(0.21, 0.33)), std::hypot(1.6, 0.19), 1e-7);
}

// What an earlier source left behind does not matter, and what is out of reach is far.
TEST(SurfaceFront, CanBeUsedAgain) {
  const UnfoldedSurface surface(sampled::sheet(1, 1, 30, 30, 0.2));
  const auto places = sampled::uniform(surface.mesh(), 20, 11);
  SurfaceFront used(surface);
  for (const SurfacePoint& a : places) {
    used.spread(a, 0.2);
    SurfaceFront fresh(surface);
    fresh.spread(a, 0.2);
    ASSERT_EQ(used.faces().size(), fresh.faces().size());
    EXPECT_LT(used.faces().size(), static_cast<std::size_t>(surface.mesh().triangle_count() / 2));
    for (const SurfacePoint& b : places) {
      EXPECT_EQ(along(used, surface, b), along(fresh, surface, b));
    }
  }
  used.spread({0, {1, 0, 0}}, 0.1);
  EXPECT_EQ(along(used, surface, {1799, {0, 0.5, 0.5}}), std::numeric_limits<double>::infinity());
}

TEST(SurfaceFront, NamesWhatIsWrong) {
  TriMesh mesh = sampled::sheet(1, 1, 2, 2, 0);
  const UnfoldedSurface surface(mesh);
  SurfaceFront front(surface);
  EXPECT_THROW(front.spread({8, {1, 0, 0}}, 1), Error);
  EXPECT_THROW(front.spread({0, {1, 1, 0}}, 1), Error);
  EXPECT_THROW(front.spread({0, {1, 0, 0}}, 0), Error);
  mesh.F(3, 1) = 9;
  EXPECT_THROW(UnfoldedSurface{mesh}, Error);
  mesh = sampled::sheet(1, 1, 2, 2, 0);
  mesh.V(0, 0) = std::nan("");
  EXPECT_THROW(UnfoldedSurface{mesh}, Error);
}

}  // namespace
}  // namespace geoprior
