#include "metrics/dcone_sector.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr double kFlankLow = 0.03, kFlankHigh = 0.15;  ///< of the largest lift

/// Point of the sheet over a point of the pattern.
Eigen::Vector3d lift(const Eigen::MatrixX3d& V, const Eigen::MatrixX2d& pattern,
                     const Eigen::MatrixX3i& triangles, const Eigen::Vector2d& p) {
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::RowVector3i f = triangles.row(t);
    Eigen::Matrix2d edges;
    edges.col(0) = pattern.row(f[1]) - pattern.row(f[0]);
    edges.col(1) = pattern.row(f[2]) - pattern.row(f[0]);
    const Eigen::Vector2d w = edges.inverse() * (p - pattern.row(f[0]).transpose());
    if (w.minCoeff() < -1e-9 || w.sum() > 1 + 1e-9) continue;
    return ((1 - w.sum()) * V.row(f[0]) + w[0] * V.row(f[1]) + w[1] * V.row(f[2])).transpose();
  }
  throw Error("sample (" + std::to_string(p.x()) + ", " + std::to_string(p.y()) +
                  ") lies outside the pattern",
              "slope_profile", "a circle inside the sheet");
}

/// Samples from the largest lift to where its cube root, extrapolated, vanishes in this direction.
double flank(const Eigen::VectorXd& lift, Eigen::Index top, int direction) {
  const Eigen::Index n = lift.size();
  // Line through the cube roots on the flank, least squares.
  double count = 0, s = 0, ss = 0, r = 0, sr = 0;
  for (Eigen::Index i = 0; i <= n / 2; ++i) {
    const double relative = lift[((top + direction * i) % n + n) % n] / lift[top];
    if (relative < kFlankLow) break;
    if (relative > kFlankHigh) continue;
    const double position = static_cast<double>(i), root = std::cbrt(relative);
    count += 1;
    s += position;
    ss += position * position;
    r += root;
    sr += position * root;
  }
  if (count < 2)
    throw Error("too few samples on the flank of the buckle", "dcone_sector", "a finer profile");
  const double slope = (count * sr - s * r) / (count * ss - s * s);
  return s / count - r / count / slope;
}

}  // namespace

Eigen::VectorXd slope_profile(const Eigen::MatrixX3d& V, const Eigen::MatrixX2d& pattern,
                              const Eigen::MatrixX3i& triangles, int apex, double radius,
                              int samples) {
  Eigen::VectorXd profile(samples);
  for (int i = 0; i < samples; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / samples;
    const Eigen::Vector2d p =
        pattern.row(apex).transpose() + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const Eigen::Vector3d x = lift(V, pattern, triangles, p) - V.row(apex).transpose();
    profile[i] = x.z() / x.head<2>().norm();
  }
  return profile;
}

double dcone_sector(const Eigen::VectorXd& profile) {
  const Eigen::Index n = profile.size();
  Eigen::Index top = 0;
  if (n < 16) throw Error("profile of " + std::to_string(n), "dcone_sector", "at least 16 samples");
  profile.maxCoeff(&top);
  // The level of contact: median of the half opposite to the buckle.
  std::vector<double> far;
  for (Eigen::Index i = n / 4; i <= n - n / 4; ++i) far.push_back(profile[(top + i) % n]);
  const auto middle = far.begin() + static_cast<std::ptrdiff_t>(far.size() / 2);
  std::nth_element(far.begin(), middle, far.end());
  const Eigen::VectorXd lift = profile.array() - *middle;
  if (!(lift[top] > 1e-3 * std::abs(*middle)))
    throw Error("no buckle", "dcone_sector", "a slope that rises over that of contact");
  return 360.0 / static_cast<double>(n) * (flank(lift, top, 1) + flank(lift, top, -1));
}

}  // namespace geoprior
