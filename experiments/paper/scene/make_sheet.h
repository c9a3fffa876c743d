#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/paper/scene/sheet_options.h"
#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// The pattern that the options describe, with its holes and cuts.
/// @param folder  of the experiment file, against which a relative file is tried first
/// @param files   added: the file of an SVG pattern
/// @param notes   added: what was left out of it or assumed
/// @throws Error  naming the key, or file and place
Pattern make_pattern(const PatternOptions& options, const std::filesystem::path& folder,
                     std::vector<std::filesystem::path>& files, std::vector<std::string>& notes);

/// @param where   the key of the handle, for messages
/// @throws Error  naming the key
Handle make_handle(const HandleOptions& options, const std::string& where);

/// The obstacles of "scene.obstacles", in order.
/// @throws Error  naming the key
std::vector<Obstacle> make_obstacles(const std::vector<ObstacleOptions>& options);

/// @param seed  of the experiment
Toughness make_toughness(const ToughnessOptions& options, std::uint64_t seed);

}  // namespace geoprior::paper
