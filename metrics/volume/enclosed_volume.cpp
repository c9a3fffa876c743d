#include "metrics/volume/enclosed_volume.h"

#include <algorithm>
#include <cmath>

namespace geoprior {

std::optional<double> enclosed_volume(const TriMesh& mesh, const Closedness& closed) {
  if (mesh.triangle_count() == 0 || closed.defects() != 0) return {};
  return signed_volume(mesh.V, mesh.F);
}

std::optional<double> enclosed_volume(const TriMesh& mesh) {
  return enclosed_volume(mesh, closedness(mesh));
}

std::optional<double> largest_drift(const std::vector<std::optional<double>>& volumes) {
  std::optional<double> drift;
  for (const std::optional<double>& volume : volumes) {
    if (!volume || *volumes.front() == 0) return {};
    drift = std::max(drift.value_or(0), std::abs(*volume / *volumes.front() - 1));
  }
  return drift;
}

}  // namespace geoprior
