#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/assembly/files/gltf_scene.h"
#include "experiments/assembly/files/read_result.h"

namespace geoprior::assembly {

/// A scene of parts, and what is needed to write others with its meshes and materials.
struct GltfParts {
  ReadAssemblies read;  ///< one model, named after the file; its parts in the order of their nodes
  GltfScene scene;
};

/// Reads the scene that a glTF 2.0 file (.glb or .gltf) shows as an assembly. No extension of glTF
/// is needed: parts are told by names and by empties, as any modelling program exports them.
///
/// - A port is a node without mesh, camera or light ("empty") whose name is "port", in letters of
///   any case, and then no letter: "port.in", "Port_0", "port". Its name is what follows, without a
///   number that Blender appends to copies (".001") and without leading dots, dashes and
///   underscores; "port" when nothing follows. Ports of one name become "in", "in-2" and on.
/// - The part of a port is the nearest node above it that has a mesh or holds one below, not
///   counting meshes of other parts. Its label is its name without such a number. Parts may hang
///   below one another; each has the meshes from its node down to the next part. Its ports are
///   ordered by name.
/// - Axes: the port's arrow (of Blender's empty "Single Arrow") is the local +Z axis of Blender,
///   which its exporter, with "+Y Up" as it is by default, turns into the local +Y axis of the
///   node: out of the part. Up is Blender's local +Y axis, the node's local -Z. So the port's frame
///   (x out, y, z up) is (+Y, +X, -Z) of the node. The world is turned back to z up
///   (`z_up_of_gltf`).
/// - A part's coordinates are those of its node without scale. The scale, which may differ from
///   axis to axis, belongs to the kind of part; a mirroring or shearing transform is refused.
/// - Nodes of one label have one scale and the same ports: to 1e-4 of the size of the scene (the
///   diagonal of the box around its parts) and to 0.1 degrees. The first one's meshes are used; a
///   warning says where another one's differ.
/// - Ports of two parts are joined when they are within 5 mm and within 0.5 % of the size of the
///   scene of each other, and their arrows are opposed to within 10 degrees. Their up axes must
///   agree to within 20 degrees. Arrows that touch and are not opposed, or opposed ones within five
///   times that distance, are not joined: a warning, where one of the two stays open.
/// - A part's mesh has the triangles of all its meshes, morph targets added by their default
///   weights; its boxes are those around each primitive, along the part's axes. It has no ways and
///   no symmetries (`find_symmetries`).
///
/// What belongs to no part (ground, lamps) is left out, with a warning for meshes.
///
/// @throws Error  naming file and node: what `read_gltf` refuses (a required compression, with the
///                way out), no parts, a part without name, a port below no part, nodes of one label
///                that differ, mirrored or sheared parts, three ports at one place, joined ports
///                whose roll differs, two parts at one place; images as in `gather_gltf`
GltfParts read_gltf_parts(const std::filesystem::path& file);

/// `read_gltf_parts` for the bytes of a self-contained file; `name` is for messages and the model.
GltfParts read_gltf_parts_bytes(const std::vector<std::byte>& bytes,
                                const std::filesystem::path& name);

inline std::string assembly_glb(const GltfParts& parts, const Assembly& assembly) {
  return assembly_glb(parts.scene, assembly);
}

}  // namespace geoprior::assembly
