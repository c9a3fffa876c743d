#include "metrics/contact/penetration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/triangle_tree.h"

namespace geoprior {
namespace {

/// A closed surface that is asked how deep in it a point is.
class ClosedSurface {
 public:
  explicit ClosedSurface(const TriMesh& mesh)
      : mesh_(mesh),
        tree_(mesh),
        face_normals_(triangle_normals(mesh)),
        vertex_normals_(vertex_normals(mesh)),
        edges_(mesh.F) {}

  /// Distance from the surface of a point inside; 0 outside.
  [[nodiscard]] double depth(const Eigen::Vector3d& x) const {
    const TriangleTree::Nearest nearest = tree_.nearest(x);
    const Eigen::Vector3d away = x - position_of(nearest.point, mesh_.V, mesh_.F);
    return away.dot(pseudonormal(nearest.point)) < 0 ? nearest.distance : 0;
  }

 private:
  /// Of the triangle, edge or vertex that the point is on.
  [[nodiscard]] Eigen::Vector3d pseudonormal(const SurfacePoint& point) const {
    // A point this near an edge may be taken for one of it: the sign is the same.
    constexpr double kOnEdge = 1e-9;
    int zeros = 0, zero = -1, other = -1;
    for (int k = 0; k < 3; ++k) {
      if (point.barycentric[k] > kOnEdge) {
        other = k;
      } else {
        ++zeros;
        zero = k;
      }
    }
    if (zeros == 0) return face_normals_.row(point.face).transpose();
    if (zeros == 2) return vertex_normals_.row(mesh_.F(point.face, other)).transpose();
    return edge_normal(point.face, zero);
  }

  /// Sum of the normals of the two triangles at the edge opposite to a corner.
  [[nodiscard]] Eigen::Vector3d edge_normal(int face, int corner) const {
    const int neighbour = edges_.across(face, (corner + 1) % 3);
    Eigen::RowVector3d normal = face_normals_.row(face);
    if (neighbour >= 0) normal += face_normals_.row(neighbour);
    return normal.transpose();
  }

  const TriMesh& mesh_;
  TriangleTree tree_;
  Eigen::MatrixX3d face_normals_, vertex_normals_;
  EdgeConnectivity edges_;
};

Eigen::AlignedBox3d closed_box(const TriMesh& mesh) {
  return {mesh.V.colwise().minCoeff().transpose(), mesh.V.colwise().maxCoeff().transpose()};
}

void require_finite_places(const TriMesh& mesh) {
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v)
    if (!mesh.V.row(v).allFinite())
      throw Error("a coordinate is not finite", "vertex " + std::to_string(v));
}

/// Depth in `outer` of the deepest of the points that a surface is looked at.
double depth_of(const TriMesh& mesh, const ClosedSurface& outer, const Eigen::AlignedBox3d& box) {
  double deepest = 0;
  const auto look_at = [&](const Eigen::RowVector3d& x) {
    if (box.contains(x.transpose())) deepest = std::max(deepest, outer.depth(x.transpose()));
  };
  for (const auto& x : mesh.V.rowwise()) look_at(x);
  for (const auto& triangle : mesh.F.rowwise()) {
    const Eigen::RowVector3d a = mesh.V.row(triangle[0]), b = mesh.V.row(triangle[1]),
                             c = mesh.V.row(triangle[2]);
    look_at((a + b + c) / 3);
    if (triangle[0] < triangle[1]) look_at((a + b) / 2);
    if (triangle[1] < triangle[2]) look_at((b + c) / 2);
    if (triangle[2] < triangle[0]) look_at((c + a) / 2);
  }
  return deepest;
}

}  // namespace

double penetration(const TriMesh& a, const TriMesh& b) {
  require_finite_places(a);
  require_finite_places(b);
  if (a.F.rows() == 0 || b.F.rows() == 0) return 0;
  const Eigen::AlignedBox3d common = closed_box(a).intersection(closed_box(b));
  if (common.isEmpty()) return 0;
  return std::max(depth_of(a, ClosedSurface(b), common), depth_of(b, ClosedSurface(a), common));
}

}  // namespace geoprior
