#include "metrics/developability/folds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using sheets::Sheet;

constexpr PlateStiffness kPlate{5e5, 4e-4, 0.3};

/// Rows of equilateral triangles, 40 by 40.
Sheet equilateral() {
  Sheet s = sheets::rectangle(0.2, 0.2, 40, 40);
  // Shear of the grid with parallel diagonals: every second square has its diagonal turned.
  const int n = 40;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      s.pattern.row(i * (n + 1) + j) << 0.005 * (i + 0.5 * j), 0.005 * j * std::sqrt(3) / 2;
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1, t = 2 * (i * n + j);
      s.triangles.row(t) << a, b, a + 1;
      s.triangles.row(t + 1) << b, b + 1, a + 1;
    }
  }
  return sheets::mapped(s, sheets::flat);
}

/// Strips `width` wide over `count` rulings along v, each divided by one diagonal; heights of the
/// rulings' ends in space come from `map`.
Sheet strips(int count, double width, double height) {
  return sheets::rectangle(count * width, height, count, 1);
}

double share(const Sheet& s, double radius) {
  const CurvatureFit fit = fit_curvature(s.pattern, s.triangles);
  return cancelling_share(sheet_folds(fit, s.pattern, s.x), radius);
}

double energy(const Sheet& s) {
  const CurvatureFit fit = fit_curvature(s.pattern, s.triangles);
  const Eigen::MatrixX3d none = Eigen::MatrixX3d::Zero(s.triangles.rows(), 3);
  return fold_energy(fit, s.pattern, s.x, none, kPlate);
}

double area(const Sheet& s) {
  const CurvatureFit fit = fit_curvature(s.pattern, s.triangles);
  double sum = 0;
  for (const double a : fit.area) sum += a;
  return sum;
}

TEST(Folds, OfACylinderOnAnyMeshBendOneWayAndCostWhatThePlateDoes) {
  const double radius = 0.1;
  for (const double turn : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.57}) {
    const auto rolled = [&](Sheet s) {
      const Eigen::Rotation2Dd back(turn);
      return sheets::mapped(std::move(s),
                            [&](const Vector2d& p) { return sheets::cylinder(radius)(back * p); });
    };
    for (const Sheet& s :
         {rolled(sheets::rectangle(0.2, 0.2, 40, 40)),
          rolled(sheets::rectangle(0.2, 0.2, 40, 40, 0.2)), rolled(equilateral())}) {
      const double expected = area(s) * kPlate.bending / (2 * radius * radius);
      EXPECT_LT(share(s, 0.02), 0.03) << turn;
      EXPECT_NEAR(energy(s) / expected, 1, 0.1) << turn;
    }
  }
}

TEST(Folds, OfAConeBendOneWay) {
  const Sheet s = sheets::mapped(sheets::rectangle(0.1, 0.1, 30, 30, 0.2), [](const Vector2d& p) {
    // A cone with its apex at (0, -0.1): angles about it shrink by the sine of its slope.
    const Vector2d r = p + Vector2d(0, 0.1);
    const double t = std::atan2(r.x(), r.y()) / 0.6, rho = r.norm();
    return Vector3d(0.6 * rho * std::sin(t), 0.6 * rho * std::cos(t), 0.8 * rho);
  });
  EXPECT_LT(share(s, 0.015), 0.03);
}

/// Pleated: rulings of strips fold up and down in turn.
TEST(Folds, OfAPleatedStripCancelAndCostOneByOne) {
  const double w = 0.01, theta = 0.3;
  const Sheet s = sheets::mapped(strips(20, w, 0.1), [&](const Vector2d& p) {
    const int k = static_cast<int>(std::lround(p.x() / w));
    return Vector3d(k * w * std::cos(theta / 2), p.y(), k % 2 == 0 ? 0 : w * std::sin(theta / 2));
  });
  EXPECT_GT(share(s, 0.03), 0.9);  // at the ends of the strip folds are alone
  // 19 folds by theta, each over a width of w.
  const double expected = 19 * kPlate.bending / 2 * 0.1 * theta * theta / w;
  EXPECT_NEAR(energy(s) / expected, 1, 0.05);
}

TEST(Folds, OfAFlatSheetAreNone) {
  const Sheet s = sheets::rectangle(0.2, 0.1, 8, 4);
  EXPECT_EQ(share(s, 0.03), 0);
  EXPECT_EQ(energy(s), 0);
  const CurvatureFit fit = fit_curvature(s.pattern, s.triangles);
  EXPECT_THROW((void)cancelling_share(sheet_folds(fit, s.pattern, s.x), 0), Error);
  EXPECT_THROW((void)cancelling_share(sheet_folds(fit, s.pattern, s.x), 1e-9), Error);
}

}  // namespace
}  // namespace geoprior
