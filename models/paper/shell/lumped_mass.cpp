#include "models/paper/shell/lumped_mass.h"

#include <string>

#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::paper {

Eigen::VectorXd lumped_masses(const ShellMesh& mesh, double area_density) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Eigen::Vector3i v = mesh.triangles.row(t);
    const Eigen::Vector2d a = mesh.pattern.row(v[0]);
    const Eigen::Vector2d b = mesh.pattern.row(v[1]).transpose() - a;
    const Eigen::Vector2d c = mesh.pattern.row(v[2]).transpose() - a;
    const double area = cross(b, c) / 2;
    if (!(area > 0)) {
      throw Error("no area, or turned over, in the pattern", "triangle " + std::to_string(t),
                  "counter-clockwise triangles");
    }
    for (const int i : v) mass[i] += area_density * area / 3;
  }
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    if (!(mass[i] > 0)) throw Error("no triangle uses it", "vertex " + std::to_string(i));
  }
  return mass;
}

}  // namespace geoprior::paper
