#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/method.h"
#include "models/sketch/sketch_process.h"
#include "solvers/sketch/layers/articulated_layers.h"

namespace geoprior::sketch {

/// Layers as solids at rest, and how they move: layer j turns by `angles[frame]` about its hinge
/// against layer j - 1.
struct LayerMotion {
  struct Link {
    std::string name;
    TriMesh solid;
    Eigen::Vector3d pivot{0, 0, 0};  ///< of its hinge; of the first layer, where it begins
    Eigen::Vector3d axis{1, 0, 0};
    std::vector<double> angles;  ///< rad, one a frame; of the first layer 0
  };
  std::vector<Link> links;
};

/// Files that are made of a result; none when empty.
struct LayerFiles {
  /// Of the flat pieces and the points of the surface that they count.
  std::function<std::vector<Artifact>(const Pattern&, const Eigen::MatrixX3d&)> pattern;
  std::function<std::vector<Artifact>(const LayerMotion&)> motion;
  /// Of what was chosen at every joint; with its limits.
  std::function<std::vector<Artifact>(const ArticulatedLayers&)> joints;
};

/// Articulated rigid layers from one view (thesis figure 2.14): `build_layers`, `set_joint_limits`,
/// `layer_pattern`. Frame 0 is the reconstruction at rest; then all joints move together to their
/// limits, first curling up, then stretching out, and back: share sin(2 pi i / poses) of the limit
/// of each way. The last frame is at rest again and has the pattern. Parts:
///
/// - "surface" (triangles): outer sides of the layers; point arrays "border", "seam", "fold" (no
///   seams and folds: 0), cell array "layer" (from 1);
/// - "solid" (triangles): the layers with their thickness, each closed; cell array "layer";
/// - "rims" (lines): front and rear rim of each layer, cell array "layer";
/// - "rivets" (points): both ends of each hinge's axis on each of its layers; point arrays "layer",
///   "hinge";
/// - "strokes" (lines), in frame 0: the drawn arcs on the layers; point arrays "stroke" (of the
///   view) and "drawn_at" (point of the stroke);
/// - "pattern", in the last frame, as `add_pattern`.
///
/// Diagnostics: "joint_share"; "curl" and "bend_back", sums of the limits (deg); "least_range", of
/// a joint, both ways; "overlap_least" and "overlap_most", of all joints, over the visible length
/// of the layer before; "room_least", angle for which the strip below has room (deg);
/// "arc_condition", the worst; "axis_residual" and "axis_residual_other", angles between the mirror
/// plane and the axis of the free ellipse, of the reading that was kept the largest, of the other
/// the least.
std::unique_ptr<Process> make_layers_process(const View& view, const LayerOptions& options,
                                             const PatternOptions& pattern,
                                             const LayerFiles& files);

}  // namespace geoprior::sketch
