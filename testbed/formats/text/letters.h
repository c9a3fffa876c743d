#pragma once

#include <string>
#include <string_view>

namespace geoprior {

/// Of the letters of ASCII; all other characters stay.
inline char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

inline std::string lower(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = lower(c);
  return small;
}

}  // namespace geoprior
