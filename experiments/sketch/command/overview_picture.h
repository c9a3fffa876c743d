#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/photo/pixel_image.h"
#include "testbed/view/figure/picture.h"

namespace geoprior::sketch {

/// What a picture of a finished sketch shows.
struct Overview {
  std::string title;
  std::string subtitle;
  Drawing drawing;
  std::optional<PixelImage> photo;  ///< of the one view; lies pale under its strokes
  Part surface;
  std::optional<Part> strokes;  ///< on the surface; coloured by a cell array "kind" (StrokeKind)
  std::optional<Part> pattern;  ///< with cell arrays "piece" and "stretch" (logarithm)
  std::vector<std::string> pieces;  ///< written on them, by their numbers
};

/// One row in plain words: the drawing, the surface with its lines, and the flat pieces coloured by
/// how much the cloth must give to become the surface: red longer, blue shorter, full colours at 5
/// percent. Needs a Display.
geoprior::Picture draw_overview(const Overview& overview);

}  // namespace geoprior::sketch
