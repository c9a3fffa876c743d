#pragma once

#include <string>
#include <string_view>

#include "core/frame.h"
#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// PLY: ascii or binary of either byte order; elements `face` and `tristrips`; velocities as vx vy
/// vz or velocity_0 … velocity_2. Other elements are left out and noted, other properties skipped.
/// @param name  of the file, for messages
/// @throws Error  as `read_mesh_file`
MeshFile parse_ply(std::string_view bytes, const std::string& name);

/// The same as a part of a frame: also of edges (`vertex1`, `vertex2`; each a line) or a cloud of
/// points, and with the further properties that are numbers as arrays, those of faces where all of
/// them are triangles. Properties `name_0`, `name_1` … that follow each other are one array.
/// @throws Error  also for strips, and for faces and edges together
Part parse_ply_part(std::string_view bytes, const std::string& name);

}  // namespace geoprior
