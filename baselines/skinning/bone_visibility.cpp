#include "baselines/skinning/bone_visibility.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>

namespace geoprior {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangle = Kernel::Triangle_3;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;

/// Share of the segment at the vertex that is not tested: the triangles around it are there.
constexpr double kStart = 1e-3;

Kernel::Point_3 point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct InsideVisibility::Tree {
  std::vector<Triangle> triangles;
  CGAL::AABB_tree<Traits> tree;
};

Eigen::Vector3d Bone::nearest(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d axis = tail - head;
  const double t = std::clamp((p - head).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return head + t * axis;
}

std::vector<Bone> bones_of(const Skeleton& skeleton) {
  std::vector<Bone> bones;
  for (int j = 0; j < skeleton.size(); ++j) {
    const Joint& joint = skeleton.joints[static_cast<std::size_t>(j)];
    if (joint.tail) bones.push_back({j, joint.head, *joint.tail});
  }
  return bones;
}

InsideVisibility::InsideVisibility(const TriMesh& mesh)
    : mesh_(mesh), normals_(vertex_normals(mesh)), tree_(std::make_unique<Tree>()) {
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Triangle triangle(point(mesh.V.row(mesh.F(t, 0))), point(mesh.V.row(mesh.F(t, 1))),
                            point(mesh.V.row(mesh.F(t, 2))));
    if (!triangle.is_degenerate()) tree_->triangles.push_back(triangle);
  }
  tree_->tree.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->tree.build();
}

InsideVisibility::~InsideVisibility() = default;

bool InsideVisibility::sees(int v, const Eigen::Vector3d& target) const {
  const Eigen::Vector3d from = mesh_.V.row(v);
  const Eigen::Vector3d way = target - from;
  if (way.dot(normals_.row(v)) > 0) return false;
  if (way.norm() == 0) return true;
  const Kernel::Segment_3 segment(point(from + kStart * way), point(target));
  return !tree_->tree.do_intersect(segment);
}

}  // namespace geoprior
