#pragma once

#include <string>

#include "core/frame.h"

namespace geoprior {

/// A part as Wavefront OBJ text: vertices with 17 digits (exact), `f`, `l` or `p` elements. Arrays
/// have no place in this format. Grids are no mesh: see `is_mesh`.
std::string part_to_obj(const Part& part, const std::string& comment);

/// A part as binary little-endian PLY: float64 vertices, triangles or edges; arrays on the points
/// or cells as further float64 properties ("name", or "name_0" … for vectors).
std::string part_to_ply(const Part& part, const std::string& comment);

/// True for what the formats above can hold: triangles, lines, points.
bool is_mesh(const Part& part);

}  // namespace geoprior
