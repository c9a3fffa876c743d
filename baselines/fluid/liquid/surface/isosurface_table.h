#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace geoprior::fluid {

/// An edge of a cube: it starts at `corner` (bits 1, 2, 4: upper on x, y, z) and runs along `axis`.
struct CubeEdge {
  std::int8_t corner = 0;
  std::int8_t axis = 0;
};

/// Triangles of a cube for each of the 256 sets of inside corners (bit c: corner c is inside),
/// three edges each, counter-clockwise seen from outside.
///
/// Made by rule, not typed in: on every face of the cube each run of inside corners is cut off by
/// one segment, which depends on the face's corners alone, so that two cubes agree about the face
/// they share. The segments close to loops; a loop is triangulated without a diagonal that lies in
/// a face, where the neighbour could draw the same one. Every crossed edge belongs to one loop.
/// Together the result over any grid is a closed 2-manifold.
struct CubeTable {
  std::array<std::vector<CubeEdge>, 256> edges;  ///< a multiple of three
};
const CubeTable& cube_table();

}  // namespace geoprior::fluid
