#pragma once

#include <string>
#include <string_view>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// PLY: ascii or binary of either byte order; velocities as vx vy vz or velocity_0 … velocity_2.
/// @param name  of the file, for messages
/// @throws Error  as `read_mesh_file`
MeshFile parse_ply(std::string_view bytes, const std::string& name);

}  // namespace geoprior
