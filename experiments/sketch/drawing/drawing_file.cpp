#include "experiments/sketch/drawing/drawing_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/limits.h"
#include "experiments/sketch/drawing/drawn_stroke.h"
#include "experiments/sketch/drawing/silhouette_loops.h"
#include "experiments/sketch/drawing/stroke_kinds.h"
#include "experiments/sketch/drawing/view_layers.h"
#include "experiments/sketch/drawing/view_picture.h"
#include "experiments/sketch/hand/hand_drawn.h"
#include "testbed/formats/svg/document.h"

namespace geoprior::sketch {
namespace {

const std::string kFromCorner = " (from the lower left corner of the page)";

class DrawingReader {
 public:
  DrawingReader(const SvgDocument& document, const std::filesystem::path& file,
                const DrawingFileOptions& options)
      : document_(document), file_(file), options_(options) {}

  DrawingFile read() {
    result_.drawing.name = document_.name;
    result_.warnings = document_.notes;
    result_.inputs.push_back(file_);
    result_.page = {document_.width_m, document_.height_m};
    layers_ = find_view_layers(document_, result_.warnings);
    std::map<ViewKind, std::vector<DrawnStroke>> lines;
    for (const SvgShape& shape : document_.shapes) {
      const auto view = view_of_group(document_, layers_, shape.group);
      if (view) {
        add_strokes(shape, lines[*view]);
      } else {
        ++outside_;
      }
    }
    for (const ViewKind kind : layers_.kinds)
      result_.drawing.views.push_back(view_of(kind, std::move(lines[kind])));
    add_pictures();
    warn();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::string place_of(const std::string& element, const SvgTags& tags) const {
    return document_.place(element, tags);
  }

  // A view.

  void add_strokes(const SvgShape& shape, std::vector<DrawnStroke>& strokes) {
    if (const auto kind = kind_of_shape(document_, shape)) {
      for (DrawnStroke& stroke : strokes_of_shape(document_, shape, *kind))
        strokes.push_back(std::move(stroke));
      note_clips(shape);
    } else if (!shape.stroked) {
      ++without_stroke_;
    }
  }

  /// Of what hides a part of the shape.
  void note_clips(const SvgShape& shape) {
    for (const int clip : shape.clips) {
      if (!hides_part_of(document_.clips[clip], shape.lines)) continue;
      if (std::find(not_applied_.begin(), not_applied_.end(), clip) == not_applied_.end())
        not_applied_.push_back(clip);
    }
  }

  [[nodiscard]] View view_of(ViewKind kind, std::vector<DrawnStroke> lines) {
    View view;
    view.kind = kind;
    if (lines.empty())
      throw Error("view:" + std::string(view_name(kind)) + " has no strokes", document_.name,
                  "lines whose colour, class or data-kind says what they mean");
    require_count(static_cast<double>(lines.size()), "strokes", kMostViewStrokes,
                  document_.name + ": view:" + view_name(kind));
    const double size = diagonal(lines);
    if (options_.tremor) add_tremor(lines, size);
    HandDrawnView hand(document_.name + ": view:" + view_name(kind), size, options_.hand,
                       result_.warnings);
    std::vector<DrawnStroke> silhouettes;
    for (DrawnStroke& line : lines) {
      clean(line, std::min(kExactSnap, options_.hand.snap) * size);
      if (line.stroke.kind == StrokeKind::silhouette && kind != ViewKind::photo) {
        silhouettes.push_back(std::move(line));
      } else {
        view.strokes.push_back(std::move(line.stroke));
      }
    }
    std::vector<Stroke> loops = closed_silhouettes(silhouettes, kind, hand, size);
    for (Stroke& stroke : view.strokes) {
      if (!is_curve(stroke.kind)) continue;
      hand.fair(stroke);
      if (stroke.kind == StrokeKind::border && !stroke.inside && loops.size() == 1)
        hand.lay_on_silhouette(stroke, loops[0]);
    }
    view.strokes.insert(view.strokes.begin(), std::make_move_iterator(loops.begin()),
                        std::make_move_iterator(loops.end()));
    require_plane_vectors(view);
    return view;
  }

  /// Strokes that a hand draws as curves; others are straight lines, or fitted anyway.
  static bool is_curve(StrokeKind kind) {
    return kind == StrokeKind::silhouette || kind == StrokeKind::border ||
           kind == StrokeKind::seam || kind == StrokeKind::fold;
  }

  void add_tremor(std::vector<DrawnStroke>& lines, double size) const {
    for (DrawnStroke& line : lines) {
      if (is_curve(line.stroke.kind)) {
        line.stroke = with_tremor(line.stroke, size, *options_.tremor,
                                  static_cast<std::uint64_t>(options_.tremor->seed));
      }
    }
  }

  /// Whether all points lie on one line.
  static bool is_straight(const std::vector<Eigen::Vector2d>& points) {
    const Eigen::Vector2d from = points.front();
    const Eigen::Vector2d along =
        *std::max_element(points.begin(), points.end(),
                          [&](const auto& a, const auto& b) {
                            return (a - from).squaredNorm() < (b - from).squaredNorm();
                          }) -
        from;
    constexpr double kRounding = 1e-9;
    return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
      return std::abs(cross(along, p - from)) <= kRounding * along.squaredNorm();
    });
  }

