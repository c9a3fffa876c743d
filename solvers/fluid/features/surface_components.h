#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/fluid/features/surface_graph.h"

namespace geoprior::fluid {

/// A connected part of a surface.
struct SurfaceComponent {
  int vertices = 0;
  bool closed = true;  ///< no vertex on a border
  double area = 0;     ///< m^2
  double volume = 0;   ///< signed, of a closed one (m^3); negative: oriented inwards
  double upward = 0;   ///< integral of the normal's z (m^2)
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the volume (m)
};

struct SurfaceComponents {
  std::vector<int> of_vertex;
  std::vector<SurfaceComponent> list;  ///< in the order of their first vertices
};

SurfaceComponents surface_components(const SurfaceGraph& graph);

}  // namespace geoprior::fluid
