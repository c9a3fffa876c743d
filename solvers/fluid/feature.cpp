#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

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

void describe(OptionVisitor& v, MapOptions& o) {
  v.value("texel", o.texel,
          {.doc = "largest edge of a map's texel", .unit = "h", .min = 0.05, .max = 10});
  v.value("max_resolution", o.max_resolution,
          {.doc = "most texels along an edge of a map, which limits what `texel` asks for",
           .min = 8,
           .max = 4096});
  v.value("min_resolution", o.min_resolution,
          {.doc = "fewest texels along an edge of a map", .min = 8, .max = 4096});
  v.value("vector_map", o.vector_map,
          {.doc = "maps hold vectors; without, heights along the normal of the bed"});
  v.value("border", o.border,
          {.doc = "width beside the region over which alpha falls to 0 and the bed is made",
           .unit = "h",
           .min = 0.5,
           .max = 100});
  v.value("margin", o.margin,
          {.doc = "ratio of the map's extent to the region's", .min = 1, .max = 4});
  v.value("smoothing_window", o.smoothing_window,
          {.doc = "frames over which the moving frame is smoothed (Savitzky and Golay, order 2)",
           .min = 1,
           .max = 101});
}

}  // namespace geoprior::fluid
