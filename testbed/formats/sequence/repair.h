#pragma once

#include <string>
#include <vector>

#include "core/inputs/surface_sequence.h"

namespace geoprior {

/// Makes of a mesh as others write it what the methods expect: vertices shared along seams, every
/// edge with at most two triangles that agree in orientation, outside outwards, no vertex without a
/// triangle.
///
/// - Doubled vertices (bitwise equal) are welded when that closes edges and spoils none.
/// - A component whose triangles disagree is oriented as most of its triangles are.
/// - The largest component (by area) says whether the mesh is inside out: a closed one by its
///   volume, an open one by whether it faces down. Then all triangles are turned over; closed
///   components that are inward on their own stay so (bubbles).
///
/// @param notes  added: what was done, one line each without numbers of the frame
/// @throws Error  at `where`: no triangles, a position or velocity that is not finite (names the
///                vertex), an edge of three or more triangles or one whose triangles cannot agree
///                (names its vertices and triangles, as in the file)
void repair(SurfaceFrame& frame, const std::string& where, std::vector<std::string>& notes);

}  // namespace geoprior
