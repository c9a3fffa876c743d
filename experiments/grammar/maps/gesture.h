#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/maps/strokes.h"
#include "models/grammar/maps/tools.h"

namespace geoprior::grammar {

/// The deformation of space when a fraction of the gesture is done: the identity at 0, all of it at
/// 1. Continuous in the fraction.
/// @param fraction  0 … 1
/// @throws Error  naming the stroke: no path, a radius that is not positive, a number that is not
///                finite; a lattice whose counts differ; a cage that is not closed
std::shared_ptr<const SpatialMap> map_of(const Gesture& gesture, double fraction);

/// The dabs of the strokes, in order, when a fraction of the gesture is done: its map but for its
/// lattice and its cage. @throws Error  as `map_of`, of the strokes
std::vector<Dab> dabs_of(const Gesture& gesture, double fraction);

/// Lines that show the gesture: the paths of the tools, each with a circle where its effect is
/// half of that in its middle.
struct DrawnGesture {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> lines;
};
DrawnGesture drawn(const Gesture& gesture);

/// Random strokes on what is in a box: one grab, inflation, twist or bend, of a radius and an
/// amount in proportion to the box's diagonal. `number` counts gestures of one seed.
Gesture random_gesture(std::uint64_t seed, int number, const Eigen::AlignedBox3d& box);

}  // namespace geoprior::grammar
