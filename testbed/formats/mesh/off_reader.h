#pragma once

#include <string>
#include <string_view>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// OFF: with or without colours and normals of the vertices, ascii.
/// @param name  of the file, for messages
/// @throws Error  as `read_mesh_file`
MeshFile parse_off(std::string_view bytes, const std::string& name);

}  // namespace geoprior
