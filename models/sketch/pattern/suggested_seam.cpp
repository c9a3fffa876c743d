#include "models/sketch/pattern/suggested_seam.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "models/sketch/surface/split.h"

namespace geoprior::sketch {

bool SeamedSurface::cut(std::span<const SurfacePath> paths, int seam) {
  std::vector<Edge> kept;
  for (const SeamEdge& e : seams) kept.push_back(e.edge);
  std::optional<SurfaceSplit> split = split_along(mesh, paths, kept);
  if (!split || split->path.empty()) return false;
  std::vector<SeamEdge> finer;
  for (const SeamEdge& e : seams) {
    const Edge sorted{std::min(e.edge[0], e.edge[1]), std::max(e.edge[0], e.edge[1])};
    for (const Edge& part : split->split_edges({&sorted, 1}, mesh.vertex_count()))
      finer.push_back({part, e.seam});
  }
  seams = std::move(finer);
  mesh.V = split->interpolated(mesh.V);
  mesh.F = std::move(split->triangles);
  for (const Edge& e : split->path) seams.push_back({e, seam});
  return true;
}

}  // namespace geoprior::sketch
