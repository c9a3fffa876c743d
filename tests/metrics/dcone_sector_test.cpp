#include "metrics/dcone_sector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace geoprior {
namespace {

/// The inextensible d-cone at small deflection: slope c1 cos t + c2 cos a t for |t| < t1 and 1
/// beyond, with slope and first derivative continuous; 2 t1 = 138.99 degrees, a = 3.805
/// (Cerda and Mahadevan 2005).
double inextensible(double t) {
  const double t1 = 138.99 / 2 * std::numbers::pi / 180, a = 3.805;
  t = std::abs(std::remainder(t, 2 * std::numbers::pi));
  if (t >= t1) return 1;
  const double det = -a * std::cos(t1) * std::sin(a * t1) + std::cos(a * t1) * std::sin(t1);
  const double c1 = -a * std::sin(a * t1) / det, c2 = std::sin(t1) / det;
  return c1 * std::cos(t) + c2 * std::cos(a * t);
}

Eigen::VectorXd sampled(int samples, double turn) {
  Eigen::VectorXd profile(samples);
  for (int i = 0; i < samples; ++i)
    profile[i] = 0.1 * inextensible(2 * std::numbers::pi * (i + 0.5) / samples - turn);
  return profile;
}

TEST(DconeSector, IsThatOfTheInextensibleCone) {
  EXPECT_NEAR(inextensible(0), 3.825, 0.005);
  for (const double turn : {0.0, 1.234, -2.5})
    EXPECT_NEAR(dcone_sector(sampled(360, turn)), 138.99, 3) << turn;
  EXPECT_NEAR(dcone_sector(sampled(120, 0.3)), dcone_sector(sampled(720, 0.3)), 1.5);
}

TEST(DconeSector, HardlySeesNoiseOfTheContact) {
  Eigen::VectorXd profile = sampled(360, 0);
  for (Eigen::Index i = 0; i < profile.size(); ++i)
    profile[i] += 5e-4 * std::sin(7.0 * static_cast<double>(i));
  EXPECT_NEAR(dcone_sector(profile), dcone_sector(sampled(360, 0)), 3);
}

TEST(DconeSector, RefusesASheetWithoutBuckle) {
  EXPECT_THROW(dcone_sector(Eigen::VectorXd::Constant(360, 0.1)), Error);
}

TEST(SlopeProfile, IsConstantOnACone) {
  Eigen::MatrixX2d pattern(7, 2);
  Eigen::MatrixX3d V(7, 3);
  Eigen::MatrixX3i F(6, 3);
  pattern.row(0).setZero();
  V.row(0) << 1, 2, -0.3;
  for (int i = 0; i < 6; ++i) {
    const double t = i * std::numbers::pi / 3;
    pattern.row(i + 1) << std::cos(t), std::sin(t);
    V.row(i + 1) << 1 + std::cos(t), 2 + std::sin(t), -0.3 + 0.2;
    F.row(i) << 0, i + 1, (i + 1) % 6 + 1;
  }
  // On the flat facets the slope rises towards the middle of their edges, by 1 / cos 30.
  const Eigen::VectorXd profile = slope_profile(V, pattern, F, 0, 0.5, 6);
  EXPECT_LT((profile.array() - 0.2 / std::cos(std::numbers::pi / 6)).abs().maxCoeff(), 1e-14);
  EXPECT_THROW(slope_profile(V, pattern, F, 0, 0.99, 6), Error);
}

}  // namespace
}  // namespace geoprior
