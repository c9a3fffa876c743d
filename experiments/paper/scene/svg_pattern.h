#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "models/paper/sheet/pattern.h"

namespace geoprior::paper {

/// How a shape of an SVG drawing becomes a pattern.
struct SvgPatternOptions {
  std::optional<std::string> path;  ///< id of the shape; absent: the only one of the file
  double unit_m = 1e-3;             ///< metres for one unit of the outermost viewBox
  double tolerance = 1e-4;          ///< largest distance of a curve from its chords (m)
  bool centred = true;              ///< the middle of its box at the origin
};

/// Reads a pattern from a path, polygon, polyline, rect, circle or ellipse: v points up where the
/// drawing's y points down, so that the sheet looks like the drawing, as its transforms place it.
///
/// Lines left open are closed, as filling does. Of several subpaths the one of the largest area is
/// the border, the others are holes in it, whichever way they run (fill-rule evenodd).
///
/// @return        that `require_simple` accepts
/// @throws Error  naming the scene's key, the file, line and shape: what read_svg_document refuses;
///                no such shape, or several; what encloses nothing; what require_simple refuses,
///                its holes numbered as the subpaths without the border
Pattern read_svg_pattern(const std::filesystem::path& file, const SvgPatternOptions& options);

}  // namespace geoprior::paper
