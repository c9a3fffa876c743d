#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/assembly/files/read_result.h"
#include "experiments/assembly/scene/options.h"

namespace geoprior::assembly {

/// Reads files of assemblies into one catalogue, by their extension. Parts of files of ours and of
/// glTF scenes that have one label are one kind, and must have the same ports. Symmetries that a
/// file does not give are found.
/// @throws Error  naming file and place
ReadAssemblies read_assemblies(const std::vector<std::filesystem::path>& files);

/// Connected pieces of models, drawn: a model, a part, a size, then neighbour by neighbour.
std::vector<Assembly> cut_pieces(const std::vector<Assembly>& models, const PiecesOptions& options,
                                 std::uint64_t seed);

}  // namespace geoprior::assembly
