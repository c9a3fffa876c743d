#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// Writes a mesh and its frames as one binary glTF 2.0: a morph target a frame, and an animation
/// that blends linearly from frame to frame. Any viewer of glTF plays it. Positions are stored in
/// single precision.
///
/// Written as temporary + rename: an error leaves nothing behind.
/// @param base     n vertices (m), the pose without animation; may be split at seams
/// @param frames   n x 3 positions each; none: a still mesh
/// @param times_s  one a frame, >= 0, strictly increasing
/// @param name     of mesh, node and animation
/// @throws Error   naming the file: counts that differ, times that do not increase, positions that
///                 are not finite, indices out of range, an empty mesh, a file over 4 GB, or the
///                 system's reason
void write_glb_animation(const std::filesystem::path& file, const TriMesh& base,
                         const std::vector<Eigen::MatrixX3d>& frames,
                         const std::vector<double>& times_s, const std::string& name);

}  // namespace geoprior
