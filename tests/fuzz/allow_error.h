#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"

namespace geoprior::test {

/// Runs a reader; Error is its way to refuse.
template <class Action>
void allow_error(Action action) {
  try {
    action();
  } catch (const Error&) {
  }
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace geoprior::test
