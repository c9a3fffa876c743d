#include "testbed/formats/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace geoprior::gltf {
namespace {

constexpr std::array<std::string_view, 13> kLookPrefixes{
    "KHR_materials_", "KHR_texture_",     "KHR_lights_",    "KHR_xmp",     "KHR_technique",
    "KHR_audio",      "EXT_materials_",   "EXT_texture_",   "EXT_lights_", "MSFT_texture_",
    "MSFT_packing_",  "ADOBE_materials_", "VRMC_materials_"};

constexpr std::array<std::string_view, 8> kNames{
    "KHR_mesh_quantization", "KHR_node_visibility",
    "FB_ngon_encoding",      "CESIUM_primitive_outline",
    "EXT_mesh_features",     "EXT_structural_metadata",
    "EXT_instance_features", "MSFT_lod"};

}  // namespace

bool is_read_without(const std::string& name) {
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() ||
         std::any_of(kLookPrefixes.begin(), kLookPrefixes.end(),
                     [&](std::string_view prefix) { return name.starts_with(prefix); });
}

std::string way_out_of_extension(const std::string& name) {
  if (name == "KHR_draco_mesh_compression") {
    return "a file without compression: \"gltf-transform cp in.glb out.glb\" unpacks it, or "
           "Blender "
           "imports it and exports it with Compression off";
  }
  if (name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression")
    return "a file without compression: \"gltf-transform cp in.glb out.glb\" unpacks it";
  if (name == "EXT_mesh_gpu_instancing") {
    return "copies as nodes of their own: Blender imports them so and exports the file without the "
           "extension";
  }
  return "files without required extensions, or with those that only say how the surface looks "
         "(KHR_materials_…, KHR_texture_…, KHR_lights_…, KHR_xmp…, EXT_texture_…, MSFT_texture_… "
         "and their like), KHR_mesh_quantization, FB_ngon_encoding; a program such as Blender "
         "imports the file and exports it without";
}

std::string loss_without_extension(const std::string& name) {
  if (name == "EXT_mesh_gpu_instancing") return "its copies are left out";
  if (name == "KHR_animation_pointer") return "what it animates stands still";
  return {};
}

}  // namespace geoprior::gltf
