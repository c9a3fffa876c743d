#pragma once

#include <string>
#include <string_view>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// OBJ: `v` and `f`; corners `v/vt/vn` share the position, negative indices count from the end.
/// @param name  of the file, for messages
/// @throws Error  as `read_mesh_file`
MeshFile parse_obj(std::string_view bytes, const std::string& name);

}  // namespace geoprior
