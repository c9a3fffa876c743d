#pragma once

#include <string>
#include <string_view>

namespace geoprior {

/// A message that may quote a file, as one line for a terminal: control characters (which could
/// move its cursor, or more) as \n, \t or \x1b, and of a very long text the beginning and the end.
std::string message_line(std::string_view text);

}  // namespace geoprior
