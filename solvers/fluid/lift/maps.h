#pragma once

#include <vector>

#include "solvers/fluid/feature.h"
#include "solvers/fluid/lift/patch.h"

namespace geoprior::fluid {

/// Maps, extent and moving frames of a differential feature from its patches.
///
/// A texel's place is that of the bed's vertex, so overhangs stay: orthographic along the moving
/// frame's z while at most 1 % of the beds' area is steeper than n.z = 0.2, for all frames;
/// otherwise by the discrete exponential map from the point of the bed nearest to the origin, with
/// displacements in the transported axes. Beds are smoothed in time inside the map (by what all
/// three frames know, vanishing with alpha). Times of the animation between the feature's frames
/// that have no patch get maps interpolated linearly.
///
/// @param patches  in order of time, at least one
/// @param times    of the animation's frames (s)
/// @param cell     h (m)
Feature feature_of_patches(std::vector<LiftPatch> patches, const std::vector<double>& times,
                           double cell, const MapOptions& options);

}  // namespace geoprior::fluid
