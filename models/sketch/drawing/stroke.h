#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace geoprior::sketch {

/// What a stroke of a drawing means. Thesis 2.1.2: silhouette, border, seam, fold; 2.1.3: symmetric
/// pair, plane vector, occlusion, ruling, and the arcs of articulated layers.
enum class StrokeKind {
  silhouette,      ///< outline of the shape in its view
  border,          ///< edge of an open surface
  seam,            ///< where two panels are sewn together
  fold,            ///< contour of a fold
  symmetric_pair,  ///< from a point to its mirror image
  plane_vector,    ///< image of a vector of the mirror plane's basis
  occlusion,       ///< part of a curve that something hides
  ruling,          ///< straight silhouette of a developable patch
  arc,             ///< circular edge of a rigid layer
};

/// On which sides of the hull a stroke that is drawn inside the silhouette lies.
enum class DepthSide { front, back, both };

/// To which side of its contour, along the stroke, the surface of a fold falls away from the eye.
enum class FoldSide { left, right };

/// One stroke, flattened to chords.
struct Stroke {
  std::string id;  ///< of the drawing's element, for errors; made up where it has none
  StrokeKind kind = StrokeKind::silhouette;
  bool closed = false;                        ///< the last point is joined to the first
  std::vector<Eigen::Vector2d> points = {};   ///< in the view: right, up (m)
  DepthSide side = DepthSide::front;          ///< of seams, folds and borders inside the silhouette
  bool inside = false;                        ///< of a border: a slit or hole, see `open_inside`
  std::string name = {};                      ///< of a pair, a panel or a layer ("pair-3")
  std::optional<double> fold_angle_deg = {};  ///< between normal and view direction; the method's
  std::optional<double> fold_width = {};      ///< m; the method's when absent
  std::optional<FoldSide> fold_side = {};     ///< the one of the shorter turn when absent
  std::string panels = {};  ///< of a pair: panels of the border it lies on ("roof + gable"), or any
};

/// Length of the stroke (m).
double length(const Stroke& stroke);

}  // namespace geoprior::sketch
