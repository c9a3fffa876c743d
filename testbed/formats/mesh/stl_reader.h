#pragma once

#include <string>
#include <string_view>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// STL: ascii, or binary (little endian). Each triangle has corners of its own in the file; those
/// of equal position become one vertex, and triangles of which two corners do are left out. The
/// order of the corners says what is outside, the normals are not read.
/// @param name  of the file, for messages
/// @throws Error  as `read_mesh_file`
MeshFile parse_stl(std::string_view bytes, const std::string& name);

}  // namespace geoprior
