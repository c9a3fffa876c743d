#include "solvers/skinning/field/caps.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace geoprior::skinning {
namespace {

using Series = Eigen::Matrix<double, 5, 1>;  ///< 1, cos, sin, cos 2, sin 2

constexpr int kAzimuths = 8;
constexpr std::array<double, 2> kLatitudes_deg{30, 60};
constexpr double kBand =
    0.5;  ///< of skin that counts, either side of the joint's plane, in pole radii
constexpr double kLargestGap_deg = 100;  ///< between neighbouring azimuths of that skin

Series basis(double psi) {
  Series row;
  row << 1, std::cos(psi), std::sin(psi), std::cos(2 * psi), std::sin(2 * psi);
  return row;
}

struct Ring {
  std::vector<double> azimuth;  ///< sorted
  std::vector<double> radius;
};

/// The skin near the joint's plane in polar coordinates about the axis.
Ring ring_about(const BoneEnd& end, const Eigen::Matrix<double, 3, 2>& plane,
                const std::vector<Eigen::Vector3d>& skin, double band) {
  std::vector<std::pair<double, double>> polar;
  for (const Eigen::Vector3d& p : skin) {
    const Eigen::Vector3d d = p - end.joint;
    if (std::abs(d.dot(end.outward)) > band) continue;
    const Eigen::Vector2d q = plane.transpose() * d;
    polar.emplace_back(std::atan2(q.y(), q.x()), q.norm());
  }
  std::sort(polar.begin(), polar.end());
  Ring ring;
  for (const auto& [psi, rho] : polar) {
    ring.azimuth.push_back(psi);
    ring.radius.push_back(rho);
  }
  return ring;
}

bool surrounds(const Ring& ring) {
  if (ring.azimuth.size() < 2 * kAzimuths) return false;
  double gap = ring.azimuth.front() + 2 * std::numbers::pi - ring.azimuth.back();
  for (std::size_t i = 1; i < ring.azimuth.size(); ++i) {
    gap = std::max(gap, ring.azimuth[i] - ring.azimuth[i - 1]);
  }
  return gap < kLargestGap_deg * std::numbers::pi / 180;
}

Series fit_radius(const Ring& ring) {
  const Eigen::Index n = ring.azimuth.size();
  Eigen::MatrixXd rows(n, 5);
  Eigen::VectorXd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    rows.row(i) = basis(ring.azimuth[i]).transpose();
    values(i) = ring.radius[i];
  }
  return rows.colPivHouseholderQr().solve(values);
}

}  // namespace

CapSamples point_cap(const BoneEnd& end, double distance) {
  return {{end.joint + distance * end.outward}, {end.outward}};
}

CapSamples dome_cap(const BoneEnd& end, const std::vector<Eigen::Vector3d>& skin, double pole) {
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = end.outward.unitOrthogonal();
  plane.col(1) = end.outward.cross(plane.col(0));
  const Ring ring = ring_about(end, plane, skin, kBand * pole);
  CapSamples cap = point_cap(end, pole);
  if (!surrounds(ring)) return cap;
  const Series series = fit_radius(ring);
  const auto point = [&](double psi, double latitude) -> Eigen::Vector3d {
    const double c = std::cos(latitude), s = std::sin(latitude);
    const double rho = basis(psi).dot(series) * c * c + pole * s * s;
    return end.joint +
           rho * (c * (plane * Eigen::Vector2d(std::cos(psi), std::sin(psi))) + s * end.outward);
  };
  constexpr double kStep = 1e-4;
  for (const double degrees : kLatitudes_deg) {
    const double latitude = degrees * std::numbers::pi / 180;
    for (int k = 0; k < kAzimuths; ++k) {
      const double psi = 2 * std::numbers::pi * k / kAzimuths;
      const Eigen::Vector3d along = point(psi + kStep, latitude) - point(psi - kStep, latitude);
      const Eigen::Vector3d up = point(psi, latitude + kStep) - point(psi, latitude - kStep);
      cap.points.push_back(point(psi, latitude));
      cap.normals.push_back(along.cross(up).normalized());
    }
  }
  return cap;
}

}  // namespace geoprior::skinning
