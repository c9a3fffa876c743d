#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "models/paper/pattern.h"

namespace geoprior::paper {

/// How a path of an SVG drawing becomes a pattern.
struct SvgPatternOptions {
  std::optional<std::string> path;  ///< id; absent: the only path of the file
  double unit_m = 1e-3;             ///< metres for one user unit
  double tolerance = 1e-4;          ///< largest distance of a curve from its chords (m)
  bool centred = true;              ///< the middle of its box at the origin
};

/// Reads a pattern: v points up where the drawing's y points down, so that the sheet looks like the
/// drawing; counter-clockwise.
/// @throws Error  naming the scene's key, the file and the path: no such path, several, a
/// `transform` on the path or
///                around it, malformed XML or path data
Pattern read_svg_pattern(const std::filesystem::path& file, const SvgPatternOptions& options);

}  // namespace geoprior::paper
