#pragma once

#include <vector>

#include "solvers/fluid/feature.h"
#include "tests/testbed/formats/octahedron.h"

namespace geoprior::test {

/// Two frames of a hill as a map of 4 x 4 texels, and two of a drop.
inline std::vector<fluid::Feature> sample_features() {
  fluid::Feature hill, drop;
  hill.id = 1;
  hill.name = "sample/hill";
  hill.cell = drop.cell = 0.05;
  hill.resolution = 4;
  hill.extent = 0.4;
  drop.id = 2;
  drop.name = "sample/drop";
  drop.kind = fluid::RegionKind::isolated;
  for (int t = 0; t < 2; ++t) {
    fluid::MapFrame map;
    map.displacement = Eigen::MatrixX3f::Constant(16, 3, 0.01F * static_cast<float>(1 + t));
    map.alpha = Eigen::VectorXf::LinSpaced(16, 0, 1);
    hill.maps.push_back(map);
    drop.meshes.push_back(octahedron(0.1 + 0.01 * t));
    for (fluid::Feature* feature : {&hill, &drop}) {
      feature->times.push_back(0.04 * t);
      feature->placement.emplace_back(Eigen::Translation3d(0.5, 0.5, 0.1));
      feature->area.push_back(0.1);
      feature->volume.push_back(0.01);
    }
  }
  return {hill, drop};
}

}  // namespace geoprior::test
