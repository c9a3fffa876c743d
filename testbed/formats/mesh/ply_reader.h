#pragma once

#include <string>
#include <string_view>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// PLY: ascii or binary of either byte order; elements `face` and `tristrips`; velocities as vx vy
/// vz or velocity_0 … velocity_2. Other elements are left out and noted, other properties skipped.
/// @param name  of the file, for messages
/// @throws Error  as `read_mesh_file`
MeshFile parse_ply(std::string_view bytes, const std::string& name);

}  // namespace geoprior
