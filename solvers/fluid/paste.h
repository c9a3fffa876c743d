#pragma once

#include <map>
#include <vector>

#include "core/surface_sequence.h"
#include "solvers/fluid/edits.h"
#include "solvers/fluid/feature.h"

namespace geoprior {

struct PasteOptions {
  bool refine = true;  ///< split target edges longer than `refine_texels` texels under a map
  double refine_texels = 2;
  double projection_reach =
      1;  ///< how far along the normal the target may lie from the map's plane, in extents
  int max_triangles = 4'000'000;  ///< refused beyond, with the size needed
};
void describe(OptionVisitor& v, PasteOptions& options);

/// A feature and what is done to it.
struct Insertion {
  const Feature* feature = nullptr;
  Edit edit;
};

struct PasteReport {
  int displaced_vertices = 0, added_triangles = 0, features = 0;
  double added_volume = 0;  ///< integral of the displacements along the normal (m^3)
  double min_jacobian = 1;  ///< smallest det(I + grad d) over the maps' texels used
  std::vector<std::string>
      warnings;  ///< "edit 'x' lies off the target at 1.2 s", overlapping edits, …
};

/// Pastes features into one frame of the target: maps displace target vertices along the target's
/// tangent frame (several add up: the order does not matter), closed meshes are added or united.
///
/// Anchor: the target point nearest to the feature's edited centre along `up`, or the nearest point
/// at all when there is none; the feature's frame is turned so that its z is the target's normal
/// there, and per vertex for curved targets (discrete exponential map from the anchor).
/// @throws Error  for a target too coarse to hold the feature when `refine` is off or the limit is
/// met (names the size needed), for an edit whose anchor lies off the target
SurfaceFrame paste(const SurfaceFrame& target, const std::vector<Insertion>& insertions,
                   double time, const Eigen::Vector3d& up, const PasteOptions& options,
                   PasteReport* report = nullptr);

}  // namespace geoprior
