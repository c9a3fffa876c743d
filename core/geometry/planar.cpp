#include "core/geometry/planar.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<bool, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                               CGAL::No_constraint_intersection_tag>;

Point to_point(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

/// Marks the given faces, and every face that they reach without crossing a segment: info is true
/// outside.
void mark_outside(Triangulation& t, std::vector<Triangulation::Face_handle> stack) {
  for (const auto& face : t.all_face_handles()) face->info() = false;
  for (const auto& face : stack) face->info() = true;
  while (!stack.empty()) {
    const Triangulation::Face_handle face = stack.back();
    stack.pop_back();
    for (int k = 0; k < 3; ++k) {
      const Triangulation::Face_handle next = face->neighbor(k);
      if (next->info() || face->is_constrained(k)) continue;
      next->info() = true;
      stack.push_back(next);
    }
  }
}

/// The face on the right of the edge from a to b. @throws Error  when they share none
Triangulation::Face_handle face_right_of(const Triangulation& t, Triangulation::Vertex_handle a,
                                         Triangulation::Vertex_handle b) {
  Triangulation::Face_handle face;
  int k = 0;
  if (!t.is_edge(a, b, face, k)) {
    throw Error("a point lies inside a segment",
                "segment " + std::to_string(a->info()) + " to " + std::to_string(b->info()));
  }
  return face->vertex(Triangulation::ccw(k)) == a ? face->neighbor(k) : face;
}

std::vector<Triangulation::Vertex_handle> insert_points(Triangulation& t,
                                                        const Eigen::MatrixX2d& points) {
  std::vector<Triangulation::Vertex_handle> vertices;
  vertices.reserve(points.rows());
  Triangulation::Face_handle hint;
  for (int i = 0; i < points.rows(); ++i) {
    const auto before = t.number_of_vertices();
    const Triangulation::Vertex_handle v = t.insert(to_point(points.row(i)), hint);
    if (t.number_of_vertices() == before) {
      throw Error("two points of the triangulation coincide",
                  "points " + std::to_string(v->info()) + " and " + std::to_string(i));
    }
    v->info() = i;
    hint = v->face();
    vertices.push_back(v);
  }
  return vertices;
}

void insert_segments(Triangulation& t, const std::vector<Triangulation::Vertex_handle>& vertices,
                     const std::vector<Eigen::Vector2i>& segments) {
  std::set<std::pair<int, int>> inserted;  // a segment given twice would count as crossing itself
  for (const Eigen::Vector2i& s : segments) {
    if (!inserted.insert({s.minCoeff(), s.maxCoeff()}).second) continue;
    try {
      t.insert_constraint(vertices[s[0]], vertices[s[1]]);
    } catch (const Triangulation::Intersection_of_constraints_exception&) {
      throw Error("segment crosses another",
                  "segment " + std::to_string(s[0]) + " to " + std::to_string(s[1]));
    }
  }
}

Eigen::MatrixX3i triangles_inside(const Triangulation& t) {
  std::vector<Eigen::Vector3i> triangles;
  triangles.reserve(t.number_of_faces());
  for (const auto& face : t.finite_face_handles()) {
    if (face->info()) continue;
    triangles.emplace_back(face->vertex(0)->info(), face->vertex(1)->info(),
                           face->vertex(2)->info());
  }
  Eigen::MatrixX3i result(triangles.size(), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    result.row(i) = triangles[i];
  }
  return result;
}

}  // namespace

int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return static_cast<int>(CGAL::orientation(to_point(a), to_point(b), to_point(c)));
}

bool segments_meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                   const Eigen::Vector2d& d) {
  for (int k = 0; k < 2; ++k) {
    if (std::max(a[k], b[k]) < std::min(c[k], d[k])) return false;
    if (std::max(c[k], d[k]) < std::min(a[k], b[k])) return false;
  }
  return orientation(a, b, c) * orientation(a, b, d) <= 0 &&
         orientation(c, d, a) * orientation(c, d, b) <= 0;
}

Eigen::MatrixX3i constrained_delaunay(const Eigen::MatrixX2d& points,
                                      const std::vector<std::vector<int>>& loops,
                                      const std::vector<Eigen::Vector2i>& segments) {
  Triangulation t;
  const auto vertices = insert_points(t, points);
  std::vector<Eigen::Vector2i> all;
  for (const std::vector<int>& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      all.emplace_back(loop[i], loop[i + 1 == loop.size() ? 0 : i + 1]);
  }
  all.insert(all.end(), segments.begin(), segments.end());
  insert_segments(t, vertices, all);
  std::vector<Triangulation::Face_handle> outside{t.infinite_face()};
  // The outside of the first loop is reached from infinity.
  for (std::size_t k = 1; k < loops.size(); ++k)
    outside.push_back(face_right_of(t, vertices[loops[k][0]], vertices[loops[k][1]]));
  mark_outside(t, std::move(outside));
  return triangles_inside(t);
}

Eigen::MatrixX3i constrained_delaunay(const Eigen::MatrixX2d& points,
                                      const std::vector<Eigen::Vector2i>& segments) {
  Triangulation t;
  insert_segments(t, insert_points(t, points), segments);
  mark_outside(t, {t.infinite_face()});
  return triangles_inside(t);
}

}  // namespace geoprior
