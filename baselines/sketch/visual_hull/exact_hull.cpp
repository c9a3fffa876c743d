#include "baselines/sketch/visual_hull/exact_hull.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/geometry/solid.h"
#include "core/geometry/solid_remesh.h"

namespace geoprior::sketch {
namespace {

/// Passes of isotropic remeshing. Ours: nobody names a number.
constexpr int kRemeshings = 5;
/// Edges at which the hull turns by more are kept: those between the views' faces turn by 90
/// degrees, chords of a round silhouette by a few.
constexpr double kCreaseDegrees = 30;

/// Longer than any object in the drawing, so that no solid ends within another.
double extrusion_of(const std::vector<OutlinedView>& views) {
  double size = 0;
  for (const OutlinedView& view : views)
    size = std::max({size, view.outline.lowest().norm(), view.outline.highest().norm()});
  return 1.7320508 * size;
}

/// The outline extruded along the view direction, to both sides.
TriMesh extruded(const OutlinedView& view, double reach) {
  const std::vector<Eigen::Vector2d>& outline = view.outline.points();
  const auto n = static_cast<int>(outline.size());
  Eigen::MatrixX2d points(n, 2);
  std::vector<Eigen::Vector2i> segments;
  for (int i = 0; i < n; ++i) {
    points.row(i) = outline[i].transpose();
    segments.emplace_back(i, (i + 1) % n);
  }
  const Eigen::MatrixX3i cap = constrained_delaunay(points, segments);
  TriMesh mesh;
  mesh.V.resize(2 * n, 3);
  for (int i = 0; i < 2 * n; ++i) {
    const Eigen::Vector3d x(points(i % n, 0), points(i % n, 1), i < n ? -reach : reach);
    mesh.V.row(i) = (view.frame.transpose() * x).transpose();
  }
  mesh.F.resize(2 * cap.rows() + 2 * n, 3);
  Eigen::Index t = 0;
  for (Eigen::Index c = 0; c < cap.rows(); ++c) {
    mesh.F.row(t++) << cap(c, 0), cap(c, 2), cap(c, 1);
    mesh.F.row(t++) << n + cap(c, 0), n + cap(c, 1), n + cap(c, 2);
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.F.row(t++) << i, j, n + j;
    mesh.F.row(t++) << i, n + j, n + i;
  }
  return mesh;
}

Solid intersection_of(const std::vector<OutlinedView>& views, const std::string& drawing) {
  const double reach = extrusion_of(views);
  std::optional<Solid> solid = Solid::of(extruded(views.front(), reach));
  for (std::size_t v = 1; v < views.size(); ++v) {
    std::optional<Solid> other = Solid::of(extruded(views[v], reach));
    if (solid && other) solid = common(std::move(*solid), std::move(*other));
    if (!solid || !other || solid->empty())
      throw Error("the extruded silhouettes have no solid in common", drawing,
                  "views that show one object");
  }
  return std::move(*solid);
}

}  // namespace

VisualHull exact_hull(const Drawing& aligned, const HullOptions& hull) {
  VisualHull result;
  result.views = outlined_views(aligned);
  if (result.views.size() < 2)
    throw Error("has too few views for a hull", aligned.name, "two of front, side and top");
  Solid solid = intersection_of(result.views, aligned.name);
  // Equilateral triangles of that edge have the surface's area in all.
  result.spacing = std::sqrt(4 / std::numbers::sqrt3 * solid.area() / hull.triangles);
  remesh(solid, result.spacing, kCreaseDegrees, kRemeshings);
  result.mesh = solid.mesh();
  place_on_silhouettes(result);
  return result;
}

}  // namespace geoprior::sketch
