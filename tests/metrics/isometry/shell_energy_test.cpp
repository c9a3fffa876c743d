#include "metrics/isometry/shell_energy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using sheets::Sheet;

constexpr PlateStiffness kPlate{5e5, 4e-4, 0.3};

TEST(MembraneEnergy, OfAnAffineStretchIsTheClosedForm) {
  const Sheet s = sheets::mapped(sheets::rectangle(0.3, 0.2, 5, 4, 0.3), [](const auto& p) {
    return Eigen::Vector3d(1.01 * p(0), 0.98 * p(1), 0);
  });
  const double guu = (1.01 * 1.01 - 1) / 2;
  const double gvv = (0.98 * 0.98 - 1) / 2;
  const double expected =
      0.06 * 5e5 / 2 * (0.7 * (guu * guu + gvv * gvv) + 0.3 * (guu + gvv) * (guu + gvv));
  EXPECT_NEAR(membrane_energy(s.pattern, s.x, s.triangles, kPlate) / expected, 1, 1e-12);
}

TEST(MembraneEnergy, OfAShearCountsTheOffDiagonalTwice) {
  const Sheet s = sheets::mapped(sheets::rectangle(0.3, 0.2, 5, 4), [](const auto& p) {
    return Eigen::Vector3d(p(0) + 0.02 * p(1), p(1), 0);
  });
  const double guv = 0.01;
  const double gvv = 0.02 * 0.02 / 2;
  const double expected = 0.06 * 5e5 / 2 * (0.7 * (2 * guv * guv + gvv * gvv) + 0.3 * gvv * gvv);
  EXPECT_NEAR(membrane_energy(s.pattern, s.x, s.triangles, kPlate) / expected, 1, 1e-12);
}

TEST(MembraneEnergy, OfAFoldIsNone) {
  const Sheet s = sheets::mapped(sheets::rectangle(0.3, 0.2, 6, 4), sheets::fold(1));
  EXPECT_LT(membrane_energy(s.pattern, s.x, s.triangles, kPlate), 1e-20);
  Sheet turned = s;
  turned.triangles.col(0).swap(turned.triangles.col(1));
  EXPECT_THROW(membrane_energy(turned.pattern, turned.x, turned.triangles, kPlate), Error);
}

TEST(BendingEnergy, OfACylinderIsThatOfThePlate) {
  // A D / (2 R^2); the mesh is turned by 30 degrees against the axis. The fit is exact for a
  // constant curvature up to the inscribed polyhedron's second order in edge over radius.
  const double radius = 0.1;
  Sheet s = sheets::rectangle(0.2, 0.2, 40, 40, 0.2);
  s = sheets::mapped(sheets::turned_pattern(s, 0.5), sheets::cylinder(radius));
  const CurvatureFit fit = fit_curvature(s.pattern, s.triangles);
  const Eigen::MatrixX3d none = Eigen::MatrixX3d::Zero(s.triangles.rows(), 3);
  const double expected = 0.04 * 4e-4 / (2 * radius * radius);
  EXPECT_NEAR(bending_energy(fit, s.x, none, kPlate) / expected, 1, 0.01);
}

TEST(BendingEnergy, IsOfTheCurvatureBeyondTheRestCurvature) {
  const Sheet s = sheets::mapped(sheets::rectangle(0.2, 0.2, 20, 20), sheets::cylinder(0.1));
  const CurvatureFit fit = fit_curvature(s.pattern, s.triangles);
  Eigen::MatrixX3d rest = shape_operators(fit, s.x);
  EXPECT_LT(bending_energy(fit, s.x, rest, kPlate), 1e-25);
  rest.col(1).array() += 3;  // 1/m, off diagonal: counts twice
  EXPECT_NEAR(bending_energy(fit, s.x, rest, kPlate), 0.04 * 4e-4 / 2 * 0.7 * 2 * 9, 1e-12);
  EXPECT_THROW(bending_energy(fit, s.x, rest.topRows(3), kPlate), Error);
}

TEST(KineticEnergy, OfATurningSheetIsThatOfTheRigidBody) {
  // Rotation about the normal through the centre: m w^2 (a^2 + b^2) / 24; linear velocities are
  // integrated exactly on any mesh.
  const Sheet s = sheets::rectangle(0.3, 0.2, 3, 2, 0.2);
  Eigen::MatrixX3d v = Eigen::MatrixX3d::Zero(s.x.rows(), 3);
  v.col(0) = -5 * s.x.col(1);
  v.col(1) = 5 * s.x.col(0);
  const double mass = 0.08 * 0.06;
  EXPECT_NEAR(kinetic_energy(s.pattern, v, s.triangles, 0.08),
              mass * 25 * (0.3 * 0.3 + 0.2 * 0.2) / 24, 1e-16);
}

}  // namespace
}  // namespace geoprior
