#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/fluid/edits.h"

namespace geoprior::fluid {

/// An edit list is a TOML file of [[edit]] tables with the keys of `Edit`:
///
///     [[edit]]
///     name   = "wake, twice as long"
///     source = "boat"
///     ids    = [3]
///     move   = [4, 0, 0]
///     scale  = [2, 1, 1]
///
/// @throws Error  naming file, line and key, and what is allowed
std::vector<Edit> read_edit_list(const std::filesystem::path& file);
std::vector<Edit> parse_edit_list(std::string_view text, const std::string& name);

}  // namespace geoprior::fluid
