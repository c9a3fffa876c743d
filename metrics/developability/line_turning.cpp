#include "metrics/developability/line_turning.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace geoprior {

LineTurning line_turning(const Eigen::MatrixX3d& points, bool closed) {
  LineTurning result;
  const Eigen::Index n = points.rows();
  if (n < 2) return result;
  std::vector<Eigen::Vector3d> segments;
  for (Eigen::Index i = 0; i < (closed ? n : n - 1); ++i) {
    const Eigen::Vector3d along = (points.row((i + 1) % n) - points.row(i)).transpose();
    if (!(along.norm() > 0)) continue;
    segments.push_back(along);
    result.length += along.norm();
  }
  const std::size_t count = segments.size();
  for (std::size_t i = closed ? 0 : 1; i < count; ++i) {
    const Eigen::Vector3d &a = segments[(i + count - 1) % count], &b = segments[i];
    result.turning += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return result;
}

}  // namespace geoprior
