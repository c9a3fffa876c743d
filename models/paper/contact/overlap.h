#pragma once

#include <Eigen/Core>
#include <array>

namespace geoprior::paper {

using PlaneTriangle = std::array<Eigen::Vector2d, 3>;

/// Area that two counter-clockwise triangles share (m^2).
double overlap_area(const PlaneTriangle& a, const PlaneTriangle& b);

}  // namespace geoprior::paper
