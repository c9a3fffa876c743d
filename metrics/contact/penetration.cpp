#include "metrics/contact/penetration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/topology.h"
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

/// Finds the deepest of the points at which a surface is looked at.
///
/// A depth changes by no more than the way that one goes: from a point far outside, its whole
/// neighbourhood is known to be no deeper than what was found before, and is not looked at.
class DeepestPoint {
 public:
  DeepestPoint(const TriMesh& mesh, const ClosedSurface& outer, const Eigen::AlignedBox3d& box)
      : mesh_(mesh),
        outer_(outer),
        box_(box),
        round_off_(1e-12 * box.diagonal().norm()),
        bound_(mesh.V.rows(), std::numeric_limits<double>::infinity()) {}

  double depth() {
    look_at_vertices();
    for (const auto& triangle : mesh_.F.rowwise()) {
      look_between(triangle, (row(triangle[0]) + row(triangle[1]) + row(triangle[2])) / 3);
      for (int k = 0; k < 3; ++k) {
        const int a = triangle[k], b = triangle[(k + 1) % 3];
        if (a < b) look_between(triangle, (row(a) + row(b)) / 2);
      }
    }
    return deepest_;
  }

 private:
  [[nodiscard]] Eigen::RowVector3d row(int v) const { return mesh_.V.row(v); }

  /// From neighbour to neighbour, so that a vertex is bounded by those before it.
  void look_at_vertices() {
    const VertexGraph neighbours = one_rings(mesh_.F, mesh_.vertex_count());
    std::vector<bool> is_known(mesh_.V.rows(), false);
    std::vector<int> queue;
    queue.reserve(mesh_.V.rows());
    for (int seed = 0; seed < mesh_.V.rows(); ++seed) {
      if (is_known[seed]) continue;
      is_known[seed] = true;
      queue.assign(1, seed);
      for (std::size_t i = 0; i < queue.size(); ++i) {
        const int v = queue[i];
        bound_[v] = bound_at(row(v), bound_[v]);
        for (const int u : neighbours.of(v)) {
          bound_[u] = std::min(bound_[u], bound_[v] + (row(u) - row(v)).norm());
          if (!is_known[u]) queue.push_back(u);
          is_known[u] = true;
        }
      }
    }
  }

  void look_between(const Eigen::RowVector3i& corners, const Eigen::RowVector3d& x) {
    double bound = std::numeric_limits<double>::infinity();
    for (const int v : corners) bound = std::min(bound, bound_[v] + (x - row(v)).norm());
    bound_at(x, bound);
  }

  /// The depth of a point that may be the deepest; of another one a bound of it.
  double bound_at(const Eigen::RowVector3d& x, double bound) {
    if (bound < deepest_ - round_off_) return bound;
    if (!box_.contains(x.transpose())) return -box_.exteriorDistance(x.transpose());
    const double depth = outer_.depth(x.transpose());
    deepest_ = std::max(deepest_, depth);
    return depth;
  }

  const TriMesh& mesh_;
  const ClosedSurface& outer_;
  const Eigen::AlignedBox3d& box_;
  double round_off_;
  std::vector<double> bound_;  ///< of each vertex: it is no deeper
  double deepest_ = 0;
};

}  // namespace

double penetration(const TriMesh& a, const TriMesh& b) {
  require_finite_places(a);
  require_finite_places(b);
  if (a.F.rows() == 0 || b.F.rows() == 0) return 0;
  const Eigen::AlignedBox3d common = closed_box(a).intersection(closed_box(b));
  if (common.isEmpty()) return 0;
  return std::max(DeepestPoint(a, ClosedSurface(b), common).depth(),
                  DeepestPoint(b, ClosedSurface(a), common).depth());
}

}  // namespace geoprior
