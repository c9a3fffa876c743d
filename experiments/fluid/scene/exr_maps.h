#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/frame.h"
#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

/// The maps of a differential feature as OpenEXR pictures, one a frame: float32 channels R, G, B
/// (displacement along x, y, z of the moving frame, m) and A (alpha, not multiplied into the
/// others), first row at v = +extent/2 as pictures have it. Named `<stem>_0000.exr` …
///
/// The header carries what a picture cannot: extent, cell, time and placement, so that
/// `read_exr_maps` gives the feature back. The same feature gives the same bytes.
/// @throws Error  for an isolated feature
std::vector<Artifact> exr_maps(const Feature& feature, const std::string& stem);

/// Reads the pictures of a feature, in order of time; bit for bit what was written.
/// @throws Error  naming the file: unreadable, other channels, another size than the first, header
///                entries missing
Feature read_exr_maps(const std::vector<std::filesystem::path>& files);

}  // namespace geoprior::fluid
