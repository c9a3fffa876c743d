#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "solvers/fluid/edits.h"
#include "solvers/fluid/lift/displacement_map_sampler.h"
#include "solvers/fluid/paste/options.h"
#include "solvers/fluid/paste/refinement.h"

namespace geoprior::fluid {

/// A point of the target that a map hangs on.
struct PasteAnchor {
  int triangle = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

/// The point of the target nearest to `centre` along `up`, on a triangle that faces `up`; where
/// there is none, the nearest point of such a triangle within `reach` (m).
std::optional<PasteAnchor> find_anchor(const WorkMesh& mesh, const Eigen::Vector3d& centre,
                                       const Eigen::Vector3d& up, double reach);

/// Where target vertices lie in a feature's map.
struct MapCoordinates {
  std::vector<int> vertex;            ///< ascending
  std::vector<Eigen::Vector2d> uv;    ///< in the feature's frame, before the edit (m)
  std::vector<double> weight;         ///< 0 … 1: how much the vertex faces the map
  std::vector<Eigen::Matrix3d> axes;  ///< of every vertex, times scale; empty: the placement's
};

/// Finds where vertices lie in the map, by projection along the placement's z, or by the
/// exponential map (see `MappingKind`).
MapCoordinates locate(const WorkMesh& mesh, const EditedFrame& frame,
                      const DisplacementSampler& map, const PasteAnchor& anchor,
                      const PasteOptions& options);

/// New vertices get the mean of what is known of the ends of their edges.
void add_middles(const std::vector<std::array<int, 2>>& parents, int first, MapCoordinates& places);

/// Splits edges under the map until they are short enough for its texels.
/// @param others  places in other maps, carried along
/// @throws Error  as `paste` says; @param who  is named
void refine_under_map(WorkMesh& mesh, const DisplacementSampler& map, const PasteOptions& options,
                      const std::string& who, MapCoordinates& places,
                      const std::vector<MapCoordinates*>& others);

}  // namespace geoprior::fluid
