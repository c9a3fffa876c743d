#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior::assembly {

/// Whether a label is meant by a name: itself, or a beginning with a star ("pillar-*").
inline bool is_meant(std::string_view name, std::string_view label) {
  if (!name.empty() && name.back() == '*') {
    name.remove_suffix(1);
    return label.substr(0, name.size()) == name;
  }
  return name == label;
}

/// Whether a label is meant by one of the names.
inline bool is_among(const std::vector<std::string>& names, const std::string& label) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return is_meant(name, label); });
}

}  // namespace geoprior::assembly
