#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/frame.h"

namespace geoprior {

/// Reads a part of a frame that another program wrote, by its extension: .vtp and .vti with all
/// their arrays; .ply of vertices and faces, further properties as arrays; of .obj, .glb and .gltf
/// the surface. In metres, along the axes of the scene: nothing is scaled or turned.
/// @param parameter  gets the TimeValue of a .vtp or .vti; else empty
/// @throws Error     naming the file
Part read_part_file(const std::filesystem::path& file, std::optional<double>& parameter);

/// Whether `read_part_file` knows it, ".vtp"; in small letters.
bool is_part_extension(std::string_view extension);
/// ".vtp, .vti, .ply, .obj, .glb, .gltf"
std::string part_extensions();

}  // namespace geoprior
