#pragma once

#include <string>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "solvers/fluid/edits.h"
#include "solvers/fluid/paste/options.h"

namespace geoprior::fluid {

struct PasteReport {
  int displaced_vertices = 0, added_triangles = 0, features = 0;
  double added_volume = 0;  ///< between the surfaces before and after, maps only (m^3)
  double min_jacobian = 1;  ///< smallest det(I + grad d) in the maps' planes over texels used
  std::vector<int> vertex_feature;    ///< per vertex of the result: id that moved it most, or 0
  std::vector<std::string> warnings;  ///< "edit 'x' lies off the target at 1.2 s", overlaps, …
};

/// Pastes features into one frame of the target: maps displace target vertices (several add up; the
/// order of the insertions does not matter, to the last bit), closed meshes are added or united.
///
/// x' = x + sum fade * alpha * A d(u, v): (u, v) of a target vertex is its place in the edited
/// feature's frame A, found by projection, or by the discrete exponential map from the anchor, with
/// A turned to the target's normal at every vertex. Anchor: the target point nearest to the edited
/// centre along `up`, or the nearest point at all within half the map. Only the part of the
/// target that is connected to the anchor and faces the map is displaced (not a tank's floor).
/// A closed manifold target stays one.
///
/// @throws Error  for a target too coarse to hold the feature when `refine` is off (mean edge over
/// twice the limit) or more than `max_triangles` would be needed; both name the size needed.
/// A feature whose anchor is nowhere is left out with a warning.
/// Sources: thesis 3.3.2; exponential map: Schmidt, Grimm and Wyvill 2006, Schmidt 2013.
SurfaceFrame paste(const SurfaceFrame& target, const std::vector<Insertion>& insertions,
                   double time, const Eigen::Vector3d& up, const PasteOptions& options,
                   PasteReport* report = nullptr);

}  // namespace geoprior::fluid
