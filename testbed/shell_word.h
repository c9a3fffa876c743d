#pragma once

#include <string>
#include <vector>

namespace geoprior {

/// A word as a shell reads it back: in quotes unless it is plain, with nothing that a terminal
/// would obey.
std::string shell_word(const std::string& word);

/// Words of a command line, each as `shell_word`.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace geoprior
