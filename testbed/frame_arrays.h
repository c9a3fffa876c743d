#pragma once

#include <string>

#include "core/frame.h"

namespace geoprior {

/// The array of that name; null when the part has none.
inline const NamedArray* find_array(const Part& part, const std::string& name) {
  for (const NamedArray& array : part.arrays) {
    if (array.name == name) return &array;
  }
  return nullptr;
}

}  // namespace geoprior
