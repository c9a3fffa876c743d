#pragma once

#include <string>

#include "core/inputs/skeleton.h"
#include "core/mesh.h"

namespace geoprior::skinning {

/// Refuses a skeleton file in another unit than its character.
///
/// Sizes are diagonals of bounding boxes. Where two or more joints have namesakes in the
/// character's own skeleton, their heads are compared, and the ratio is between 1/3 and 3; else
/// heads and tails with the mesh, 0.15 to 3 (a skeleton may be that of a part).
///
/// @param own   the character's own skeleton; no joints where it has none
/// @param name  of the skeleton file
/// @throws Error  with the ratio
void require_size(const Skeleton& skeleton, const Skeleton& own, const TriMesh& mesh,
                  const std::string& name);

}  // namespace geoprior::skinning
