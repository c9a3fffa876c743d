#pragma once

#include <cstdint>

#include "core/options.h"
#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// Pebbles that keep apart in a body.
struct VolumeSetOptions {
  enum class Shape { ball, bar };
  Shape shape = Shape::ball;
  double width = 2, depth = 2, height = 2;  ///< of the body, along x, y, z (m)
  double spacing = 0.2;                     ///< least distance of pebbles of full size (m)
};
void describe(OptionVisitor& v, VolumeSetOptions& options);

/// Numbers of the parameters of a "grain".
struct GrainParameter {
  static constexpr int kSize = 0;       ///< 0 … 1
  static constexpr int kRadius = 1;     ///< half the spacing (m)
  static constexpr int kCandidate = 2;  ///< 1: there only where there is room
};

/// A body of pebbles about the origin at rest: all of size 1, none of the candidates is there,
/// distances are at least the spacing.
///
/// Types "volume-set", the root, whose key point is its position, and "grain", with the parameters
/// above and its centre as key point. Children of the root in order of priority.
/// @throws Error  naming the option: out of its range
Hierarchy make_volume_set(const VolumeSetOptions& options, std::uint64_t seed);

}  // namespace geoprior::grammar
