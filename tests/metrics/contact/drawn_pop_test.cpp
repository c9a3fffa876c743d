#include "metrics/contact/drawn_pop.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

constexpr double kSpacing = 0.005;

/// A sheet of 0.4 x 0.4 m rolled to a radius, or flat.
TriMesh base(double radius = 0) {
  const sheets::Sheet s = sheets::rectangle(0.4, 0.4, 40, 40, 0.2);
  return (radius == 0 ? s : sheets::mapped(s, sheets::cylinder(radius))).mesh();
}

/// A cone of eight sides that stands at the origin of the sheet, which all rollings leave in place
/// with its normal along +z.
TriMesh spike(double height, double foot = 0.01, const Eigen::Vector3d& at = {0, 0, 0}) {
  constexpr int sides = 8;
  TriMesh m;
  m.V.resize(sides + 1, 3);
  m.F.resize(sides, 3);
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    m.V.row(k) << foot * std::cos(angle) + at.x(), foot * std::sin(angle) + at.y(), at.z();
    m.F.row(k) << k, (k + 1) % sides, sides;
  }
  m.V.row(sides) = (at + Eigen::Vector3d(0, 0, height)).transpose();
  return m;
}

TriMesh moved(TriMesh mesh, const Eigen::Isometry3d& motion) {
  for (auto x : mesh.V.rowwise()) x = (motion * x.transpose()).transpose();
  return mesh;
}

TEST(DrawnPop, OfASpikeThatAppearsIsItsHeight) {
  const TriMesh flat = base(), with = shapes::together(flat, spike(0.05));
  const DrawnPop came = drawn_pop(flat, flat, flat, with, kSpacing);
  EXPECT_NEAR(came.came, 0.05, 1e-12);
  EXPECT_EQ(came.went, 0);
  const DrawnPop went = drawn_pop(flat, with, flat, flat, kSpacing);
  EXPECT_NEAR(went.went, 0.05, 1e-12);
  EXPECT_LT(went.came, 1e-12);
}

TEST(DrawnPop, OfASpikeThatGrowsOverNFramesIsANthOfItsHeight) {
  const TriMesh flat = base();
  constexpr int n = 8;
  const double height = 0.05;
  TriMesh before = flat;
  for (int k = 1; k <= n; ++k) {
    const TriMesh now = shapes::together(flat, spike(height * k / n));
    EXPECT_NEAR(drawn_pop(flat, before, flat, now, kSpacing).largest(), height / n, 1e-12) << k;
    before = now;
  }
}

TEST(DrawnPop, IsThatOfTheDrawingAndNotOfTheMotion) {
  // The sheet turns by 40 degrees, moves by 1 m, and a spike of it appears.
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  motion.translate(Eigen::Vector3d(1, 0, 0));
  const TriMesh flat = base(), one = shapes::together(flat, spike(0.05));
  const TriMesh two = shapes::together(one, spike(0.03, 0.01, {0.1, 0.1, 0}));
  const TriMesh base_now = moved(flat, motion);
  EXPECT_LT(drawn_pop(flat, one, base_now, moved(one, motion), kSpacing).largest(), 1e-12);
  EXPECT_NEAR(drawn_pop(flat, one, base_now, moved(two, motion), kSpacing).came, 0.03, 1e-12);
}

TEST(DrawnPop, BendingTheBaseUnderASpikeIsNone) {
  // The sheet is rolled from flat to a radius of 0.2 m. The foot, 10 mm wide, is carried to the
  // cylinder, r^2 / (2 R) off the plane; the tip goes with the interpolated normal.
  const TriMesh flat = base(), rolled = base(0.2);
  const DrawnPop pop = drawn_pop(flat, shapes::together(flat, spike(0.05)), rolled,
                                 shapes::together(rolled, spike(0.05)), kSpacing);
  EXPECT_LT(pop.largest(), 0.002);
  const DrawnPop twice = drawn_pop(flat, shapes::together(flat, spike(0.05)), rolled,
                                   shapes::together(rolled, spike(0.07)), kSpacing);
  EXPECT_NEAR(twice.came, 0.02, 0.002);
}

TEST(DrawnPop, OfAHoleIsItsInnerRadius) {
  // A square hole of two squares: the middle of what was there is one square from the rim.
  const TriMesh flat = sheets::rectangle(0.4, 0.4, 40, 40).mesh();
  TriMesh holed = flat;
  std::vector<int> kept;
  for (int t = 0; t < flat.triangle_count(); ++t) {
    const Eigen::RowVector3d centre =
        (flat.V.row(flat.F(t, 0)) + flat.V.row(flat.F(t, 1)) + flat.V.row(flat.F(t, 2))) / 3;
    if (centre.cwiseAbs().maxCoeff() > 0.01) kept.push_back(t);
  }
  holed.F = flat.F(kept, Eigen::all);
  const DrawnPop cut = drawn_pop(flat, flat, flat, holed, kSpacing);
  EXPECT_NEAR(cut.went, 0.01, 1e-12);
  EXPECT_EQ(cut.came, 0);
  EXPECT_NEAR(drawn_pop(flat, holed, flat, flat, kSpacing).came, 0.01, 1e-12);
}

TEST(DrawnPop, RefusesSurfacesOfDifferentTriangles) {
  const TriMesh flat = base();
  TriMesh other = flat;
  other.F.conservativeResize(other.F.rows() - 1, 3);
  EXPECT_THROW(drawn_pop(flat, flat, other, flat, kSpacing), Error);
  EXPECT_THROW(drawn_pop(flat, flat, flat, {}, kSpacing), Error);
  EXPECT_THROW(drawn_pop(flat, flat, flat, flat, 0), Error);
}

}  // namespace
}  // namespace geoprior
