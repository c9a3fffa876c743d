#include "experiments/sketch/drawing_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "experiments/sketch/silhouette_loops.h"
#include "experiments/sketch/stroke_kinds.h"
#include "experiments/sketch/view_picture.h"
#include "testbed/formats/svg_document.h"
#include "testbed/formats/svg_units.h"
#include "testbed/formats/text_lines.h"

namespace geoprior::sketch {
namespace {

constexpr std::string_view kViewPrefix = "view:";
constexpr const char* kViewLayers = "layers view:front, view:side, view:top, view:photo";
constexpr std::array<ViewKind, 4> kViewKinds{ViewKind::front, ViewKind::side, ViewKind::top,
                                             ViewKind::photo};
constexpr double kSamePoint = 1e-9;  // m

/// "x 12.3 mm, y 4.5 mm".
std::string place_text(const Eigen::Vector2d& p) {
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "x %.4g mm, y %.4g mm", 1e3 * p.x(), 1e3 * p.y());
  return text.data();
}

const std::string kFromCorner = " (from the lower left corner of the page)";

/// Illustrator writes the ':' of an id as "_x3A_".
std::string view_layer_name(const SvgGroup& group) {
  std::string name = group.name();
  const std::size_t at = name.find("_x3A_");
  return at == std::string::npos ? name : name.replace(at, 5, ":");
}

/// A line of the file that has a meaning, before it is cleaned.
struct DrawnLine {
  Stroke stroke;
  std::string place;
};

/// Which group of the file is which view.
struct ViewGroups {
  std::map<int, ViewKind> kind_of_group;
  std::vector<ViewKind> shown;
};

class DrawingReader {
 public:
  DrawingReader(const SvgDocument& document, const std::filesystem::path& file,
                const DrawingFileOptions& options)
      : document_(document), file_(file), options_(options) {}

  DrawingFile read() {
    result_.drawing.name = document_.name;
    result_.warnings = document_.notes;
    result_.inputs.push_back(file_);
    find_views();
    std::map<ViewKind, std::vector<DrawnLine>> lines;
    for (const SvgShape& shape : document_.shapes) {
      const auto view = view_around(shape.group);
      if (view) {
        add_lines(shape, lines[*view]);
      } else {
        ++outside_;
      }
    }
    for (const ViewKind kind : views_.shown)
      result_.drawing.views.push_back(view_of(kind, std::move(lines[kind])));
    add_pictures();
    warn();
    return std::move(result_);
  }

 private:
  // Views.

  void find_views() {
    std::map<ViewKind, std::size_t> line_of;
    bool any_hidden = false;
    for (std::size_t g = 0; g < document_.groups.size(); ++g) {
      const SvgGroup& group = document_.groups[g];
      const std::string name = view_layer_name(group);
      if (!name.starts_with(kViewPrefix)) continue;
      const ViewKind kind = view_kind(name, group);
      any_hidden = any_hidden || group.hidden;
      if (group.hidden) {
        result_.warnings.push_back(place_of("layer", group.tags) + ": " + name +
                                   " is hidden, and not read");
        continue;
      }
      const auto [known, is_new] = line_of.emplace(kind, group.tags.line);
      if (!is_new) {
        throw Error(name + " is drawn twice, here and on line " + std::to_string(known->second),
                    place_of("layer", group.tags), "one layer for each view");
      }
      views_.kind_of_group.emplace(static_cast<int>(g), kind);
    }
    for (const ViewKind kind : kViewKinds) {
      if (line_of.count(kind) > 0) views_.shown.push_back(kind);
    }
    require_views(any_hidden);
  }

  [[nodiscard]] ViewKind view_kind(const std::string& name, const SvgGroup& group) const {
    for (const ViewKind kind : kViewKinds) {
      if (name.substr(kViewPrefix.size()) == view_name(kind)) return kind;
    }
    throw Error("unknown view '" + name.substr(0, 100) + "'", place_of("layer", group.tags),
                kViewLayers);
  }

