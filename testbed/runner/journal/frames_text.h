#pragma once

#include <cstddef>
#include <string>

namespace geoprior {

/// "1 frame", "3 frames".
inline std::string frames_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " frame" : " frames");
}

/// How a variant ended that failed: "failed after 3 frames: …", "cannot run: …" where it has none.
inline std::string failure_text(std::size_t frames, const std::string& error) {
  return (frames == 0 ? "cannot run: " : "failed after " + frames_text(frames) + ": ") + error;
}

}  // namespace geoprior
