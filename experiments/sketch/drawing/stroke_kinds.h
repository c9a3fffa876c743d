#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "models/sketch/drawing/stroke.h"
#include "testbed/formats/svg/color.h"
#include "testbed/topic.h"

namespace geoprior::sketch {

/// How a kind of stroke is written in a drawing.
struct StrokeKindRow {
  StrokeKind kind;
  std::string_view name;           ///< of `data-kind` and of classes: "symmetric-pair"
  std::string_view colour;         ///< in words: "green"
  std::vector<SvgColour> colours;  ///< of the stroke, where neither attribute nor class says it
  bool dashed = false;             ///< only dashed lines of these colours
  std::string_view meaning;        ///< one line
};

/// Every kind of stroke, in the order of the enumerators.
std::span<const StrokeKindRow> stroke_kinds();

const StrokeKindRow& row_of(StrokeKind kind);

/// Absent when there is no such name.
std::optional<StrokeKind> kind_of_name(std::string_view name);

/// The kind that has a colour within 48 of 255 in red, green and blue: nobody picks #ff0000 from a
/// palette. Absent when none has, or when the line is not dashed where that is needed.
std::optional<StrokeKind> kind_of_colour(const SvgColour& colour, bool dashed);

/// "silhouette, border, …".
std::string stroke_kind_names();
/// "silhouette black, border blue, …".
std::string stroke_kind_colours();

/// The file format, for `geoprior describe`.
TopicFile drawing_keys();
/// Its strokes alone: what a kind is called and coloured.
TopicFile stroke_keys();

}  // namespace geoprior::sketch
