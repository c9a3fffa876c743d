#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace geoprior::sketch {

using PixelColour = std::array<std::uint8_t, 3>;  ///< red, green, blue of sRGB

/// A picture of opaque pixels, the upper row first.
struct PixelImage {
  int width = 0;
  int height = 0;
  std::vector<PixelColour> pixels;

  [[nodiscard]] PixelColour& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * width + x];
  }
  [[nodiscard]] const PixelColour& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * width + x];
  }
};

}  // namespace geoprior::sketch
