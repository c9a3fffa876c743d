#include "metrics/developability/fold_angle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "metrics/developability/developability.h"

namespace geoprior {

FoldAngle fold_angle(const TriMesh& mesh, std::span<const int> triangles,
                     const Eigen::Vector3d& to_eye, double asked) {
  if (!(to_eye.squaredNorm() > 0)) throw Error("view has no direction", "fold angle", "not 0");
  if (!(asked >= 0 && asked <= std::numbers::pi))
    throw Error(std::to_string(asked) + " rad asked", "fold angle", "0 to pi");
  FoldAngle result;
  double weights = 0;
  for (const int t : triangles) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::RowVector3d u = mesh.V.row(mesh.F(t, 1)) - a;
    const Eigen::RowVector3d v = mesh.V.row(mesh.F(t, 2)) - a;
    const Eigen::Vector3d n = u.cross(v).transpose();  // twice the area long
    if (!(n.squaredNorm() > 0)) continue;
    const double angle = std::atan2(n.cross(to_eye).norm(), n.dot(to_eye));
    const double off = std::abs(angle - asked);
    result.mean += n.norm() * off;
    weights += n.norm();
    result.max = std::max(result.max, off);
  }
  if (!(weights > 0)) throw Error("no triangle with an area", "fold angle", "at least one");
  result.mean /= weights;
  return result;
}

FoldAngle fold_angles(const TriMesh& mesh, std::span<const SeenFold> sides) {
  if (sides.empty()) throw Error("no side of a fold", "fold angle", "at least one");
  FoldAngle all;
  double whole = 0;
  for (const SeenFold& side : sides) {
    const FoldAngle angle = fold_angle(mesh, side.triangles, side.to_eye, side.asked);
    const double area = panel_area(mesh, side.triangles);
    whole += area;
    all.mean += area * angle.mean;
    all.max = std::max(all.max, angle.max);
  }
  all.mean /= whole;
  return all;
}

}  // namespace geoprior
