#include "metrics/shape/smoothness.h"

#include <algorithm>
#include <cmath>
#include <numeric>
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

namespace {

/// Rows that are looked at, checked against all frames.
std::vector<int> checked_rows(const std::vector<Eigen::MatrixX3d>& positions,
                              std::span<const double> parameters, const std::vector<int>& vertices,
                              const std::string& who) {
  if (positions.size() != parameters.size()) {
    throw Error(std::to_string(parameters.size()) + " parameters", who,
                std::to_string(positions.size()) + ", one a frame");
  }
  for (std::size_t i = 1; i < positions.size(); ++i) {
    if (positions[i].rows() == positions[0].rows()) continue;
    throw Error("vertex count changes", who + ", frame " + std::to_string(i),
                "the same vertices in every frame");
  }
  if (!vertices.empty() || positions.empty()) return vertices;
  std::vector<int> all(positions[0].rows());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void require_monotone(std::span<const double> parameters) {
  for (std::size_t i = 1; i < parameters.size(); ++i) {
    const double first = parameters[1] - parameters[0];
    if ((parameters[i] - parameters[i - 1]) * first > 0) continue;
    throw Error("parameter " + std::to_string(parameters[i]) + " after " +
                    std::to_string(parameters[i - 1]),
                "smoothness of motion", "parameters that rise or fall throughout");
  }
}

}  // namespace

double second_difference_max(const std::vector<Eigen::MatrixX3d>& positions,
                             std::span<const double> parameters, const std::vector<int>& vertices) {
  const std::vector<int> rows = checked_rows(positions, parameters, vertices, "second difference");
  if (!equally_spaced(parameters)) {
    throw Error("parameters are not equally spaced", "second difference", "equal steps");
  }
  double largest2 = 0;
  for (std::size_t i = 1; i + 1 < positions.size(); ++i) {
    for (const int v : rows) {
      const auto difference =
          positions[i + 1].row(v) - 2 * positions[i].row(v) + positions[i - 1].row(v);
      largest2 = std::max(largest2, difference.squaredNorm());
    }
  }
  return std::sqrt(largest2);
}

std::optional<MotionSmoothness> motion_smoothness(const std::vector<Eigen::MatrixX3d>& positions,
                                                  std::span<const double> parameters,
                                                  const std::vector<int>& vertices) {
  const std::vector<int> rows =
      checked_rows(positions, parameters, vertices, "smoothness of motion");
  require_monotone(parameters);
  const std::size_t steps = parameters.empty() ? 0 : parameters.size() - 1;
  if (steps < 3) return std::nullopt;
  const auto step = [&](std::size_t i) { return parameters[i + 1] - parameters[i]; };
  MotionSmoothness largest;
  std::vector<Eigen::RowVector3d> velocity(steps);
  for (const int v : rows) {
    for (std::size_t i = 0; i < steps; ++i) {
      velocity[i] = (positions[i + 1].row(v) - positions[i].row(v)) / step(i);
    }
    for (std::size_t i = 0; i + 1 < steps; ++i) {
      const double between = std::abs(step(i) + step(i + 1)) / 2;
      largest.velocity_change =
          std::max(largest.velocity_change, (velocity[i + 1] - velocity[i]).norm() / between);
    }
    for (std::size_t i = 1; i + 1 < steps; ++i) {
      const Eigen::RowVector3d unexplained = velocity[i] - (velocity[i - 1] + velocity[i + 1]) / 2;
      largest.jump = std::max(largest.jump, std::abs(step(i)) * unexplained.norm());
    }
  }
  return largest;
}

}  // namespace geoprior
