#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/sketch/drawing/stroke.h"
#include "testbed/formats/svg/document.h"

namespace geoprior::sketch {

/// Most points of one stroke.
inline constexpr std::size_t kMostStrokePoints = 20000;

/// A line of a drawing that has a meaning.
struct DrawnStroke {
  Stroke stroke;
  std::string place;  ///< "boot.svg:12: path 'seam-3'", for errors
};

/// "x 12.3 mm, y 4.5 mm".
std::string place_text(const Eigen::Vector2d& point);

/// What a shape of a drawing means: `data-kind`, else its class, else the same of the nearest group
/// around it, else its colour. Absent for a guide line (data-kind="none") and for what has no
/// stroke.
/// @throws Error  naming the shape: an unknown kind, colour, or two kinds
std::optional<StrokeKind> kind_of_shape(const SvgDocument& document, const SvgShape& shape);

/// The lines of a shape, without points that repeat, with the attributes of the shape or the
/// nearest group around it.
/// @throws Error  naming the shape: an attribute's value, a line without length or with more than
///                kMostStrokePoints
std::vector<DrawnStroke> strokes_of_shape(const SvgDocument& document, const SvgShape& shape,
                                          StrokeKind kind);

}  // namespace geoprior::sketch
