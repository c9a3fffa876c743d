#include "experiments/skinning/weights/bone_visibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace geoprior::skinning {
namespace {

/// Share of the segment at the vertex that is not tested: the triangles around it are there.
constexpr double kStart = 1e-3;

/// Point nearest to `d` in the wedge {x a + y b, x, y >= 0} of a triangle's corner, `n` its unit
/// normal.
Eigen::Vector3d nearest_in_wedge(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& n, const Eigen::Vector3d& d) {
  const Eigen::Vector3d in_plane = d - d.dot(n) * n;
  if (in_plane.cross(b).dot(n) >= 0 && a.cross(in_plane).dot(n) >= 0) return in_plane;
  const Eigen::Vector3d on_a = std::max(0.0, d.dot(a) / a.squaredNorm()) * a;
  const Eigen::Vector3d on_b = std::max(0.0, d.dot(b) / b.squaredNorm()) * b;
  return (on_a - d).squaredNorm() < (on_b - d).squaredNorm() ? on_a : on_b;
}

}  // namespace

Eigen::Vector3d Bone::nearest(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d axis = tail - head;
  const double t = std::clamp((p - head).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return head + t * axis;
}

std::vector<Bone> bones_of(const Skeleton& skeleton) {
  std::vector<Bone> bones;
  for (int j = 0; j < skeleton.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    if (joint.tail) bones.push_back({j, joint.head, *joint.tail});
  }
  return bones;
}

InsideVisibility::InsideVisibility(const TriMesh& mesh)
    : mesh_(mesh), corners_(mesh.F, mesh.vertex_count()), tree_(mesh) {}

/// Whether the way starts on the inner side of the triangles around the vertex: the side of the one
/// nearest to it; between triangles equally near (a common edge), of the one it is steepest to.
bool InsideVisibility::leaves_inwards(int v, const Eigen::Vector3d& way) const {
  const Eigen::Vector3d d = way.normalized();
  double nearest = std::numeric_limits<double>::infinity();
  double height = 1;
  for (const int c : corners_.of(v)) {
    const int t = c / 3, k = c % 3;
    const Eigen::Vector3d a = mesh_.V.row(mesh_.F(t, (k + 1) % 3)) - mesh_.V.row(v);
    const Eigen::Vector3d b = mesh_.V.row(mesh_.F(t, (k + 2) % 3)) - mesh_.V.row(v);
    const Eigen::Vector3d n = a.cross(b);
    if (!(n.norm() > 1e-12 * a.norm() * b.norm())) continue;
    const Eigen::Vector3d unit = n.normalized();
    const double distance = (d - nearest_in_wedge(a, b, unit, d)).norm();
    const double side = d.dot(unit);
    const bool tie = std::abs(distance - nearest) < 1e-9;
    if (tie ? std::abs(side) > std::abs(height) : distance < nearest) height = side;
    nearest = std::min(nearest, distance);
  }
  return height <= 0;
}

bool InsideVisibility::sees(int v, const Eigen::Vector3d& target) const {
  const Eigen::Vector3d from = mesh_.V.row(v);
  const Eigen::Vector3d way = target - from;
  if (way.norm() == 0) return true;
  if (!leaves_inwards(v, way)) return false;
  return !tree_.meets_segment(from + kStart * way, target);
}

}  // namespace geoprior::skinning
