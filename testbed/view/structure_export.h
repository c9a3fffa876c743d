#pragma once

#include <string>
#include <vector>

#include "core/frame.h"

namespace geoprior {

/// Whether these are surfaces whose triangles have a named array `structure`: at least one has
/// triangles, and all that have them have it.
bool have_structures(const std::vector<Part>& frames);

/// The bytes of a binary glTF of such frames: a named node a structure (switched_meshes.h), in the
/// order of the codes. Where the triangles have a named array `kind` too, a kind is a material, in
/// the colour that a figure coloured by it has; else there is one of clay. Normals are those of the
/// whole surface, so that no seam shows between structures that share vertices.
///
/// @param times_s  one a frame, increasing
/// @param name     of the scene, for messages too
/// @throws Error   naming `name`: values that are no codes, what is not finite
std::string structures_glb(const std::vector<Part>& frames, const std::vector<double>& times_s,
                           const std::string& name);

}  // namespace geoprior
