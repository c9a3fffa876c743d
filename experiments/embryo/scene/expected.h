#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "testbed/topic.h"

namespace geoprior::embryo {

/// What a disease is expected to change: structures that never exist, and those that are there, or
/// at other days, or otherwise.
struct ExpectedChanges {
  std::vector<std::string> absent, altered;  ///< local names, sorted
};

/// The lists of one disease of a file of tables, one a disease.
/// @throws Error  naming the file and key
ExpectedChanges read_expected_changes(const std::filesystem::path& file,
                                      const std::string& disease);

/// Keys of such a file, for `geoprior describe`.
TopicFile expected_keys();

}  // namespace geoprior::embryo
