#include "metrics/isometry/distortion.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/error.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

std::vector<int> all_of(const TriMesh& m) {
  std::vector<int> triangles(m.triangle_count());
  std::iota(triangles.begin(), triangles.end(), 0);
  return triangles;
}

/// Sheet of n x n quads over the unit square, split at x = 0.9 when n = 10.
TriMesh sheet(int n) {
  TriMesh m;
  m.V.resize((n + 1) * (n + 1), 3);
  m.F.resize(2 * n * n, 3);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      m.V.row(i * (n + 1) + j) << static_cast<double>(i) / n, static_cast<double>(j) / n, 0;
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j;
      const int b = a + n + 1;
      m.F.row(2 * (i * n + j)) << a, b, b + 1;
      m.F.row(2 * (i * n + j) + 1) << a, b + 1, a + 1;
    }
  }
  return m;
}

TEST(Distortion, SingularValuesOfAnAffineStretch) {
  const TriMesh m = sheet(5);
  // U diag(3, 0.25) V^T in the plane, then turned in space.
  const Eigen::Matrix3d U = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d W = Eigen::AngleAxisd(-1.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 2).normalized()).toRotationMatrix();
  const Eigen::Matrix3d A = R * U * Eigen::Vector3d(3, 0.25, 1).asDiagonal() * W;
  const Eigen::MatrixX2d s = singular_values(m.V, m.V * A.transpose(), m.F, all_of(m));
  for (Eigen::Index t = 0; t < s.rows(); ++t) {
    EXPECT_NEAR(s(t, 0), 3, 1e-12);  // round-off times the condition 12
    EXPECT_NEAR(s(t, 1), 0.25, 1e-12);
  }
  const DistortionSummary d = distortion(m.V, m.V * A.transpose(), m.F, all_of(m));
  EXPECT_NEAR(d.area_ratio_p05, 0.75, 1e-12);
  EXPECT_NEAR(d.area_ratio_p95, 0.75, 1e-12);
  EXPECT_NEAR(d.symmetric_dirichlet, 9 + 0.0625 + 1.0 / 9 + 16, 1e-10);
}

TEST(Distortion, IsometriesGiveOneAndFour) {
  const TriMesh m = shapes::sphere(2, {1, 1, 1}, 3);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1, Eigen::Vector3d(1, 0, 2).normalized()).toRotationMatrix();
  const DistortionSummary d = distortion(m.V, m.V * R.transpose(), m.F, all_of(m));
  EXPECT_NEAR(d.singular_value_max, 1, 1e-7);  // a double singular value: root of round-off
  EXPECT_NEAR(d.area_ratio_p05, 1, 1e-12);
  EXPECT_NEAR(d.area_ratio_p95, 1, 1e-12);
  EXPECT_NEAR(d.symmetric_dirichlet, 4, 1e-10);
}

TEST(Distortion, QuantilesAreByRestAreaNotByCount) {
  // The right tenth of the sheet is stretched by 2 along x: 10 % of the area.
  TriMesh m = sheet(10);
  Eigen::MatrixX3d posed = m.V;
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    if (posed(v, 0) > 0.95) posed(v, 0) += 0.1;
  }
  const DistortionSummary d = distortion(m.V, posed, m.F, all_of(m));
  EXPECT_NEAR(d.area_ratio_p05, 1, 1e-12);
  EXPECT_NEAR(d.area_ratio_p95, 2, 1e-12);
  EXPECT_NEAR(d.area_ratio_max, 2, 1e-12);
  EXPECT_NEAR(d.symmetric_dirichlet, 0.9 * 4 + 0.1 * (4 + 1 + 0.25 + 1), 1e-12);
  // On the stretched half alone, listed once.
  std::vector<int> right;
  for (int t = 180; t < 200; ++t) right.push_back(t);
  EXPECT_NEAR(distortion(m.V, posed, m.F, right).area_ratio_p05, 2, 1e-12);
}

TEST(Distortion, CollapsedTriangleIsHugeButFinite) {
  const TriMesh m = sheet(1);
  Eigen::MatrixX3d posed = m.V;
  posed.col(1).setZero();
  const DistortionSummary d = distortion(m.V, posed, m.F, all_of(m));
  EXPECT_EQ(d.singular_value_min, 0);
  EXPECT_NEAR(d.symmetric_dirichlet, 1e12, 1e3);
}

TEST(Distortion, RefusesNothingToMeasure) {
  const TriMesh m = sheet(1);
  EXPECT_THROW(distortion(m.V, m.V, m.F, {}), Error);
  EXPECT_THROW(distortion(m.V, m.V.topRows(2), m.F, all_of(m)), Error);
}

}  // namespace
}  // namespace geoprior
