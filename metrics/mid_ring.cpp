#include "metrics/mid_ring.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr double kRoundOff = 1e-9;  // of the radius
constexpr std::size_t kSmallestRing = 8;

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
  RingRatio ratio{std::numeric_limits<double>::infinity(), 0};
  for (const int v : ring) {
    const double before = (rest.row(v).transpose() - rest_joint).norm();
    const double after = (posed.row(v).transpose() - posed_joint).norm();
    ratio.min = std::min(ratio.min, after / before);
    ratio.max = std::max(ratio.max, after / before);
  }
  return ratio;
}

}  // namespace geoprior
