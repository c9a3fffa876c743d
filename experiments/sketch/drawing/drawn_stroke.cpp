#include "experiments/sketch/drawing/drawn_stroke.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <utility>

#include "core/error.h"
#include "experiments/sketch/drawing/stroke_kinds.h"
#include "testbed/formats/svg/units.h"
#include "testbed/formats/text/lines.h"

namespace geoprior::sketch {
namespace {

constexpr double kSamePoint = 1e-9;  // m

/// As much of a text of the file as an error quotes.
std::string quoted_value(const std::string& text) {
  constexpr std::size_t kMostQuoted = 100;
  return "'" + text.substr(0, kMostQuoted) + "'";
}

/// A shape, and what it and the groups around it say.
class TaggedShape {
 public:
  TaggedShape(const SvgDocument& document, const SvgShape& shape)
      : document_(document), shape_(shape) {}

  [[nodiscard]] std::string place() const { return document_.place(shape_.element, shape_.tags); }

  /// Calls `look` with the tags of the shape, then of the groups around it, until it returns true.
  void look_outwards(const std::function<bool(const SvgTags&)>& look) const {
    if (look(shape_.tags)) return;
    for (int group = shape_.group; group >= 0;) {
      const SvgGroup& around = document_.groups[group];
      if (look(around.tags)) return;
      group = around.parent;
    }
  }

  /// Of the shape or the nearest group around it that says it; empty when none does.
  [[nodiscard]] std::string data(std::string_view key) const {
    std::string value;
    look_outwards([&](const SvgTags& tags) {
      const auto found = tags.data.find(key);
      if (found != tags.data.end()) value = found->second;
      return found != tags.data.end();
    });
    return value;
  }

  /// Name of the innermost layer, a view's own aside, where the shape is alone in it; else empty.
  [[nodiscard]] std::string own_layer() const {
    if (shape_.layer.empty() || shape_.layer.starts_with("view:")) return {};
    const auto same = [&](const SvgShape& other) { return other.layer == shape_.layer; };
    return std::count_if(document_.shapes.begin(), document_.shapes.end(), same) == 1
               ? shape_.layer
               : std::string();
  }

  /// Of data-kind or a class. `said` tells "none" from nothing.
  [[nodiscard]] std::optional<StrokeKind> kind(bool& said) const {
    std::optional<StrokeKind> kind;
    look_outwards([&](const SvgTags& tags) {
      const auto found = tags.data.find("kind");
      said = found != tags.data.end();
      kind = said ? kind_of_data(found->second) : kind_of_class(tags);
      said = said || kind;
      return said;
    });
    return kind;
  }

 private:
  [[nodiscard]] std::optional<StrokeKind> kind_of_data(const std::string& name) const {
    const auto kind = kind_of_name(name);
    if (kind || name == "none") return kind;
    throw Error("unknown kind " + quoted_value(name), place() + ": data-kind",
                stroke_kind_names() + ", none");
  }

  [[nodiscard]] std::optional<StrokeKind> kind_of_class(const SvgTags& tags) const {
    std::optional<StrokeKind> kind;
    for (const std::string& name : tags.classes) {
      const auto found = kind_of_name(name);
      if (kind && found && *kind != *found) {
        throw Error(
            "is of two kinds by its classes: " + std::string(row_of(*kind).name) + ", " + name,
            place(), "one of them");
      }
      if (found) kind = found;
    }
    return kind;
  }

