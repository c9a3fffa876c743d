#include "metrics/contact/drawn_pop.h"

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/geometry/triangle_tree.h"
#include "core/parallel.h"
#include "metrics/shape/surface_distance.h"

namespace geoprior {
namespace {

constexpr std::size_t kVerticesOfBlock = 256;

/// A surface with its interpolated normals: a frame at each of its points.
class FramedSurface {
 public:
  explicit FramedSurface(const TriMesh& mesh) : mesh_(mesh), normals_(vertex_normals(mesh)) {}

  [[nodiscard]] Eigen::Vector3d origin(const SurfacePoint& at) const {
    return position_of(at, mesh_.V, mesh_.F);
  }
  /// Columns: tangent, bitangent, normal. A surface folded flat has none: the world's axes then.
  [[nodiscard]] Eigen::Matrix3d axes(const SurfacePoint& at) const {
    const Eigen::Vector3d normal = position_of(at, normals_, mesh_.F).normalized();
    const Eigen::Vector3d edge =
        (mesh_.V.row(mesh_.F(at.face, 1)) - mesh_.V.row(mesh_.F(at.face, 0))).transpose();
    const Eigen::Vector3d bitangent = normal.cross(edge).normalized();
    if (bitangent.norm() == 0) return Eigen::Matrix3d::Identity();
    Eigen::Matrix3d axes;
    axes << bitangent.cross(normal), bitangent, normal;
    return axes;
  }

 private:
  const TriMesh& mesh_;
  Eigen::MatrixX3d normals_;
};

}  // namespace

TriMesh carried_drawing(const TriMesh& drawn, const TriMesh& before, const TriMesh& now) {
  if (!same_triangles(before.F, now.F) || before.vertex_count() != now.vertex_count()) {
    throw Error("the surface's triangles changed", "drawing that is carried",
                "two states of one mesh");
  }
  const TriangleTree tree(before);
  const FramedSurface from(before), to(now);
  TriMesh carried = drawn;
  parallel_blocks(drawn.V.rows(), kVerticesOfBlock, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index v = begin; v < static_cast<Eigen::Index>(end); ++v) {
      const Eigen::Vector3d x = drawn.V.row(v);
      const SurfacePoint at = tree.nearest(x).point;
      const Eigen::Vector3d offset = from.axes(at).transpose() * (x - from.origin(at));
      carried.V.row(v) = (to.origin(at) + to.axes(at) * offset).transpose();
    }
  });
  return carried;
}

DrawnPop drawn_pop(const TriMesh& base_before, const TriMesh& drawn_before, const TriMesh& base_now,
                   const TriMesh& drawn_now, double spacing) {
  const TriMesh carried = carried_drawing(drawn_before, base_before, base_now);
  return {largest_distance(drawn_now, carried, spacing),
          largest_distance(carried, drawn_now, spacing)};
}

}  // namespace geoprior
