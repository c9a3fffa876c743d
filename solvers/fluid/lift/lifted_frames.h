#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

/// The differential feature to be shown: the one of this id, else the one whose regions add up to
/// the largest area over its frames. Null when none is differential and no id is asked for.
/// @throws Error  for an id that is no differential feature (names those that are)
const Feature* shown_map(const std::vector<Feature>& features, const std::optional<int>& id);

/// The map of a differential feature at a time of its animation, N x N, over its own plane: x along
/// the feature's path or longest axis, origin at its centre. Arrays "height" (what a paste adds
/// along the base normal: alpha times displacement, m), "alpha" [1] and "displacement" (as stored,
/// in the axes of the moving frame, m). All 0 at times when the feature does not live.
Part map_part(const Feature& feature, double time);

/// Bytes that the positions and triangles of a mesh take in memory.
double mesh_bytes(const TriMesh& mesh);

/// One row a feature: what it is, and how much memory it takes beside the meshes of its animation
/// over the same frames.
/// @param times        of the animation's frames (s)
/// @param frame_bytes  of the animation's frames, by `mesh_bytes`
FrameTable feature_table(const std::vector<Feature>& features, const std::vector<double>& times,
                         const std::vector<double>& frame_bytes);

}  // namespace geoprior::fluid
