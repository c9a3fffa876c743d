#pragma once

#include <string>

namespace geoprior::gltf {

/// Whether positions, skins and motion of a file that requires this extension are right for a
/// reader that does not know it: it only says how the surface looks or sounds, who made it, or how
/// numbers are stored in a way that is read (KHR_mesh_quantization). Told by kind: all of
/// KHR_materials_…, KHR_texture_… and their like, and a list.
bool is_read_without(const std::string& name);

/// What is allowed instead of a required extension that is not read; of compression and instancing,
/// which program converts the file.
std::string way_out_of_extension(const std::string& name);

/// What a file loses when the extension that it merely uses is left out; empty: nothing that is
/// measured.
std::string loss_without_extension(const std::string& name);

}  // namespace geoprior::gltf
