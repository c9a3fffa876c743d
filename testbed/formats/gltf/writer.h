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

/// The bytes of a binary glTF 2.0 of a still surface, with its vertex normals: viewers shade it
/// smoothly. Positions are stored in single precision.
///
/// @param mesh    in m
/// @throws Error  naming `name`: an empty mesh, an index out of range, what is not finite, a file
///                over 4 GB
std::string surface_glb(const TriMesh& mesh, const std::string& name);

/// One of the rigid bodies of a chain.
struct GltfLink {
  std::string name;
  TriMesh mesh;                    ///< at rest, in the scene's coordinates (m)
  Eigen::Vector3d pivot{0, 0, 0};  ///< it turns about this point, at rest (m)
  Eigen::Vector3d axis{1, 0, 0};   ///< unit
  std::vector<double> angles;      ///< rad, one a time, against the link before
};

/// The bytes of a binary glTF 2.0 of a chain of rigid bodies: a node a link, child of the one
/// before it, at its pivot; an animation turns every node but the first, key by key, with
/// quaternions. Positions and keys are stored in single precision.
///
/// @param times_s  >= 0, strictly increasing
/// @param name     of the scene's root and the animation
/// @throws Error   naming `name`: no link or no time, an empty mesh or index out of range, angles
/// of
///                 another number than times, what is not finite, times that do not increase
std::string rigid_chain_glb(const std::vector<GltfLink>& links, const std::vector<double>& times_s,
                            const std::string& name);

}  // namespace geoprior
