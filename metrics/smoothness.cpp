#include "metrics/smoothness.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {

bool equally_spaced(std::span<const double> parameters) {
  for (std::size_t i = 2; i < parameters.size(); ++i) {
    const double step = parameters[1] - parameters[0];
    const double other = parameters[i] - parameters[i - 1];
    if (step == 0 || !(std::abs(other - step) <= 1e-9 * std::abs(step))) return false;
  }
  return true;
}

double second_difference_max(const std::vector<Eigen::MatrixX3d>& positions,
                             std::span<const double> parameters, const std::vector<int>& vertices) {
  if (positions.size() != parameters.size()) {
    throw Error(std::to_string(parameters.size()) + " parameters", "second difference",
                std::to_string(positions.size()) + ", one a frame");
  }
  if (!equally_spaced(parameters)) {
    throw Error("parameters are not equally spaced", "second difference", "equal steps");
  }
  double largest2 = 0;
  for (std::size_t i = 1; i + 1 < positions.size(); ++i) {
    const Eigen::MatrixX3d& before = positions[i - 1];
    const Eigen::MatrixX3d& now = positions[i];
    const Eigen::MatrixX3d& after = positions[i + 1];
    if (before.rows() != now.rows() || after.rows() != now.rows()) {
      throw Error("vertex count changes", "second difference, frame " + std::to_string(i),
                  "the same vertices in every frame");
    }
    const Eigen::Index n =
        vertices.empty() ? now.rows() : static_cast<Eigen::Index>(vertices.size());
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index v = vertices.empty() ? k : vertices[k];
      largest2 = std::max(largest2, (after.row(v) - 2 * now.row(v) + before.row(v)).squaredNorm());
    }
  }
  return std::sqrt(largest2);
}

}  // namespace geoprior
