#include "metrics/developability/line_turning.h"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace geoprior {
namespace {

/// @param normals  of the points; none: in space
LineTurning turning_of(const Eigen::MatrixX3d& points, const Eigen::MatrixX3d* normals,
                       bool closed) {
  LineTurning result;
  const Eigen::Index n = points.rows();
  if (n < 2) return result;
  std::vector<Eigen::Vector3d> segments;
  std::vector<Eigen::Index> starts;
  for (Eigen::Index i = 0; i < (closed ? n : n - 1); ++i) {
    const Eigen::Vector3d along = (points.row((i + 1) % n) - points.row(i)).transpose();
    if (!(along.norm() > 0)) continue;
    segments.push_back(along);
    starts.push_back(i);
    result.length += along.norm();
  }
  const std::size_t count = segments.size();
  for (std::size_t i = closed ? 0 : 1; i < count; ++i) {
    Eigen::Vector3d a = segments[(i + count - 1) % count], b = segments[i];
    if (normals) {
      const Eigen::Vector3d normal = normals->row(starts[i]).transpose();
      a -= a.dot(normal) * normal;
      b -= b.dot(normal) * normal;
    }
    result.turning += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return result;
}

}  // namespace

LineTurning line_turning(const Eigen::MatrixX3d& points, bool closed) {
  return turning_of(points, nullptr, closed);
}

LineTurning line_turning_within(const Eigen::MatrixX3d& points, const Eigen::MatrixX3d& normals,
                                bool closed) {
  return turning_of(points, &normals, closed);
}

}  // namespace geoprior