  void require_views(bool any_hidden) const {
    const bool photo =
        std::find(views_.shown.begin(), views_.shown.end(), ViewKind::photo) != views_.shown.end();
    if (views_.shown.empty()) {
      throw Error(any_hidden ? "every view is hidden" : "has no view" + layers_text(),
                  document_.name, kViewLayers);
    }
    if (photo && views_.shown.size() > 1) {
      throw Error("has view:photo and other views", document_.name,
                  "view:photo alone, or two or three of view:front, view:side, view:top");
    }
    if (!photo && views_.shown.size() < 2) {
      throw Error("a second view is missing: there is only view:" +
                      std::string(view_name(views_.shown.front())),
                  document_.name,
                  "two or three of view:front, view:side, view:top, or view:photo alone");
    }
  }

  /// ": its layers are a, b".
  [[nodiscard]] std::string layers_text() const {
    std::string list;
    int count = 0;
    for (const SvgGroup& group : document_.groups) {
      constexpr int kMostNamed = 10;
      if (group.layer && ++count <= kMostNamed)
        list += (list.empty() ? "" : ", ") + group.name().substr(0, 50);
    }
    return list.empty() ? "" : ": its layers are " + list;
  }

  /// Of the innermost view around; absent outside of all.
  [[nodiscard]] std::optional<ViewKind> view_around(int group) const {
    for (; group >= 0; group = document_.groups[static_cast<std::size_t>(group)].parent) {
      const auto found = views_.kind_of_group.find(group);
      if (found != views_.kind_of_group.end()) return found->second;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string place_of(const std::string& element, const SvgTags& tags) const {
    return document_.place(element, tags);
  }

  // What a shape says of itself.

  /// Of the shape or the nearest group around it that says it.
  [[nodiscard]] std::string data_of(const SvgShape& shape, std::string_view key) const {
    const SvgTags* tags = &shape.tags;
    int group = shape.group;
    while (true) {
      const auto found = tags->data.find(key);
      if (found != tags->data.end()) return found->second;
      if (group < 0) return {};
      const SvgGroup& around = document_.groups[static_cast<std::size_t>(group)];
      tags = &around.tags;
      group = around.parent;
    }
  }

  /// The kind that data-kind or a class says, of the shape or the nearest group around it; nothing
  /// with `left_out` set for data-kind="none".
  [[nodiscard]] std::optional<StrokeKind> named_kind(const SvgShape& shape, bool& left_out) const {
    const SvgTags* tags = &shape.tags;
    int group = shape.group;
    while (true) {
      const auto found = tags->data.find("kind");
      if (found != tags->data.end()) {
        left_out = found->second == "none";
        if (left_out) return std::nullopt;
        if (const auto kind = kind_of_name(found->second)) return kind;
        throw Error("unknown kind '" + found->second.substr(0, 100) + "'",
                    place_of(shape.element, shape.tags) + ": data-kind",
                    stroke_kind_names() + ", none");
      }
      if (const auto kind = class_kind(*tags, shape)) return kind;
      if (group < 0) return std::nullopt;
      const SvgGroup& around = document_.groups[static_cast<std::size_t>(group)];
      tags = &around.tags;
      group = around.parent;
    }
  }

  [[nodiscard]] std::optional<StrokeKind> class_kind(const SvgTags& tags,
                                                     const SvgShape& shape) const {
    std::optional<StrokeKind> kind;
    for (const std::string& name : tags.classes) {
      const auto found = kind_of_name(name);
      if (kind && found && *kind != *found) {
        throw Error(
            "is of two kinds by its classes: " + std::string(row_of(*kind).name) + ", " + name,
            place_of(shape.element, shape.tags), "one of them");
      }
      if (found) kind = found;
    }
    return kind;
  }

  /// Absent for what is no stroke of the drawing.
  std::optional<StrokeKind> kind_of(const SvgShape& shape) {
    bool left_out = false;
    if (const auto kind = named_kind(shape, left_out)) return kind;
    if (left_out) return std::nullopt;
    if (!shape.stroked) {
      ++without_stroke_;
      return std::nullopt;
    }
    if (shape.stroke) {
      if (const auto kind = kind_of_colour(*shape.stroke, shape.dashed)) return kind;
    }
    throw Error("unknown kind of stroke: its colour is " +
                    (shape.stroke ? to_text(*shape.stroke) : std::string("no single one")) +
                    (shape.dashed ? ", dashed" : ""),
                place_of(shape.element, shape.tags),
                stroke_kind_colours() + "; or data-kind, none for a guide line");
  }

  // Lines.

  void add_lines(const SvgShape& shape, std::vector<DrawnLine>& lines) {
    const auto kind = kind_of(shape);
    if (!kind) return;
    const std::string place = place_of(shape.element, shape.tags);
    if (shape.lines.empty()) throw Error("has no length: it draws nothing", place, "a line");
    Stroke common = common_of(shape, *kind, place);
    for (std::size_t i = 0; i < shape.lines.size(); ++i) {
      DrawnLine line{common, place};
      if (shape.lines.size() > 1) {
        line.stroke.id += "/" + std::to_string(i + 1);
        line.place += ", part " + std::to_string(i + 1);
      }
      line.stroke.closed = shape.lines[i].closed;
      line.stroke.points = without_repetition(shape.lines[i], line.place);
      lines.push_back(std::move(line));
    }
  }

  [[nodiscard]] Stroke common_of(const SvgShape& shape, StrokeKind kind,
                                 const std::string& place) const {
    Stroke stroke;
    stroke.id = shape.tags.id.empty()
                    ? shape.element + "-on-line-" + std::to_string(shape.tags.line)
                    : shape.tags.id;
    stroke.kind = kind;
    stroke.name = name_of(shape, kind);
    const std::string depth = data_of(shape, "depth");
    if (!depth.empty() && depth != "front" && depth != "back")
      throw Error("unknown side '" + depth.substr(0, 100) + "'", place + ": data-depth",
                  "front, back");
    stroke.side = depth == "back" ? DepthSide::back : DepthSide::front;
    if (kind == StrokeKind::fold) {
      stroke.fold_angle_deg = fold_angle(data_of(shape, "fold-angle"), place);
      stroke.fold_width = fold_width(data_of(shape, "fold-width"), place);
    }
    return stroke;
  }

  /// Pairs and plane vectors are known by their names, whatever Inkscape calls the path.
  [[nodiscard]] std::string name_of(const SvgShape& shape, StrokeKind kind) const {
    const auto own = shape.tags.data.find("name");
    if (own != shape.tags.data.end()) return own->second;
    const bool named = kind == StrokeKind::symmetric_pair || kind == StrokeKind::plane_vector;
    const std::string panel = named ? std::string() : data_of(shape, "panel");
    if (!panel.empty()) return panel;
    return shape.tags.label.empty() && named ? shape.tags.id : shape.tags.label;
  }

  static std::optional<double> fold_angle(const std::string& text, const std::string& place) {
    if (text.empty()) return std::nullopt;
    const auto angle = finite_number(text);
    if (!angle || *angle < 0 || *angle > 90)
      throw Error("'" + text.substr(0, 100) + "' is no angle of a fold",
                  place + ": data-fold-angle", "0 to 90 (degrees)");
    return angle;
  }

  /// A number alone is in mm.
  static std::optional<double> fold_width(const std::string& text, const std::string& place) {
    if (text.empty()) return std::nullopt;
    const bool plain = finite_number(text).has_value();
    const std::string where = place + ": data-fold-width";
    const double width =
        plain ? 1e-3 * *finite_number(text) : kSvgPixel_m * parse_svg_length(text, 0, where).px;
    if (!(width > 0)) throw Error("the width of a fold is not positive", where, "5, 5mm, 0.5cm");
    return width;
  }

  static std::vector<Eigen::Vector2d> without_repetition(const SvgSubpath& line,
                                                         const std::string& place) {
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector2d& p : line.points) {
      if (points.empty() || (p - points.back()).norm() > kSamePoint) points.push_back(p);
    }
    while (line.closed && points.size() > 1 &&
           (points.front() - points.back()).norm() <= kSamePoint)
      points.pop_back();
    if (points.size() < 2) {
      throw Error("has no length: it is a point at " +
                      (points.empty() ? std::string("nowhere") : place_text(points.front())),
                  place, "a line");
    }
    if (points.size() > kMostStrokePoints) {
      throw Error("has " + std::to_string(points.size()) + " points", place,
                  "at most " + std::to_string(kMostStrokePoints) + ", by a coarser tolerance");
    }
    return points;
  }

  // A view.

  [[nodiscard]] View view_of(ViewKind kind, std::vector<DrawnLine> lines) const {
    View view;
    view.kind = kind;
    if (lines.empty())
      throw Error("view:" + std::string(view_name(kind)) + " has no strokes", document_.name,
                  "lines whose colour, class or data-kind says what they mean");
    const double snap = options_.snap * diagonal(lines);
    std::vector<DrawnLine> silhouettes;
    for (DrawnLine& line : lines) {
      clean(line, snap);
      if (line.stroke.kind == StrokeKind::silhouette && kind != ViewKind::photo) {
        silhouettes.push_back(std::move(line));
      } else {
        view.strokes.push_back(std::move(line.stroke));
      }
    }
    std::vector<Stroke> loops = closed_silhouettes(silhouettes, kind, snap);
    view.strokes.insert(view.strokes.begin(), std::make_move_iterator(loops.begin()),
                        std::make_move_iterator(loops.end()));
    require_plane_vectors(view);
    return view;
  }

  static double diagonal(const std::vector<DrawnLine>& lines) {
    Eigen::Vector2d low = lines.front().stroke.points.front(), high = low;
    for (const DrawnLine& line : lines) {
      for (const Eigen::Vector2d& p : line.stroke.points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    return (high - low).norm();
  }

  static void clean(DrawnLine& line, double snap) {
    Stroke& stroke = line.stroke;
    if (stroke.kind == StrokeKind::symmetric_pair || stroke.kind == StrokeKind::plane_vector) {
      if (stroke.points.size() != 2) {
        throw Error("is no straight line: a " + std::string(row_of(stroke.kind).name) + " has " +
                        "two ends, not " + std::to_string(stroke.points.size()) + " points",
                    line.place, "a line of two points");
      }
      stroke.closed = false;
      return;
    }
    if (stroke.closed && stroke.points.size() == 2) stroke.closed = false;
    if (stroke.closed || stroke.kind == StrokeKind::ruling || stroke.points.size() < 4) return;
    const double gap = (stroke.points.front() - stroke.points.back()).norm();
    // What is hardly longer than a gap is a short line, no loop.
    constexpr double kLoop = 10;
    if (gap > snap || length(stroke) < kLoop * snap) return;
    stroke.points.front() = (stroke.points.front() + stroke.points.back()) / 2;
    stroke.points.pop_back();
    stroke.closed = true;
  }

  [[nodiscard]] std::vector<Stroke> closed_silhouettes(const std::vector<DrawnLine>& lines,
                                                       ViewKind kind, double snap) const {
    std::vector<Stroke> strokes;
    for (const DrawnLine& line : lines) strokes.push_back(line.stroke);
    SilhouetteLoops joined = join_silhouettes(strokes, snap);
    const std::string where = document_.name + ": view:" + view_name(kind) + ": ";
    if (joined.gap) {
      const SilhouetteGap& gap = *joined.gap;
      const double width = (gap.end - gap.next).norm();
      throw Error("the silhouette is open: from the end of '" + gap.from + "' at " +
                      place_text(gap.end) + " the nearest end is that of '" + gap.to + "' at " +
                      place_text(gap.next) + ", a gap of " + millimetres(width) + kFromCorner,
                  place_of_stroke(lines, gap.from, where),
                  "a closed line, with gaps of at most " + millimetres(snap));
    }
    for (const Stroke& loop : joined.loops) {
      if (loop.points.size() < 3) {
        throw Error("the silhouette encloses nothing", place_of_stroke(lines, loop.id, where),
                    "an area");
      }
      if (const auto crossing = self_crossing(loop)) {
        throw Error("the silhouette crosses itself at " + place_text(*crossing) + kFromCorner,
                    place_of_stroke(lines, loop.id, where), "a simple closed line");
      }
    }
    return std::move(joined.loops);
  }

  static std::string millimetres(double metres) {
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%.3g mm", 1e3 * metres);
    return text.data();
  }

  /// Of the stroke, or the first that it was joined from.
  static std::string place_of_stroke(const std::vector<DrawnLine>& lines, const std::string& id,
                                     const std::string& otherwise) {
    for (const DrawnLine& line : lines) {
      if (line.stroke.id == id) return line.place;
    }
    return otherwise + "stroke '" + id + "'";
  }

  void require_plane_vectors(const View& view) const {
    std::map<std::string, std::string> id_of;
    for (const Stroke* stroke : strokes_of(view, StrokeKind::plane_vector)) {
      const std::string where = document_.name + ": plane-vector '" + stroke->id + "'";
      if (stroke->name != "sym-a" && stroke->name != "sym-b") {
        throw Error("a plane vector is named '" + stroke->name.substr(0, 100) + "'", where,
                    "sym-a, sym-b: by data-name, label or id");
      }
      const auto [first, is_new] = id_of.emplace(stroke->name, stroke->id);
      if (!is_new)
        throw Error(stroke->name + " is drawn twice, also by '" + first->second + "'", where,
                    "one sym-a and one sym-b");
    }
  }

  // Pictures and warnings.

  void add_pictures() {
    for (const SvgImage& image : document_.images) {
      const auto kind = view_around(image.group);
      if (!kind) continue;
      const auto view =
          std::find_if(result_.drawing.views.begin(), result_.drawing.views.end(),
                       [&](const View& candidate) { return candidate.kind == *kind; });
      const std::string place = place_of("image", image.tags);
      if (view->picture.size != Eigen::Vector2d::Zero()) {
        throw Error("a second picture of view:" + std::string(view_name(*kind)), place,
                    "one picture for each view");
      }
      view->picture = view_picture(image, place);
      if (!view->picture.file.empty()) result_.inputs.emplace_back(view->picture.file);
    }
  }

  void warn() {
    const auto add = [&](const std::string& text) {
      result_.warnings.push_back(document_.name + ": " + text);
    };
    if (outside_ > 0) add(std::to_string(outside_) + " shapes outside of the views are left out");
    if (without_stroke_ > 0) {
      add(std::to_string(without_stroke_) +
          " shapes of the views have no stroke, and are left out");
    }
    if (!document_.true_size && !options_.unit_m && views_.shown.front() != ViewKind::photo) {
      add("says its size in px, of which 96 are taken for an inch: give the page a size in mm, "
          "or unit_m");
    }
  }

  const SvgDocument& document_;
  const std::filesystem::path& file_;
  const DrawingFileOptions& options_;
  ViewGroups views_;
  DrawingFile result_;
  std::size_t outside_ = 0, without_stroke_ = 0;
};

}  // namespace

void describe(OptionVisitor& v, DrawingFileOptions& options) {
  constexpr double kSmallest = 1e-9;
  v.value("tolerance", options.tolerance,
          {.doc = "largest distance of a curve from its chords", .unit = "m", .min = kSmallest});
  v.value("unit_m", options.unit_m,
          {.doc = "metres for one unit of the drawing; absent: what the file says",
           .unit = "m",
           .min = kSmallest});
  v.value("snap", options.snap,
          {.doc = "largest gap of a line that is closed, over the diagonal of the view",
           .min = 0,
           .max = 0.1});
}

DrawingFile read_drawing(const std::filesystem::path& file, const DrawingFileOptions& options) {
  const SvgDocument document = read_svg_document(file, {options.tolerance, options.unit_m});
  return DrawingReader(document, file, options).read();
}

}  // namespace geoprior::sketch
