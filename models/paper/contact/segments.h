#pragma once

#include <Eigen/Core>
#include <optional>

namespace geoprior::paper {

/// Distance of a point from a closed segment (same unit as the input).
double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b);

/// Parameter t > `beyond` at which origin + t direction meets the closed segment a b; absent when
/// it does not, or when the two are parallel.
std::optional<double> ray_hit(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                              const Eigen::Vector2d& a, const Eigen::Vector2d& b, double beyond);

/// Angle between two lines (not rays), 0 … pi/2 (rad).
double line_angle(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// Angle between two rays, 0 … pi (rad).
double ray_angle(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

/// The direction turned by +90 degrees.
inline Eigen::Vector2d perpendicular(const Eigen::Vector2d& d) { return {-d.y(), d.x()}; }

}  // namespace geoprior::paper
