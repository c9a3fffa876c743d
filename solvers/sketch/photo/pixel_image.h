#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace geoprior::sketch {

using PixelColour = std::array<std::uint8_t, 3>;  ///< red, green, blue of sRGB

/// Of red, green and blue from 0 to 255; what is beyond is put to the end of the range.
inline PixelColour rounded_colour(const Eigen::Vector3d& c) {
  PixelColour colour{};
  for (int k = 0; k < 3; ++k)
    colour[k] = static_cast<std::uint8_t>(std::lround(std::clamp(c(k), 0.0, 255.0)));
  return colour;
}

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
