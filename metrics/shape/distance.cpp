#include "metrics/shape/distance.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {

VertexDistance vertex_distance(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b,
                               const std::vector<int>& vertices) {
  if (a.rows() != b.rows() || a.rows() == 0) {
    throw Error(std::to_string(a.rows()) + " and " + std::to_string(b.rows()) + " vertices",
                "vertex distance", "equal numbers, at least one");
  }
  const Eigen::Index n = vertices.empty() ? a.rows() : std::ssize(vertices);
  double sum = 0;
  double largest = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index v = vertices.empty() ? k : vertices[k];
    const double distance2 = (a.row(v) - b.row(v)).squaredNorm();
    sum += distance2;
    largest = std::max(largest, distance2);
  }
  return {std::sqrt(sum / static_cast<double>(n)), std::sqrt(largest)};
}

}  // namespace geoprior
