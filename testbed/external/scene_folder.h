#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/frame.h"
#include "testbed/topic.h"

namespace geoprior {

/// Writes what a program from outside is given into a folder (docs/external-methods.md):
///
///     scene.json                       options, parameters, and what the other files are
///     scene/<part>.vtp, .vti, .glb     geometry of `Scene::given`, whole; surfaces for viewers too
///     scene/<part>.points.npy          … and each array of it by itself, in double precision
///     scene/<table>.csv, <table>.npy
///     inputs/<n>-<name>                copies of the scene's files
///     reference/                       frames of the variant that this one names as reference, in
///                                      the layout (frame_layout.h)
///     out/                             empty: where the program writes
///
/// scene.json keeps to docs/scene.schema.json.
/// @throws Error  naming the file that cannot be written or read
void write_scene_folder(const std::filesystem::path& folder, const MethodSite& site,
                        const Scene& scene);

/// A two-dimensional array of doubles (`<f8`) or integers (`<i4`), in C order, as NumPy reads it.
std::string npy_text(const Eigen::MatrixXd& rows);
std::string npy_text(const Eigen::MatrixXi& rows);

}  // namespace geoprior
