#pragma once

#include <string>
#include <string_view>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// OBJ: `v` and `f`; corners `v/vt/vn` share the position, negative indices count from the end. A
/// line that ends in `\` goes on in the next one; a comment ends with its line. Points, lines and
/// free-form surfaces are left out and noted, and so are words that OBJ does not know.
/// @param name  of the file, for messages
/// @throws Error  as `read_mesh_file`
MeshFile parse_obj(std::string_view bytes, const std::string& name);

}  // namespace geoprior
