#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/sketch/hand/hand_drawn.h"
#include "experiments/sketch/hand/tremor.h"
#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// How a drawing becomes strokes in metres.
struct DrawingFileOptions {
  double tolerance = 1e-4;
  std::optional<double> unit_m;
  HandDrawnOptions hand;
  std::optional<TremorOptions> tremor;
};
void describe(OptionVisitor& v, DrawingFileOptions& options);

/// A drawing as it was read.
struct DrawingFile {
  Drawing drawing;
  std::vector<std::string> warnings;          ///< what was left out or assumed
  std::vector<std::filesystem::path> inputs;  ///< the file, and the pictures beside it
  Eigen::Vector2d page{0, 0};                 ///< its size (m); 0 where the file does not say it
};

/// Most strokes of a view.
inline constexpr int kMostViewStrokes = 5000;

/// Reads the annotated views of one object from an SVG file.
///
/// A view is a group named view:front, view:side, view:top or view:photo (its Inkscape label, else
/// its id): photo alone, or two or three of the others. What a line in it means says `data-kind`,
/// else its class, else that of a group around it, else its colour (stroke_kinds.h). Coordinates
/// are those of the page: metres from its lower left corner, y up; views are not yet aligned.
///
/// - Points that coincide with the one before are left out; lines that end near their start are
///   closed (not pairs, plane vectors and rulings).
/// - Silhouettes of orthogonal views are joined from open strokes, are closed, simple and
///   counter-clockwise. What was drawn by hand is put right, with a warning that says what was
///   moved by how much (`HandDrawnView`): gaps, double lines, tremor, borders beside the
///   silhouette. In a photo a silhouette is a ruling and stays as it was drawn.
/// - Pairs and plane vectors are two points.
/// - A picture (PNG, JPEG; beside the file or embedded) has the place where it is seen.
///
/// @throws Error  naming file, line and element: what read_svg_document refuses; no view, one view
///                too few, drawn twice, unknown or empty; an unknown kind or attribute value; a
///                stroke without length; a silhouette with a gap or a crossing (names the places);
///                a picture that is missing, unreadable or turned
DrawingFile read_drawing(const std::filesystem::path& file, const DrawingFileOptions& options);

}  // namespace geoprior::sketch
