#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "solvers/sketch/photo/pixel_image.h"

namespace geoprior::sketch {

/// Colours of a region of a picture, continued beyond it along the lines that reach its border.
///
/// Pixels are filled in the order of their distance from the region. Each gets the nearest colour
/// along the line through it along which the picture changes least: the minor axis of the structure
/// tensor of the region's brightness about it, the farther from the region the wider. Where no
/// direction stands out of noise, or the line meets nothing nearer to the region within eight
/// pixels, as one beside the border that runs along it, it is the mean of what is around. So lines
/// go straight on, where the colours of the nearest pixels would bend them to meet the border
/// squarely. Nothing is invented: what ends within the region stays away. Colours of equal
/// brightness have no lines.
///
/// @param region  pixels whose colours count, row by row as in the picture
/// @param fill    pixels to be filled, none of the region
/// @param reach   largest distance from the region, along chains of them (pixels)
/// @return        a colour a pixel of `fill`; negative beyond reach
/// Source: after Bornemann and März 2007, *Fast image inpainting based on coherence transport*,
/// whose weighted mean along the line became a place between four pixels.
std::vector<Eigen::Vector3d> continued_colours(const PixelImage& picture,
                                               std::span<const std::size_t> region,
                                               std::span<const std::size_t> fill, double reach);

}  // namespace geoprior::sketch
