#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "models/paper/sheet/pattern.h"

namespace geoprior::paper {

/// What says how large a drawing is.
enum class SvgScale {
  guess,     ///< unit_m where it is given, else the page where it has a size in the world
  page,      ///< the page; a px of it is a 96th of an inch
  view_box,  ///< unit_m, whatever the page says
};

/// How a shape of an SVG drawing becomes a pattern.
struct SvgPatternOptions {
  std::optional<std::string> path;  ///< id of the shape or group; absent: the only one of the file
  SvgScale unit = SvgScale::guess;
  std::optional<double> unit_m;  ///< metres for one unit of the outermost viewBox; absent: 1 mm
  double tolerance = 1e-4;       ///< largest distance of a curve from its chords (m)
  bool centred = true;           ///< the middle of its box at the origin
};

/// Reads a pattern from a path, polygon, polyline, rect, circle or ellipse, from what a `use` or a
/// group draws, or from lines that touch: v points up where the drawing's y points down, so that
/// the sheet looks like the drawing, as its transforms place it.
///
/// Lines left open are closed, as filling does. Of several lines the one of the largest area is the
/// border, the others are holes in it. With fill-rule nonzero those of a filled shape that run the
/// same way round as what is around them leave it filled, and are left out. What a clip path of one
/// convex shape hides is cut off.
///
/// @param notes   added: what the file's reader left out, how large a unit was taken for, what was
///                joined, left out, clipped or not clipped
/// @return        that `require_simple` accepts
/// @throws Error  naming the scene's key, the file, line and shape: what read_svg_document refuses;
///                unit_m beside unit = "page"; no such shape, or several; what encloses nothing;
///                lines that do not close; a hole across the edge of a clip path; what
///                require_simple refuses, its holes numbered as the lines without the border
Pattern read_svg_pattern(const std::filesystem::path& file, const SvgPatternOptions& options,
                         std::vector<std::string>& notes);

}  // namespace geoprior::paper
