#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

/// A library of features: one HDF5 file (docs/file-formats.md), read with h5py as well.
///
/// Maps are stored as float32 in chunks of one frame, meshes concatenated with offsets. What is
/// written is read back bit for bit.
/// @throws Error  for features that are inconsistent (names the feature and what does not fit) or
///                ids that appear twice
std::vector<std::byte> feature_library_bytes(const std::vector<Feature>& features);

/// @throws Error  naming file and place: no HDF5 file, another schema, missing or misshapen data,
///                NaN, times that do not increase, indices out of range
std::vector<Feature> read_feature_library(const std::filesystem::path& file);

/// Checks what both of the above check. `where` names file or method.
void require_valid(const Feature& feature, const std::string& where);
void require_valid(const std::vector<Feature>& features, const std::string& where);

}  // namespace geoprior::fluid
