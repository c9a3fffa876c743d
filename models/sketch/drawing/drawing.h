#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "models/sketch/drawing/stroke.h"

namespace geoprior::sketch {

/// From where a view is drawn. The object stands on y up, looks along +z, and its left is +x.
enum class ViewKind {
  front,  ///< seen from +z: right = x, up = y
  side,   ///< seen from +x: right = -z, up = y
  top,    ///< seen from +y: right = x, up = -z
  photo,  ///< one view, seen from +z: right = x, up = y, depth unknown
};

/// A bitmap that a view was traced from.
struct Picture {
  std::string file;              ///< path of it; empty: none, or embedded
  std::string content;           ///< bytes of an embedded one (PNG, JPEG)
  Eigen::Vector2d origin{0, 0};  ///< lower left corner in the view (m)
  Eigen::Vector2d size{0, 0};    ///< in the view (m)
};

struct View {
  ViewKind kind = ViewKind::front;
  std::vector<Stroke> strokes;
  Picture picture = {};
};

/// All that was drawn of one model.
struct Drawing {
  std::string name;         ///< of the file, for errors
  std::vector<View> views;  ///< one a kind

  /// Null when it was not drawn.
  [[nodiscard]] const View* find(ViewKind kind) const;
};

/// Orthonormal frame of a view: rows are the directions in space of right, up and towards the eye.
Eigen::Matrix3d view_frame(ViewKind kind);

/// Axis of space along which a coordinate of a view runs.
struct ViewAxis {
  int axis = 0;     ///< 0, 1, 2: x, y, z
  double sign = 1;  ///< 1 or -1: its direction
};
/// @param frame       of `view_frame`
/// @param coordinate  0: right, 1: up
ViewAxis view_axis(const Eigen::Matrix3d& frame, int coordinate);

/// Name as it is written in drawings: "front", …
const char* view_name(ViewKind kind);

/// The strokes of a view that are of one kind, in their order.
std::vector<const Stroke*> strokes_of(const View& view, StrokeKind kind);

/// Panels of a one-view drawing in a text: "roof + gable" are two.
std::vector<std::string> panels_in(const std::string& text);
/// Whether borders of these panels can meet on the object: they bound one in common, or one of them
/// names none.
bool may_meet(const std::vector<std::string>& panels, const std::vector<std::string>& others);
/// Whether a border of these panels bounds the named one.
bool bounds(const std::vector<std::string>& panels, const std::string& name);
/// A panel whose name begins with "flat" is plane.
bool is_named_flat(const std::string& panel);
/// Whether a stroke of one view is a ruling of a panel: drawn as one, or as a silhouette.
bool is_ruling(const Stroke& stroke);
/// Those of all borders, in the order in which they are first named.
std::vector<std::string> panels_of(const View& view);

}  // namespace geoprior::sketch
