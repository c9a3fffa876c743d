#include "models/sketch/suggested_seam.h"

#include <optional>
#include <utility>

#include "models/sketch/surface_split.h"

namespace geoprior::sketch {

bool SeamedSurface::cut(std::span<const SurfacePath> paths, int seam) {
  std::optional<SurfaceSplit> split = split_along(mesh, paths);
  if (!split || split->path.empty()) return false;
  mesh.V = split->interpolated(mesh.V);
  mesh.F = std::move(split->triangles);
  for (const Edge& e : split->path) seams.push_back({e, seam});
  return true;
}

}  // namespace geoprior::sketch
