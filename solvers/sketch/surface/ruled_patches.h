#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/surface/ruling_warp.h"

namespace geoprior::sketch {

/// A ruling of a patch: from a node of its first border to a place on its second.
struct SketchRuling {
  int node = -1;      ///< number of the node on the first border (counted on around a closed one)
  double at = 0;      ///< place on the second border (counted on around a closed one)
  bool held = false;  ///< drawn, or between ends of borders: at nodes, not sought
};

/// A patch that rulings sweep between two borders.
struct RuledPatch {
  std::string id;       ///< stroke of its first drawn ruling
  int first = -1;       ///< curve
  int second = -1;      ///< curve
  int second_way = 1;   ///< +1 when the numbers of the second border rise with those of the first
  bool around = false;  ///< a band that closes on itself
  /// In the order of the first border; one a node.
  std::vector<SketchRuling> rulings;
  /// Pairs of nodes (numbers on both borders) that edges join, from one end to the other in steps
  /// of one on either border or both.
  std::vector<std::array<int, 2>> cells;
};

/// Patches from drawn rulings. The rule:
///
/// 1. A stroke of kind `ruling` or `silhouette` is straight and its ends lie on two different
///    borders: of the panel that it names when two or more borders name it too, else any. It is a
///    ruling of the patch between these two.
/// 2. Drawn rulings between the same two borders belong to one patch; between neighbours the other
///    rulings are found by time warping, with both ends known.
/// 3. Beyond the first and the last, the warping goes on to the ends of the borders: to both when
///    both are open; round to the start when both are closed; when one is closed, until the open
///    one ends. Borders are open at corners and at the junctions that strokes end in.
/// 4. The patch reaches over the mirror plane; the surface is cut there when it is made symmetric.
///
/// @param half_width  nodes on either side for tangents
/// @throws Error      on a ruling that is bent, ends on no border, or ends on one border twice
///                    (names the stroke)
std::vector<RuledPatch> sweep_ruled_patches(const View& view, const CurveNet& net, int half_width,
                                            const RulingWarpOptions& options);

}  // namespace geoprior::sketch
