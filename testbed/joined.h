#pragma once

#include <string>
#include <string_view>

namespace geoprior {

/// "a, b, c".
template <class Names>
std::string joined(const Names& names, std::string_view between = ", ") {
  std::string text;
  for (const auto& name : names) {
    if (!text.empty()) text += between;
    text += name;
  }
  return text;
}

}  // namespace geoprior
