#pragma once

#include <Eigen/Core>
#include <array>

#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Gradients in the pattern of the linear shape functions of a triangle's corners (1/m).
/// @param area  of the triangle in the pattern (m^2)
inline std::array<Eigen::Vector2d, 3> shape_gradients(const ShellMesh& mesh, int t, double area) {
  std::array<Eigen::Vector2d, 3> gradient;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d opposite = mesh.pattern.row(mesh.triangles(t, (k + 2) % 3)) -
                                     mesh.pattern.row(mesh.triangles(t, (k + 1) % 3));
    gradient[k] = Eigen::Vector2d(-opposite.y(), opposite.x()) / (2 * area);
  }
  return gradient;
}

}  // namespace geoprior::paper
