#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

namespace geoprior {

/// The map that an attribute `transform` writes: matrix, translate, scale, rotate, skewX and skewY,
/// the last of a list applied to a point first. Angles in degrees; an empty text is the identity.
/// @throws Error  naming `where` and the character
/// Source: SVG 1.1 (W3C 2011), section 7.6.
Eigen::Affine2d parse_svg_transform(std::string_view text, const std::string& where);

/// The factor by which the map lengthens most: what is within a distance d of a line is within
/// `largest_stretch(map)` d of its image.
double largest_stretch(const Eigen::Affine2d& map);

}  // namespace geoprior
