#include "metrics/shape/mid_ring.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr double kRoundOff = 1e-9;  // of the radius
constexpr std::size_t kSmallestRing = 8;

/// Eigenvalues, ascending, of the second moments of the ring about a point.
Eigen::Vector3d ring_moments(const Eigen::MatrixX3d& V, const Eigen::Vector3d& centre,
                             const std::vector<int>& ring) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const int v : ring) {
    const Eigen::Vector3d r = V.row(v).transpose() - centre;
    sum += r * r.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace

std::vector<int> find_mid_ring(const JointRegion::Hinge& hinge, const Eigen::MatrixX3d& rest,
                               const std::vector<int>& vertices) {
  if ((hinge.proximal + hinge.distal).norm() > kRoundOff) return {};
  std::vector<int> ring;
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  for (const int v : vertices) {
    const Eigen::Vector3d r = rest.row(v).transpose() - hinge.head;
    if (std::abs(r.dot(hinge.distal)) > kRoundOff * hinge.radius) continue;
    ring.push_back(v);
    low = std::min(low, r.norm());
    high = std::max(high, r.norm());
  }
  if (ring.size() < kSmallestRing || high - low > kRoundOff * hinge.radius) return {};
  return ring;
}

RingRatio ring_radius_ratio(const Eigen::MatrixX3d& rest, const Eigen::Vector3d& rest_joint,
                            const Eigen::MatrixX3d& posed, const Eigen::Vector3d& posed_joint,
                            const std::vector<int>& ring) {
  if (ring.empty()) throw Error("the ring has no vertices", "ring radius", "at least one");
  const Eigen::Vector3d before = ring_moments(rest, rest_joint, ring);
  const Eigen::Vector3d after = ring_moments(posed, posed_joint, ring);
  // At rest the ring is a circle: both larger moments are n r^2 / 2.
  const double circle = 0.5 * (before(1) + before(2));
  return {std::sqrt(std::max(after(1), 0.0) / circle), std::sqrt(std::max(after(2), 0.0) / circle)};
}

}  // namespace geoprior
