#pragma once

#include "models/torus/input.h"

namespace geoprior::torus {

/// The torus of revolution, of which a point is
///   1/(2 pi) ((r2 + r1 cos 2 pi x) cos 2 pi y, (r2 + r1 cos 2 pi x) sin 2 pi y, r1 sin 2 pi x).
Eigen::Vector3d revolution_point(const Radii& radii, const Eigen::Vector2d& at);

/// Its unit normal, outwards.
Eigen::Vector3d revolution_normal(const Eigen::Vector2d& at);

}  // namespace geoprior::torus
