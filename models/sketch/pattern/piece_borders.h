#pragma once

#include <string>
#include <vector>

#include "core/mesh.h"

namespace geoprior::sketch {

/// The borders of a piece that is to be laid flat: closed loops of its vertices, the piece on their
/// left, the longest first. One or more.
///
/// @param who     the method that needs it, for the error
/// @throws Error  unless the piece is one connected oriented manifold with a border and without
///                handles, whose vertices are one fan of triangles each and whose triangles have
///                each a length (names what is wrong)
std::vector<std::vector<int>> piece_borders(const TriMesh& piece, const std::string& who);

/// The border of a disc.
/// @throws Error  as `piece_borders`, and on a second border
std::vector<int> disc_border(const TriMesh& disc, const std::string& who);

}  // namespace geoprior::sketch
