#include "core/geometry/triangle_tree.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>

#include "core/error.h"

namespace geoprior {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

Eigen::Vector3d to_eigen(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }

Kernel::Triangle_3 triangle_of(const TriMesh& mesh, int face) {
  const auto corner = [&](int k) { return to_point(mesh.V.row(mesh.F(face, k))); };
  return {corner(0), corner(1), corner(2)};
}

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

std::vector<int> faces_with_area(const TriMesh& mesh) {
  std::vector<int> faces;
  faces.reserve(mesh.triangle_count());
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    if (!triangle_of(mesh, f).is_degenerate()) faces.push_back(f);
  }
  return faces;
}

struct TriangleTree::Impl {
  std::vector<int> faces;
  Triangles triangles;  ///< of the faces
  Boxes boxes;

  void require_triangles() const {
    if (triangles.empty()) throw Error("no triangle with an area", "nearest point", "at least one");
  }
};

TriangleTree::TriangleTree(const TriMesh& mesh) : impl_(std::make_unique<Impl>()) {
  impl_->faces = faces_with_area(mesh);
  impl_->triangles.reserve(impl_->faces.size());
  for (const int f : impl_->faces) impl_->triangles.push_back(triangle_of(mesh, f));
  impl_->boxes.insert(impl_->triangles.cbegin(), impl_->triangles.cend());
  // The points that start the search for a nearest one are sorted with the first such query.
  impl_->boxes.build();
}

TriangleTree::~TriangleTree() = default;
TriangleTree::TriangleTree(TriangleTree&&) noexcept = default;
TriangleTree& TriangleTree::operator=(TriangleTree&&) noexcept = default;

TriangleTree::Nearest TriangleTree::nearest(const Eigen::Vector3d& x) const {
  impl_->require_triangles();
  const auto [point, triangle] = impl_->boxes.closest_point_and_primitive(to_point(x));
  const Eigen::Vector3d at = to_eigen(point);
  const int face = impl_->faces[triangle - impl_->triangles.cbegin()];
  return {{face, barycentric(*triangle, at)}, (at - x).norm()};
}

double TriangleTree::squared_distance(const Eigen::Vector3d& x) const {
  impl_->require_triangles();
  return impl_->boxes.squared_distance(to_point(x));
}

bool TriangleTree::meets_ball(const Eigen::Vector3d& centre, double squared_radius) const {
  return impl_->boxes.do_intersect(Kernel::Sphere_3(to_point(centre), squared_radius));
}

bool TriangleTree::meets_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  return impl_->boxes.do_intersect(Kernel::Segment_3(to_point(a), to_point(b)));
}

}  // namespace geoprior
