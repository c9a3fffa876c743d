#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// How a surface looks: its colour (sRGB, 0 … 1 a channel), neither metal nor mirror.
struct GltfMaterial {
  std::string name;
  std::array<double, 3> color{1, 1, 1};
};

/// A piece of a mesh of one material.
struct GltfPiece {
  TriMesh mesh;              ///< m
  Eigen::MatrixX3d normals;  ///< of the vertices, unit
  int material = 0;
};

/// A thing whose mesh is another one in each frame.
struct GltfSwitched {
  std::string name;
  std::vector<std::vector<GltfPiece>> frames;  ///< one a time; empty: it is not there
};

/// The bytes of a binary glTF 2.0 of things that grow: a node a thing, named, at the root of the
/// scene. Of one frame the node has the mesh. Of several it has a child a frame that it is in,
/// "<name> 0003" of frame 3, and one animation shows, from the time of a frame to that of the next,
/// the children of that frame alone: their scale is 1, that of the others 0, without a transition
/// (STEP); the last is seen as long as the one before it. Without the animation the first frame is
/// seen. The mesh may be another one in every frame, in triangles and in parts; what moves smoothly
/// is therefore seen in steps. Positions are stored in single precision.
///
/// @param times_s  one a frame, >= 0, strictly increasing; of one frame it is not used
/// @param name     of the scene and the animation
/// @throws Error   naming `name`: nothing in any frame, a thing with another number of frames than
///                 times, an empty piece, an index out of range, a material that is not there, what
///                 is not finite, times that do not increase, a file over 4 GB
/// Source: Khronos glTF 2.0 specification, 3.11 (animations), 3.9 (materials).
std::string switched_meshes_glb(const std::vector<GltfSwitched>& things,
                                const std::vector<GltfMaterial>& materials,
                                const std::vector<double>& times_s, const std::string& name);

}  // namespace geoprior
