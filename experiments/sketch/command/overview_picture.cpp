#include "experiments/sketch/command/overview_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/geometry/topology.h"
#include "experiments/sketch/drawing/stroke_kinds.h"
#include "models/sketch/drawing/drawing_part.h"
#include "testbed/view/figure/colors.h"
#include "testbed/view/figure/legend.h"
#include "testbed/view/panel/panel.h"
#include "testbed/view/view_window.h"

namespace geoprior::sketch {
namespace {

/// Of pixels; `Picture` is that of a view here.
using Canvas = geoprior::Picture;

constexpr int kWide = 2400, kSide = 40, kApart = 40;
constexpr int kPanelTop = 210, kPanelHigh = 900, kFoot = 170;
constexpr int kPanelWide = (kWide - 2 * kSide - 2 * kApart) / 3;
const TextStyle kTitleStyle{46, {20, 20, 20}, true, false};
const TextStyle kSubtitleStyle{28, {90, 90, 90}, false, false};
const TextStyle kPanelStyle{32, {20, 20, 20}, true, false};
const TextStyle kPieceStyle{24, {20, 20, 20}, false, false};

/// As kinds are drawn (stroke_kinds.h), dark enough for lines on white and on a surface.
constexpr std::array<std::array<double, 3>, 9> kStrokeColours{{{0.10, 0.10, 0.10},
                                                               {0.08, 0.25, 0.85},
                                                               {0.85, 0.10, 0.10},
                                                               {0.05, 0.50, 0.15},
                                                               {0.80, 0.10, 0.75},
                                                               {0.95, 0.50, 0.05},
                                                               {0.55, 0.55, 0.55},
                                                               {0.00, 0.60, 0.65},
                                                               {0.50, 0.05, 0.50}}};

/// Lines of one kind.
struct KindLines {
  StrokeKind kind;
  Part part;
};

/// Lines without an array "kind" are borders.
std::vector<KindLines> lines_by_kind(const Part& lines) {
  const NamedArray* kinds = lines.find_array("kind", NamedArray::On::cells);
  std::map<int, Part> parts;
  for (std::size_t i = 0; i < lines.lines.size(); ++i) {
    const int kind = kinds == nullptr
                         ? static_cast<int>(StrokeKind::border)
                         : static_cast<int>(kinds->values(static_cast<Eigen::Index>(i)));
    Part& part = parts[kind];
    part.kind = Part::Kind::lines;
    part.points = lines.points;
    part.lines.push_back(lines.lines[i]);
  }
  std::vector<KindLines> result;
  for (auto& [kind, part] : parts)
    result.push_back({static_cast<StrokeKind>(kind), std::move(part)});
  return result;
}

const std::array<double, 3>& colour_of(StrokeKind kind) {
  return kStrokeColours[static_cast<std::size_t>(kind)];
}

/// What a panel draws, and where it came to lie in the picture.
struct PlacedPanel {
  ViewWindow window;
  int left = 0, top = 0, width = 1, height = 1;

  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d d = p - window.center;
    return {left + width * (0.5 + d.dot(window.right) / window.width_m),
            top + height * (0.5 - d.dot(window.up) / window.height_m)};
  }
};

PlacedPanel place_panel(const ViewWindow& window, int column) {
  PlacedPanel panel{window};
  const double scale = std::min(kPanelWide / window.width_m, kPanelHigh / window.height_m);
  panel.width = std::max(2, static_cast<int>(std::lround(scale * window.width_m)));
  panel.height = std::max(2, static_cast<int>(std::lround(scale * window.height_m)));
  panel.left = kSide + column * (kPanelWide + kApart) + (kPanelWide - panel.width) / 2;
  panel.top = kPanelTop + (kPanelHigh - panel.height) / 2;
  return panel;
}

void head_panel(Canvas& picture, int column, const std::string& text) {
  draw_text(picture, text, kSide + column * (kPanelWide + kApart) + kPanelWide / 2, kPanelTop - 30,
            Align::center, kPanelStyle);
}

PanelParts with_overlays(std::vector<const Part*> parts, const std::vector<KindLines>& lines) {
  PanelParts panel;
  panel.parts = std::move(parts);
  for (const KindLines& of : lines) panel.overlays.push_back({&of.part, colour_of(of.kind)});
  return panel;
}

/// The corners of the picture in a view.
Part picture_corners(const Picture& photo) {
  Part part;
  part.kind = Part::Kind::lines;
  part.points.resize(2, 3);
  part.points.row(0) << photo.origin.x(), photo.origin.y(), 0;
  part.points.row(1) << photo.origin.x() + photo.size.x(), photo.origin.y() + photo.size.y(), 0;
  return part;
}

/// The photograph where the panel is white, pale.
void lay_under(Canvas& picture, const PlacedPanel& panel, const PixelImage& photo,
               const Picture& place) {
  const Eigen::Vector2d low = panel.pixel({place.origin.x(), place.origin.y() + place.size.y(), 0});
  const Eigen::Vector2d high =
      panel.pixel({place.origin.x() + place.size.x(), place.origin.y(), 0});
  for (int y = panel.top; y < panel.top + panel.height; ++y) {
    for (int x = panel.left; x < panel.left + panel.width; ++x) {
      const double u = (x + 0.5 - low.x()) / (high.x() - low.x());
      const double v = (y + 0.5 - low.y()) / (high.y() - low.y());
      if (u < 0 || u >= 1 || v < 0 || v >= 1) continue;
      const PixelColour& of =
          photo.at(static_cast<int>(u * photo.width), static_cast<int>(v * photo.height));
      Rgb& here = picture.at(x, y);
      for (int c = 0; c < 3; ++c) {
        const int pale = 255 - (255 - of[c]) * 3 / 5;
        here[c] = static_cast<std::uint8_t>(here[c] * pale / 255);
      }
    }
  }
}

void draw_drawing(Canvas& picture, const Overview& overview, const std::vector<KindLines>& lines) {
  std::vector<const Part*> seen;
  for (const KindLines& of : lines) seen.push_back(&of.part);
  const View* photo = overview.photo ? overview.drawing.find(ViewKind::photo) : nullptr;
  Part corners;
  if (photo != nullptr) {
    corners = picture_corners(photo->picture);
    seen.push_back(&corners);
  }
  FigureView view;
  view.direction = {0, 0, 1};
  view.up = {0, 1, 0};
  const PlacedPanel panel = place_panel(fit_window(seen, view), 0);
  head_panel(picture, 0, "The drawing");
  picture.paste(draw_panel(with_overlays({}, lines), panel.window, {}, panel.width, panel.height),
                panel.left, panel.top);
  if (photo != nullptr) lay_under(picture, panel, *overview.photo, photo->picture);
}

void draw_surface(Canvas& picture, const Overview& overview, const std::vector<KindLines>& lines) {
  FigureView view;
  // Of one view little more is known than what it shows.
  view.direction = {0.8, 0.5, 1};
  if (overview.drawing.find(ViewKind::photo) != nullptr) view.direction = {0.45, 0.25, 1};
  view.up = {0, 1, 0};
  const PlacedPanel panel = place_panel(fit_window({&overview.surface}, view), 1);
  head_panel(picture, 1, "The surface");
  PanelStyle style;
  style.flat = true;
  picture.paste(draw_panel(with_overlays({&overview.surface}, lines), panel.window, style,
                           panel.width, panel.height),
                panel.left, panel.top);
}

// The pieces.

constexpr double kFullPercent = 5;

/// With the strain in percent: of the surface over the pattern, minus 1.
Part with_percent(const Part& pattern) {
  Part part = pattern;
  NamedArray percent{"cloth must give (red) or gather (blue)", "%", NamedArray::On::cells, {}};
  percent.values =
      pattern.require_array("stretch", NamedArray::On::cells, 1).values.unaryExpr([](double x) {
        return 100 * std::expm1(x);
      });
  part.arrays = {percent, pattern.require_array("piece", NamedArray::On::cells, 1)};
  return part;
}

ColorScale percent_scale(const Part& part) {
  ColorScale scale;
  scale.array = part.arrays.front().name;
  scale.unit = "%";
  scale.low = -kFullPercent;
  scale.high = kFullPercent;
  scale.diverging = true;
  const Eigen::MatrixXd& values = part.arrays.front().values;
  scale.below = values.size() > 0 && values.minCoeff() < scale.low;
  scale.above = values.size() > 0 && values.maxCoeff() > scale.high;
  return scale;
}

Part piece_outlines(const Part& pattern) {
  Part part;
  part.kind = Part::Kind::lines;
  part.points = pattern.points;
  for (const Edge& edge : boundary_edges(pattern.triangles))
    part.lines.push_back({edge[0], edge[1]});
  return part;
}

void name_pieces(Canvas& picture, const PlacedPanel& panel, const Part& pattern,
                 const std::vector<std::string>& names) {
  const Eigen::MatrixXd& piece = pattern.require_array("piece", NamedArray::On::cells, 1).values;
  std::map<int, std::pair<Eigen::Vector3d, int>> middle;
  for (Eigen::Index t = 0; t < pattern.triangles.rows(); ++t) {
    auto& [sum, count] =
        middle.try_emplace(static_cast<int>(piece(t)), Eigen::Vector3d::Zero(), 0).first->second;
    for (int c = 0; c < 3; ++c) sum += pattern.points.row(pattern.triangles(t, c)).transpose();
    count += 3;
  }
  for (const auto& [number, place] : middle) {
    const std::string name = number >= 0 && number < std::ssize(names)
                                 ? names[number]
                                 : "piece " + std::to_string(number);
    const Eigen::Vector2d at = panel.pixel(place.first / place.second);
    draw_text(picture, name, static_cast<int>(at.x()), static_cast<int>(at.y()) + 8, Align::center,
              kPieceStyle);
  }
}

void draw_pieces(Canvas& picture, const Overview& overview) {
  head_panel(picture, 2, "Its pieces, laid flat");
  if (!overview.pattern) {
    draw_text(picture, "no pattern", kWide - kSide - kPanelWide / 2, kPanelTop + kPanelHigh / 2,
              Align::center, kSubtitleStyle);
    return;
  }
  const Part pattern = with_percent(*overview.pattern);
  FigureView view;
  view.direction = {0, 0, 1};
  view.up = {0, 1, 0};
  const PlacedPanel panel = place_panel(fit_window({&pattern}, view), 2);
  const Part border = piece_outlines(pattern);
  PanelStyle style;
  style.scale = percent_scale(pattern);
  style.flat = true;
  PanelParts parts;
  parts.parts = {&pattern};
  parts.overlays.push_back({&border, {0.1, 0.1, 0.1}});
  picture.paste(draw_panel(parts, panel.window, style, panel.width, panel.height), panel.left,
                panel.top);
  name_pieces(picture, panel, pattern, overview.pieces);
  Canvas bar(kPanelWide, kFoot);
  draw_scalar_bar(bar, *style.scale, 10);
  picture.paste(bar, kWide - kSide - kPanelWide, kPanelTop + kPanelHigh + 10);
}

/// Of all kinds that either panel shows, below both.
void draw_kinds(Canvas& picture, const std::vector<KindLines>& drawn,
                const std::vector<KindLines>& on_surface) {
  std::set<StrokeKind> kinds;
  for (const auto* lines : {&drawn, &on_surface}) {
    for (const KindLines& of : *lines) kinds.insert(of.kind);
  }
  std::vector<LegendEntry> entries;
  for (const StrokeKind kind : kinds)
    entries.push_back(
        {display_name(std::string(row_of(kind).name)), colour_of(kind), LegendEntry::Mark::line});
  Canvas legend(2 * kPanelWide + kApart, kFoot);
  draw_legend(legend, entries, 10);
  picture.paste(legend, kSide, kPanelTop + kPanelHigh + 10);
}

}  // namespace

geoprior::Picture draw_overview(const Overview& overview) {
  Canvas picture(kWide, kPanelTop + kPanelHigh + kFoot);
  const std::vector<KindLines> drawn = lines_by_kind(drawing_part(overview.drawing));
  std::vector<KindLines> on_surface;
  if (overview.strokes) on_surface = lines_by_kind(*overview.strokes);
  draw_text(picture, overview.title, kSide, 66, Align::left, kTitleStyle);
  draw_text(picture, overview.subtitle, kSide, 112, Align::left, kSubtitleStyle);
  draw_drawing(picture, overview, drawn);
  draw_surface(picture, overview, on_surface);
  draw_pieces(picture, overview);
  draw_kinds(picture, drawn, on_surface);
  return picture;
}

}  // namespace geoprior::sketch
