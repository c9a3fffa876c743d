#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/fluid/paste/map_paste.h"

namespace geoprior::fluid {

/// A differential feature at a time of the target, and its neighbouring times for rates.
struct PlacedMap {
  const Insertion* insertion = nullptr;
  EditedFrame frame;
  DisplacementSampler map;
  MapCoordinates places;

  struct Instant {
    double time = 0;  ///< s, from now
    EditedFrame frame;
    DisplacementSampler map;
  };
  std::vector<Instant> instants;  ///< two about now, or none: rates are not wanted
};

/// Displacement of one vertex under a map, and how much of the map is there.
struct Displaced {
  std::vector<Eigen::Vector3d> shift;  ///< per place (m)
  std::vector<double> alpha;           ///< fade times weight times alpha
};

/// Displacements of the vertices that have a place in the map.
Displaced displacements(const PlacedMap& placed);

/// Subtracts a constant times alpha along the map's normal so that no volume is added. The volume
/// is linear in it for a projected map; otherwise a few secant steps.
void lock_volume(const WorkMesh& mesh, const PlacedMap& placed, Displaced& displaced);

/// Rates of the displacements of target points that move with the target (m/s); no rows: unknown.
std::vector<Eigen::Vector3d> displacement_rates(const WorkMesh& mesh, const PlacedMap& placed);

/// Volume between a surface and the same surface with its vertices shifted (m^3), positive where it
/// grows outwards: exact for closed surfaces, and for open ones whose border stays.
double swept_volume(const WorkMesh& mesh, const std::vector<Eigen::Vector3d>& shift);

}  // namespace geoprior::fluid
