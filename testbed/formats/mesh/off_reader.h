#pragma once

#include <string>
#include <string_view>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// OFF: with or without colours, normals and texture of the vertices, ascii. Each vertex and each
/// face on a line of its own, where what follows is passed over; else any line breaks, and then the
/// head says how many numbers a vertex has. Counts may be glued to the head (ModelNet).
/// @param name  of the file, for messages
/// @throws Error  as `read_mesh_file`
MeshFile parse_off(std::string_view bytes, const std::string& name);

}  // namespace geoprior
