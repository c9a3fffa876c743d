#pragma once

#include <string>
#include <vector>

#include "core/geometry/holes/cap_holes.h"
#include "core/inputs/rig.h"

namespace geoprior::skinning {

/// What becomes of the holes of a skin: closed for the computation, or left as the file has them.
enum class Holes { cap, keep };

/// Appends caps to a mesh; they are its last triangles until `take_caps_off`.
HoleCaps put_caps_on(TriMesh& mesh);

/// Takes the last `count` triangles off.
void take_caps_off(TriMesh& mesh, int count);

/// What a user is told of the holes of a rig: one line for those that are capped and one for those
/// that stay open, the largest first, each at the joint that holds most of its border. None of a
/// character of sheets alone, which has no inside that could be open.
std::vector<std::string> hole_notes(const HoleCaps& caps, const RiggedMesh& rig);

}  // namespace geoprior::skinning