  static double diagonal(const std::vector<DrawnStroke>& lines) {
    Eigen::Vector2d low = lines.front().stroke.points.front(), high = low;
    for (const DrawnStroke& line : lines) {
      for (const Eigen::Vector2d& p : line.stroke.points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    return (high - low).norm();
  }

  static void clean(DrawnStroke& line, double snap) {
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

  [[nodiscard]] std::vector<Stroke> closed_silhouettes(const std::vector<DrawnStroke>& lines,
                                                       ViewKind kind, HandDrawnView& hand,
                                                       double size) const {
    std::vector<Stroke> strokes;
    for (const DrawnStroke& line : lines) {
      if (line.stroke.closed && is_straight(line.stroke.points)) {
        throw Error("the silhouette is a straight line there and back, and encloses nothing",
                    line.place, "an area");
      }
      strokes.push_back(line.stroke);
    }
    SilhouetteLoops joined = hand.silhouettes(strokes);
    const std::string where = document_.name + ": view:" + view_name(kind) + ": ";
    if (joined.gap) {
      const SilhouetteGap& gap = *joined.gap;
      const double width = (gap.end - gap.next).norm();
      throw Error("the silhouette is open: from the end of '" + gap.from + "' at " +
                      place_text(gap.end) + " the nearest end is that of '" + gap.to + "' at " +
                      place_text(gap.next) + ", a gap of " + millimetres(width) + kFromCorner,
                  place_of_stroke(lines, gap.from, where),
                  "a closed line, with gaps of at most " + millimetres(options_.hand.snap * size) +
                      "; scene.read.snap allows wider ones");
    }
    for (const Stroke& loop : joined.loops) {
      if (loop.points.size() < 3) {
        throw Error("the silhouette encloses nothing", place_of_stroke(lines, loop.id, where),
                    "an area");
      }
      require_count(static_cast<double>(loop.points.size()), "points of a silhouette",
                    kMostStrokePoints, place_of_stroke(lines, loop.id, where));
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

  /// Of the stroke; of one that was joined, what its parts are called.
  static std::string place_of_stroke(const std::vector<DrawnStroke>& lines, const std::string& id,
                                     const std::string& otherwise) {
    for (const DrawnStroke& line : lines) {
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
      const auto kind = view_of_group(document_, layers_, image.group);
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

  /// ", some in layers 'a', 'b', whose names are no view's".
  static std::string in_layers(const std::vector<std::string>& names) {
    std::string list;
    constexpr std::size_t kMost = 10;
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
      list += (list.empty() ? "" : ", ") + names[i];
    return list.empty() ? "" : "; layers of no view: " + list;
  }

  template <class Add>
  void warn_of_clips(const Add& add) const {
    constexpr std::size_t kMost = 20;
    for (std::size_t i = 0; i < std::min(not_applied_.size(), kMost); ++i) {
      add(document_.clips[not_applied_[i]].name +
          " is not applied: what it hides is a stroke as well");
    }
    if (not_applied_.size() > kMost)
      add(std::to_string(not_applied_.size() - kMost) + " more clips are not applied");
  }

  void warn() {
    const auto add = [&](const std::string& text) {
      result_.warnings.push_back(document_.name + ": " + text);
    };
    warn_of_clips(add);
    if (outside_ > 0) {
      add(std::to_string(outside_) + " shapes outside of the views are left out" +
          in_layers(layers_.unread));
    }
    if (without_stroke_ > 0) {
      add(std::to_string(without_stroke_) +
          " shapes of the views have no stroke, and are left out");
    }
    if (!document_.true_size && !options_.unit_m && layers_.kinds.front() != ViewKind::photo) {
      add("says its size in px, of which 96 are taken for an inch: give the page a size in mm, "
          "or unit_m");
    }
  }

  const SvgDocument& document_;
  const std::filesystem::path& file_;
  const DrawingFileOptions& options_;
  ViewLayers layers_;
  DrawingFile result_;
  std::size_t outside_ = 0, without_stroke_ = 0;
  std::vector<int> not_applied_;  ///< clips that hide parts of strokes
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
  v.value(
      "snap", options.hand.snap,
      {.doc = "largest gap of a silhouette that is closed, and distance of a line that was drawn "
              "twice, over the diagonal of the view",
       .min = 0,
       .max = 0.1});
  v.value("fairing", options.hand.fairing,
          {.doc = "whether the tremor of a hand is taken off strokes"});
  v.value("noise", options.hand.noise,
          {.doc = "largest standard deviation of a tremor that is taken off, over the diagonal of "
                  "the view",
           .min = 0,
           .max = 0.1});
  describe_group(
      v, "tremor", options.tremor,
      {.doc = "tremor that is added to the drawing's curves; the drawing as it is in the "
              "file is what silhouettes are measured against"});
}

DrawingFile read_drawing(const std::filesystem::path& file, const DrawingFileOptions& options) {
  const SvgDocument document = read_svg_document(file, {options.tolerance, options.unit_m});
  return DrawingReader(document, file, options).read();
}

}  // namespace geoprior::sketch
