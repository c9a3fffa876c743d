#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "core/mesh.h"
#include "core/options.h"
#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// Conifers on flat ground: a set of as many elements as one likes.
struct ForestOptions {
  int elements = 1000;
  double distance = 3;  ///< mean distance of neighbours; least one where they keep apart (m)
  bool apart = false;   ///< whether they keep apart
  double aspect = 1;
};
void describe(OptionVisitor& v, ForestOptions& options);

/// Numbers of the parameters of a "conifer".
struct ConiferParameter {
  static constexpr int kSize = 0;    ///< 0 … 1
  static constexpr int kRadius = 1;  ///< half the distance that it keeps (m)
  static constexpr int kHeight = 2;  ///< at full size (m)
  static constexpr int kCandidate = 3;
};
/// The parameter of a "forest": the distance that its elements keep (m); 0: they do not.
inline constexpr int kForestSpacing = 0;

/// The turn about z that is nearest to a matrix, after a turn: by atan2(m10 - m01, m00 + m11).
Eigen::Quaterniond upright_turn(const Eigen::Matrix3d& m, const Eigen::Quaterniond& turn);

/// A conifer of a height and a radius of its lowest branches (m): foot at the origin, upright.
TriMesh conifer_mesh(double height, double radius);

/// A forest about the origin, on the ground z = 0, at rest.
///
/// Types "forest", the root, which has the parameter spacing and no key points, and "conifer",
/// with the parameters above, upright; key points: foot, top. Where they keep apart, the number of
/// elements is met within some percent, and candidates are among them, which are not there at rest;
/// else each is at random in a square cell of its own.
/// @throws Error  naming the option: out of its range
Hierarchy make_forest(const ForestOptions& options, std::uint64_t seed);

}  // namespace geoprior::grammar
