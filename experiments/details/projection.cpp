#include "experiments/details/projection.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace geoprior::details {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Eigen::Vector3d to_eigen(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

/// Barycentric coordinates of a point in the plane of a triangle, kept in it.
Eigen::Vector3d barycentric(const Kernel::Triangle_3& t, const Eigen::Vector3d& x) {
  const Eigen::Vector3d a = to_eigen(t[0]), b = to_eigen(t[1]), c = to_eigen(t[2]);
  const Eigen::Vector3d n = (b - a).cross(c - a);
  Eigen::Vector3d w(n.dot((c - b).cross(x - b)), n.dot((a - c).cross(x - c)),
                    n.dot((b - a).cross(x - a)));
  w = (w / n.squaredNorm()).cwiseMax(0);
  return w / w.sum();
}

}  // namespace

struct SurfaceProjector::Tree {
  Triangles triangles;
  Boxes boxes;
};

SurfaceProjector::SurfaceProjector(const TriMesh& surface) : tree_(std::make_unique<Tree>()) {
  const auto point = [&](int v) {
    return Kernel::Point_3(surface.V(v, 0), surface.V(v, 1), surface.V(v, 2));
  };
  for (Eigen::Index t = 0; t < surface.F.rows(); ++t) {
    tree_->triangles.emplace_back(point(surface.F(t, 0)), point(surface.F(t, 1)),
                                  point(surface.F(t, 2)));
  }
  tree_->boxes.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->boxes.build();
  tree_->boxes.accelerate_distance_queries();
}

SurfaceProjector::~SurfaceProjector() = default;

SurfaceProjector::Nearest SurfaceProjector::nearest(const Eigen::Vector3d& x) const {
  const auto found = tree_->boxes.closest_point_and_primitive(Kernel::Point_3(x.x(), x.y(), x.z()));
  const Eigen::Vector3d at = to_eigen(found.first);
  return {
      {static_cast<int>(found.second - tree_->triangles.cbegin()), barycentric(*found.second, at)},
      (at - x).norm()};
}

}  // namespace geoprior::details
