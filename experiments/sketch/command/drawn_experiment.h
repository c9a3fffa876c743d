#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// What a drawing is of, by what is drawn in it.
enum class DrawnKind {
  several_views,  ///< layers view:front, view:side, view:top, two or three of them
  one_view,       ///< view:photo with borders
  layers,         ///< view:photo with arcs: rigid layers
};

/// @throws Error  when the one view has neither borders nor arcs, naming the drawing
DrawnKind drawn_kind(const Drawing& drawing);

/// For people: "several views (front, side, top)", "one view", "rigid layers".
std::string drawn_kind_text(const Drawing& drawing);

/// What an experiment about a drawing says.
struct DrawnExperiment {
  std::string title;
  std::string command;  ///< that wrote it
  std::string drawing;  ///< as the file names it
  std::string photo;    ///< likewise; empty: the drawing's own picture, if any
  DrawnKind kind = DrawnKind::several_views;
  bool textured = false;  ///< the photograph's colours are carried over
  bool force = false;     ///< pieces are written to be cut although they are refused
  /// Of one view: within which share of the drawing's diagonal ends of borders are joined; absent:
  /// the method's.
  std::optional<double> snap = {};
};

/// The method's variant in the experiment.
inline constexpr const char* kDrawnVariant = "drawn";

/// The experiment as a file that its reader goes on with: what else may be set stands in comments.
std::string experiment_text(const DrawnExperiment& experiment);

/// How a file in `folder` names another one: relative where that lies in it or beside it, else
/// absolute. Both must exist.
std::string path_from(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace geoprior::sketch
