#pragma once

#include <cstddef>
#include <string>

namespace geoprior {

/// "1 frame", "3 frames".
inline std::string frames_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " frame" : " frames");
}

}  // namespace geoprior
