#include "models/paper/recut.h"

#include <algorithm>
#include <limits>

#include "core/planar.h"
#include "models/paper/lips.h"
#include "models/paper/outline_chains.h"
#include "models/paper/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

double distance_to_cuts(const Pattern& pattern, const Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::vector<Vector2d>& cut : pattern.cuts) {
    for (std::size_t i = 0; i + 1 < cut.size(); ++i)
      nearest = std::min(nearest, distance_to_segment(p, cut[i], cut[i + 1]));
  }
  return nearest;
}

}  // namespace

ShellMesh recut(const ShellMesh& mesh, const Pattern& torn, const std::vector<Vector2d>& anchors,
                double room) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double tolerance = 1e-9 * width(torn);
  const Pattern whole{torn.border, torn.holes};
  PointSet set(tolerance);
  for (const Vector2d& p : corners(torn)) set.add(p);
  for (const std::vector<Vector2d>& cut : torn.cuts) {
    for (const Vector2d& p : cut) set.add(p);
  }
  for (const Vector2d& p : anchors) set.add(p);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector2d p = mesh.pattern.row(v);
    const double distance = distance_to_cuts(torn, p);
    if (distance > room || distance <= tolerance ||
        nearest_on_border(whole, p).distance <= tolerance) {
      set.add(p);
    }
  }
  const std::vector<std::vector<int>> loops = border_chains(torn, kNever, tolerance, set);
  const std::vector<Eigen::Vector2i> segments = cut_segments(torn, kNever, tolerance, set);
  ShellMesh result;
  result.pattern.resize(static_cast<Eigen::Index>(set.points().size()), 2);
  for (std::size_t i = 0; i < set.points().size(); ++i)
    result.pattern.row(static_cast<Eigen::Index>(i)) = set.points()[i];
  result.triangles = constrained_delaunay(result.pattern, loops, segments);
  std::vector<Edge> lips;
  for (const Eigen::Vector2i& s : segments) lips.push_back(undirected(s[0], s[1]));
  std::sort(lips.begin(), lips.end());
  open_along(result, lips);
  return result;
}

}  // namespace geoprior::paper
