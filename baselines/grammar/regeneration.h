#pragma once

#include <Eigen/Core>
#include <functional>

#include "models/grammar/hierarchy/hierarchy.h"
#include "models/grammar/maps/spatial_map.h"

namespace geoprior::grammar {

/// x -> position + turn about z by `yaw` of (stretch * (x - root)), `root` the root's position.
struct StretchFit {
  Eigen::Vector3d position{0, 0, 0};  ///< of the root (m)
  double yaw = 0;                     ///< rad
  Eigen::Vector3d stretch{1, 1, 1};   ///< 0.2 … 5 each
};

/// The least squares fit of a stretch, a yaw and a shift to where the map takes the key points of
/// all elements that are present, each element of weight 1.
///
/// Closed form. With centred keys (x, y) and targets (u, v), and sums over them, the stretches of
/// a given yaw t are a(t) / sum xx and b(t) / sum yy, where a = cos t sum xu + sin t sum xv and
/// b = cos t sum yv - sin t sum yu; what they explain, aa / sum xx + bb / sum yy, is a quadratic
/// form of (cos t, sin t), largest along its first eigenvector.
/// @throws Error  when no element has a key point
StretchFit fit_stretch(const Hierarchy& rest, const SpatialMap& map);

/// Regeneration of a procedural object from its parameters: it is generated with the fitted
/// stretch and placed by the fitted position and yaw. All that its procedure keeps holds; what a
/// user edited is lost, and a local gesture is smeared over the whole.
///
/// @param generate  the object with its sizes along x, y, z stretched, about its root
Hierarchy regenerate(const Hierarchy& rest,
                     const std::function<Hierarchy(const Eigen::Vector3d& stretch)>& generate,
                     const SpatialMap& map);

}  // namespace geoprior::grammar
