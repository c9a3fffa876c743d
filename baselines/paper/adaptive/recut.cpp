#include "baselines/paper/adaptive/recut.h"

#include <limits>

#include "core/geometry/planar.h"
#include "models/paper/meshing/outline_chains.h"
#include "models/paper/tear/lips.h"

namespace geoprior::paper {
using Eigen::Vector2d;

ShellMesh recut(const ShellMesh& mesh, const Pattern& torn, const std::vector<Vector2d>& anchors,
                double room) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double tolerance = 1e-9 * width(torn);
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
        nearest_on_loops(torn, p).distance <= tolerance) {
      set.add(p);
    }
  }
  const std::vector<std::vector<int>> loops = border_chains(torn, kNever, tolerance, set);
  const std::vector<Eigen::Vector2i> segments = cut_segments(torn, kNever, tolerance, set);
  ShellMesh result;
  result.pattern.resize(set.points().size(), 2);
  for (std::size_t i = 0; i < set.points().size(); ++i) result.pattern.row(i) = set.points()[i];
  result.triangles = constrained_delaunay(result.pattern, loops, segments);
  open_along(result, segments);
  return result;
}

}  // namespace geoprior::paper