  const SvgDocument& document_;
  const SvgShape& shape_;
};

/// Pairs and plane vectors are known by their names, others belong to a panel.
std::string stroke_name(const TaggedShape& tagged, const SvgTags& tags, StrokeKind kind) {
  const auto own = tags.data.find("name");
  if (own != tags.data.end()) return own->second;
  const bool named = kind == StrokeKind::symmetric_pair || kind == StrokeKind::plane_vector;
  const std::string panel = named ? std::string() : tagged.data("panel");
  if (!panel.empty()) return panel;
  if (!tags.label.empty()) return tags.label;
  return named ? tags.id : kind == StrokeKind::arc ? tagged.own_layer() : std::string();
}

DepthSide depth_side(const std::string& text, const std::string& place) {
  if (text.empty() || text == "front") return DepthSide::front;
  if (text == "back") return DepthSide::back;
  if (text == "both") return DepthSide::both;
  throw Error("unknown side " + quoted_value(text), place + ": data-depth", "front, back, both");
}

std::optional<double> written_fold_angle(const std::string& text, const std::string& place) {
  if (text.empty()) return std::nullopt;
  const auto angle = finite_number(text);
  if (!angle || *angle < 0 || *angle > 90) {
    throw Error(quoted_value(text) + " is no angle of a fold", place + ": data-fold-angle",
                "0 to 90 (degrees)");
  }
  return angle;
}

/// A number alone is in mm.
std::optional<double> written_fold_width(const std::string& text, const std::string& place) {
  if (text.empty()) return std::nullopt;
  const std::string where = place + ": data-fold-width";
  const auto plain = finite_number(text);
  const double width = plain ? 1e-3 * *plain : kSvgPixel_m * parse_svg_length(text, 0, where).px;
  if (!(width > 0)) throw Error("the width of a fold is not positive", where, "5, 5mm, 0.5cm");
  return width;
}

std::optional<FoldSide> written_fold_side(const std::string& text, const std::string& place) {
  if (text.empty()) return std::nullopt;
  if (text == "left") return FoldSide::left;
  if (text == "right") return FoldSide::right;
  throw Error("unknown side " + quoted_value(text), place + ": data-fold-side", "left, right");
}

bool written_border_inside(const std::string& text, const std::string& place) {
  if (text.empty() || text == "silhouette") return false;
  if (text == "inside") return true;
  throw Error("unknown place " + quoted_value(text), place + ": data-border", "silhouette, inside");
}

/// What all lines of a shape have in common.
Stroke common_stroke(const TaggedShape& tagged, const SvgShape& shape, StrokeKind kind) {
  const std::string place = tagged.place();
  Stroke stroke;
  stroke.id = shape.tags.id;
  if (stroke.id.empty()) stroke.id = shape.element + "-on-line-" + std::to_string(shape.tags.line);
  stroke.kind = kind;
  stroke.name = stroke_name(tagged, shape.tags, kind);
  stroke.side = depth_side(tagged.data("depth"), place);
  if (kind == StrokeKind::border)
    stroke.inside = written_border_inside(tagged.data("border"), place);
  if (kind == StrokeKind::symmetric_pair) stroke.panels = tagged.data("panel");
  if (kind == StrokeKind::fold) {
    stroke.fold_angle_deg = written_fold_angle(tagged.data("fold-angle"), place);
    stroke.fold_width = written_fold_width(tagged.data("fold-width"), place);
    stroke.fold_side = written_fold_side(tagged.data("fold-side"), place);
  }
  return stroke;
}

std::vector<Eigen::Vector2d> without_repetition(const SvgSubpath& line, const std::string& place) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2d& p : line.points) {
    if (points.empty() || (p - points.back()).norm() > kSamePoint) points.push_back(p);
  }
  while (line.closed && points.size() > 1 && (points.front() - points.back()).norm() <= kSamePoint)
    points.pop_back();
  if (points.size() < 2) {
    throw Error("has no length: it is a point at " + place_text(line.points.front()), place,
                "a line");
  }
  if (points.size() > kMostStrokePoints) {
    throw Error("has " + std::to_string(points.size()) + " points", place,
                "at most " + std::to_string(kMostStrokePoints) + ", by a coarser tolerance");
  }
  return points;
}

}  // namespace

std::string place_text(const Eigen::Vector2d& point) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "x %.4g mm, y %.4g mm", 1e3 * point.x(), 1e3 * point.y());
  return text.data();
}

std::optional<StrokeKind> kind_of_shape(const SvgDocument& document, const SvgShape& shape) {
  const TaggedShape tagged(document, shape);
  bool said = false;
  const auto kind = tagged.kind(said);
  if (said || !shape.stroked) return kind;
  if (shape.stroke) {
    if (const auto by_colour = kind_of_colour(*shape.stroke, shape.dashed)) return by_colour;
  }
  throw Error("unknown kind of stroke: its colour is " +
                  (shape.stroke ? to_text(*shape.stroke) : std::string("no single one")) +
                  (shape.dashed ? ", dashed" : ""),
              tagged.place(), stroke_kind_colours() + "; or data-kind, none for a guide line");
}

std::vector<DrawnStroke> strokes_of_shape(const SvgDocument& document, const SvgShape& shape,
                                          StrokeKind kind) {
  const TaggedShape tagged(document, shape);
  if (shape.lines.empty()) throw Error("has no length: it draws nothing", tagged.place(), "a line");
  const Stroke common = common_stroke(tagged, shape, kind);
  std::vector<DrawnStroke> strokes;
  for (std::size_t i = 0; i < shape.lines.size(); ++i) {
    DrawnStroke drawn{common, tagged.place()};
    if (shape.lines.size() > 1) {
      drawn.stroke.id += "/" + std::to_string(i + 1);
      drawn.place += ", part " + std::to_string(i + 1);
    }
    drawn.stroke.closed = shape.lines[i].closed;
    drawn.stroke.points = without_repetition(shape.lines[i], drawn.place);
    strokes.push_back(std::move(drawn));
  }
  return strokes;
}

}  // namespace geoprior::sketch
