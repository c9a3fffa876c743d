#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "metrics/contact/bone_rings.h"

namespace geoprior {

/// What a method does to skin that needed nothing: where a plain reference (dual quaternions)
/// neither overlaps nor changes the section, a correction can only do harm.
///
/// Decided on the reference's pose alone, so that it is the same for every method.
struct HarmOptions {
  double clear_radii = 1;  ///< distance from any overlap of the reference, in local radii
  double section_change =
      0.02;  ///< of the vertex' ring, or of any quarter of it, in the reference's pose
};

/// Vertices that nothing asks a correction of; ascending. A vertex without a ring (BoneRings) is
/// none.
/// @param reference   n x 3 (m), the reference's skin in the pose
/// @param overlapping triangles that overlaps of the reference touch
std::vector<int> unasked_vertices(const BoneRings& rings, const Eigen::MatrixX3i& F,
                                  const Eigen::MatrixX3d& reference, const Pose& pose,
                                  const std::vector<int>& overlapping,
                                  const HarmOptions& options = {});

struct Harm {
  double max = 0;            ///< largest displacement from the reference over the local radius
  double unasked_share = 0;  ///< of the skin's rest area
};

/// Over the unasked vertices; absent when there are none.
/// @param posed,reference  n x 3 (m)
std::optional<Harm> harm(const BoneRings& rings, const std::vector<int>& unasked,
                         const Eigen::MatrixX3d& posed, const Eigen::MatrixX3d& reference);

}  // namespace geoprior
