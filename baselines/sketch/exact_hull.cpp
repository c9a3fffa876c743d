#include "baselines/sketch/exact_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/planar.h"

namespace geoprior::sketch {
namespace {

namespace hull_pmp = CGAL::Polygon_mesh_processing;
using HullKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using HullSolid = CGAL::Surface_mesh<HullKernel::Point_3>;

/// Longer than any object in the drawing, so that no solid ends within another.
double extrusion_of(const std::vector<OutlinedView>& views) {
  double size = 0;
  for (const OutlinedView& view : views)
    size = std::max({size, view.outline.lowest().norm(), view.outline.highest().norm()});
  return 1.7320508 * size;
}

/// The outline extruded along the view direction, to both sides.
HullSolid extruded(const OutlinedView& view, double reach) {
  const std::vector<Eigen::Vector2d>& outline = view.outline.points();
  const auto n = static_cast<int>(outline.size());
  Eigen::MatrixX2d points(n, 2);
  std::vector<Eigen::Vector2i> segments;
  HullSolid solid;
  for (const double depth : {-reach, reach}) {
    for (int i = 0; i < n; ++i) {
      points.row(i) = outline[static_cast<std::size_t>(i)].transpose();
      if (depth < 0) segments.emplace_back(i, (i + 1) % n);
      const Eigen::Vector3d x =
          view.frame.transpose() * Eigen::Vector3d(points(i, 0), points(i, 1), depth);
      solid.add_vertex(HullKernel::Point_3(x.x(), x.y(), x.z()));
    }
  }
  const auto add = [&](int a, int b, int c) {
    const auto vertex = [](int v) {
      return HullSolid::Vertex_index(static_cast<HullSolid::size_type>(v));
    };
    solid.add_face(vertex(a), vertex(b), vertex(c));
  };
  const Eigen::MatrixX3i cap = constrained_delaunay(points, segments);
  for (Eigen::Index t = 0; t < cap.rows(); ++t) {
    add(cap(t, 0), cap(t, 2), cap(t, 1));
    add(n + cap(t, 0), n + cap(t, 1), n + cap(t, 2));
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    add(i, j, n + j);
    add(i, n + j, n + i);
  }
  return solid;
}

HullSolid intersection_of(const std::vector<OutlinedView>& views, const std::string& drawing) {
  const double reach = extrusion_of(views);
  HullSolid solid = extruded(views.front(), reach);
  for (std::size_t v = 1; v < views.size(); ++v) {
    HullSolid other = extruded(views[v], reach), common;
    if (!hull_pmp::corefine_and_compute_intersection(solid, other, common) || common.is_empty())
      throw Error("the extruded silhouettes have no solid in common", drawing,
                  "views that show one object");
    solid = std::move(common);
  }
  return solid;
}

/// Creases are kept as curves, but their edges too are split and collapsed: where outlines of two
/// views cross the intersection has edges far shorter than wanted, and slivers would stay at them.
void remesh(HullSolid& solid, double edge_length, const ExactHullOptions& options) {
  auto crease = solid.add_property_map<HullSolid::Edge_index, bool>("e:crease", false).first;
  hull_pmp::detect_sharp_edges(solid, options.crease_deg, crease);
  std::vector<HullSolid::Edge_index> kept;
  for (const HullSolid::Edge_index e : solid.edges()) {
    if (crease[e]) kept.push_back(e);
  }
  hull_pmp::split_long_edges(kept, edge_length, solid,
                             hull_pmp::parameters::edge_is_constrained_map(crease));
  hull_pmp::isotropic_remeshing(
      solid.faces(), edge_length, solid,
      hull_pmp::parameters::number_of_iterations(static_cast<unsigned>(options.remeshing))
          .edge_is_constrained_map(crease)
          .protect_constraints(false));
  solid.collect_garbage();
}

TriMesh mesh_of_solid(const HullSolid& solid) {
  TriMesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(solid.number_of_vertices()), 3);
  mesh.F.resize(static_cast<Eigen::Index>(solid.number_of_faces()), 3);
  for (const HullSolid::Vertex_index v : solid.vertices()) {
    const HullKernel::Point_3& p = solid.point(v);
    mesh.V.row(static_cast<Eigen::Index>(v.idx())) << p.x(), p.y(), p.z();
  }
  Eigen::Index t = 0;
  for (const HullSolid::Face_index f : solid.faces()) {
    int k = 0;
    for (const HullSolid::Vertex_index v : solid.vertices_around_face(solid.halfedge(f)))
      mesh.F(t, k++) = static_cast<int>(v.idx());
    ++t;
  }
  return mesh;
}

}  // namespace

void describe(OptionVisitor& v, ExactHullOptions& o) {
  v.value("remeshing", o.remeshing, {.doc = "passes of isotropic remeshing", .min = 0, .max = 100});
  v.value("crease_deg", o.crease_deg,
          {.doc = "edges at which the hull turns by more are kept",
           .unit = "deg",
           .min = 1,
           .max = 179});
}

VisualHull exact_hull(const Drawing& aligned, const HullOptions& hull,
                      const ExactHullOptions& options) {
  VisualHull result;
  result.views = outlined_views(aligned);
  if (result.views.size() < 2)
    throw Error("has too few views for a hull", aligned.name, "two of front, side and top");
  HullSolid solid = intersection_of(result.views, aligned.name);
  // Equilateral triangles of that edge have the surface's area in all.
  const double area = CGAL::to_double(hull_pmp::area(solid));
  result.spacing = std::sqrt(4 / std::numbers::sqrt3 * area / hull.triangles);
  remesh(solid, result.spacing, options);
  result.mesh = mesh_of_solid(solid);
  place_on_silhouettes(result);
  return result;
}

}  // namespace geoprior::sketch
