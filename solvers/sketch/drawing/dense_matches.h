#pragma once

#include <vector>

#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/drawing/symmetric_pairs.h"

namespace geoprior::sketch {

/// A node of a border and the place of its mirror image on a border.
struct DenseMatch {
  int node = -1;
  CurvePoint image;
};

/// Symmetric correspondences between drawn pairs (thesis 2.1.3, first step).
///
/// In the picture all pairs are parallel to n_xy, so that a point and its image have the same
/// coordinate u across n_xy. Between two neighbouring pairs on the same two borders, each node of
/// the first border goes to the place with the same u on the second, with u running the same way,
/// in monotone order; a closed border that is its own image has pairs in both senses. Beyond the
/// outermost pairs of open borders matches go on to where one of the two ends: the image of what
/// hangs together hangs together. So does what goes both ways from a single point of the plane on a
/// border that is its own image (it runs along n_xy there); neither where the pairs miss the
/// normal's direction by more than 4 % of their length, since u is wrong then. Nodes where the
/// border runs within `steep_deg` of n_xy are left out: u is stationary there and noise decides the
/// place; so are stretches that run along n_xy as a whole, as a door's sill does.
///
/// @param half_width  nodes on either side for tangents
/// @throws Error      when the order of pairs along the two borders differs (names two pairs)
std::vector<DenseMatch> dense_matches(const CurveNet& net, const std::vector<SymmetricPair>& pairs,
                                      const MirrorPlane& plane, int half_width,
                                      double steep_deg = 20);

}  // namespace geoprior::sketch
