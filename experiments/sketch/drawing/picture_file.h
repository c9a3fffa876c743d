#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/photo/pixel_image.h"

namespace geoprior::sketch {

/// Pixels of the picture of a view: its file, or the bytes that the drawing holds.
///
/// Grey pictures become colours; what is transparent is blended over white.
/// @throws Error  naming the file: none in the drawing, missing, no picture, or larger than
///                kMostPicturePixels
PixelImage read_picture(const Picture& picture);

/// Most pixels of a picture that is read.
inline constexpr long long kMostPicturePixels = 100'000'000;

/// A PNG file with the same bytes for the same pixels.
/// @param dots_per_metre  that programs print it by; 0: not said
std::string png_bytes(const PixelImage& image, double dots_per_metre = 0);

}  // namespace geoprior::sketch
