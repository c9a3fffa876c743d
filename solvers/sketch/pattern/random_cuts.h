#pragma once

#include <vector>

#include "core/mesh.h"
#include "models/sketch/surface/path.h"

namespace geoprior::sketch {

/// Straight cuts that know nothing of the shape: from vertices of the border drawn by lot towards
/// vertices drawn by lot, until they are together as long as asked for. What a suggestion has to
/// beat.
///
/// @param piece         with a border
/// @param length_asked  of all together (m); met up to an edge
/// @return        paths that do not cross; shorter together when 200 draws were not enough
std::vector<SurfacePath> random_cuts(const TriMesh& piece, double length_asked, int seed);

}  // namespace geoprior::sketch
