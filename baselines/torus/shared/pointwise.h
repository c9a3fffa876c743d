#pragma once

#include <functional>
#include <memory>

#include "models/torus/map.h"

namespace geoprior::torus {

/// A point of a torus at a parameter; called from several threads.
using TorusPoint = std::function<Eigen::Vector3d(const Eigen::Vector2d& at)>;

/// A map that is the same after any number of corrugations, point by point.
std::unique_ptr<TorusMap> make_pointwise_map(TorusPoint point);

}  // namespace geoprior::torus
