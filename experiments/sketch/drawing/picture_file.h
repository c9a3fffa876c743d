#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/photo/pixel_image.h"

namespace geoprior::sketch {

/// Pixels of the picture of a view: its file, or the bytes that the drawing holds.
///
/// Grey pictures become colours; what is transparent is blended over white.
/// @throws Error  naming the file: none in the drawing, missing, no picture, or of more bytes than
///                kMostPictureBytes
PixelImage read_picture(const Picture& picture);

/// Most bytes that the pixels of a picture take when it is read: its channels and our three. The
/// largest cameras (61 million pixels in colour) need 370 MB.
inline constexpr double kMostPictureBytes = 5e8;

/// Refuses a picture that takes more, before anything is decoded.
/// @param size      pixels
/// @param channels  1 to 4; of a picture that is not opened yet 3
/// @throws Error    at `where`
void require_picture_size(const Eigen::Vector2i& size, int channels, const std::string& where);

/// A PNG file with the same bytes for the same pixels.
/// @param dots_per_metre  that programs print it by; 0: not said
std::string png_bytes(const PixelImage& image, double dots_per_metre = 0);

}  // namespace geoprior::sketch
