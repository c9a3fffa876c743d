#include "solvers/paper/shell/plastic_apex.h"

#include <algorithm>
#include <cmath>

namespace geoprior::paper {
namespace {

/// Frobenius norm of a shape operator given as uu, uv, vv.
double norm(const Eigen::Vector3d& s) {
  return std::sqrt(s[0] * s[0] + 2 * s[1] * s[1] + s[2] * s[2]);
}

}  // namespace

void yield_at_apexes(const PaperMaterial& material, double radius,
                     const std::vector<int>& singular_vertices, const Eigen::MatrixX3d& curvature,
                     ShellState& state, PaperStructure& structure) {
  const double h = material.thickness;
  if (radius <= h) return;
  for (std::size_t s = 0; s < singular_vertices.size(); ++s) {
    const int apex = singular_vertices[s];
    SingularPoint& point = structure.singular_points[s];
    double largest = 0;
    for (int f = 0; f < state.mesh.triangle_count(); ++f) {
      const Eigen::RowVector3i t = state.mesh.triangles.row(f);
      if (t[0] != apex && t[1] != apex && t[2] != apex) continue;
      const Eigen::RowVector2d centroid =
          (state.mesh.pattern.row(t[0]) + state.mesh.pattern.row(t[1]) +
           state.mesh.pattern.row(t[2])) /
          3;
      const double R = (centroid - state.mesh.pattern.row(apex)).norm();
      const Eigen::Vector3d elastic =
          (curvature.row(f) - state.plastic_curvature.row(f)).transpose();
      const double share = R > radius ? std::log(radius / h) / std::log(R / h) : 1;
      const double near = norm(elastic) * R / std::min(radius, R);
      if (near <= material.yield_curvature) continue;
      const double excess = 1 - material.yield_curvature / near;
      state.plastic_curvature.row(f) += (share * excess * elastic).transpose();
      largest = std::max(largest, excess);
      if (material.weakening > 0) {
        const double w = material.weakening * (point.weakening + excess);
        const double left = 1 - share * w / (1 + w);
        state.damage[f] = std::max(state.damage[f], (1 / left - 1) / material.weakening);
      }
    }
    point.weakening += largest;
  }
}

}  // namespace geoprior::paper
