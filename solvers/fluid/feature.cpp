#include "solvers/fluid/feature.h"

namespace geoprior {

std::size_t Feature::bytes() const {
  std::size_t total = sizeof(Feature) + times.size() * (sizeof(double) + sizeof(Eigen::Isometry3d));
  for (const MapFrame& map : maps) {
    total += static_cast<std::size_t>(map.displacement.size() + map.alpha.size()) * sizeof(float);
  }
  for (const TriMesh& mesh : meshes) {
    total += static_cast<std::size_t>(mesh.V.size()) * sizeof(double) +
             static_cast<std::size_t>(mesh.F.size()) * sizeof(int);
  }
  return total;
}

}  // namespace geoprior
