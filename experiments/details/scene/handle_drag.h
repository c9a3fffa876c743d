#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/options.h"
#include "models/details/scene.h"
#include "testbed/keyframes.h"

namespace geoprior::details {

/// Vertices that are held and moved: those in a ball at rest.
struct HandleBallOptions {
  std::array<double, 3> centre{0, 0, 0};
  double radius = 0.1;  ///< m
  std::vector<KeyOptions> keys;
};
void describe(OptionVisitor& v, HandleBallOptions& options);

/// Handles are moved, the rest of the surface follows as rigidly as possible.
struct HandleDragOptions {
  std::vector<HandleBallOptions> handles;
  int iterations = 5;
};
void describe(OptionVisitor& v, HandleDragOptions& options);

/// The surface at every frame: handles go where their keys say; the other vertices minimise the
/// as-rigid-as-possible energy with rigidity of spokes and rims, from the frame before.
///
/// Source: Sorkine, Alexa 2007; Chao, Pinkall, Sanan, Schröder 2010 (CGAL's
/// Surface_mesh_deformation).
/// @param times  of the frames (s); the first is the surface at rest
/// @throws Error  naming the key: no handles, one that holds no vertex, a vertex in two, nothing
///                left to follow
std::shared_ptr<const SurfaceMotion> drag_handles(const TriMesh& rest,
                                                  const HandleDragOptions& options,
                                                  const std::vector<double>& times);

}  // namespace geoprior::details
