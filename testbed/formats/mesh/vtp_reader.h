#pragma once

#include <filesystem>
#include <vector>

#include "testbed/formats/mesh/parsed_mesh.h"

namespace geoprior {

/// VTP: polygons and strips; velocities as the point array `velocity`, coordinates of a pattern as
/// `pattern`. What else it has is left out and noted. @throws Error  as `read_mesh_file`
MeshFile read_vtp(const std::filesystem::path& file);

/// PVTP: the pieces that it names, one surface (`joined`). Their ghost cells are left out.
/// @throws Error  as `read_mesh_file`
MeshFile read_pvtp(const std::filesystem::path& file);

/// Surfaces one after the other, as one. Velocities, and coordinates of the pattern, that one of
/// them lacks are left out and noted.
MeshFile joined(std::vector<MeshFile> parts);

}  // namespace geoprior
