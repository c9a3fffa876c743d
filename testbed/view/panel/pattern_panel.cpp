#include "testbed/view/panel/pattern_panel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <utility>

#include "core/connectivity.h"
#include "core/error.h"
#include "testbed/view/figure/colors.h"
#include "testbed/view/figure/legend.h"

namespace geoprior {
namespace {

constexpr const char* kPattern = "pattern";
constexpr const char* kTime = "time";
constexpr const char* kPatternKey = "figure_view.pattern";

constexpr Rgb kSheetColor{246, 243, 235};
constexpr Rgb kBorderColor{52, 52, 56};

// Pixels of a picture that is shown at half its size.
constexpr double kBorderThickness = 2.6;
constexpr double kLineThickness = 1.6;
constexpr double kPathThickness = 6;
constexpr double kExpectedThickness = 2.4;
constexpr double kDash = 12;
constexpr double kDashGap = 8;
constexpr double kPointRadius = 6;
constexpr double kLineOpacity = 0.5;

Eigen::MatrixX2d pattern_of(const Part& part, const std::string& name) {
  return part.require_array(kPattern, NamedArray::On::points, 2, name).values;
}

std::string point_arrays(const std::vector<const Part*>& parts) {
  std::string text;
  for (const Part* part : parts) {
    for (const NamedArray& array : part->arrays) {
      if (array.on != NamedArray::On::points) continue;
      if (text.find("'" + array.name + "'") != std::string::npos) continue;
      text += (text.empty() ? "'" : ", '") + array.name + "'";
    }
  }
  return text.empty() ? "none" : text;
}

bool is_path(const Part& part) {
  return part.kind == Part::Kind::lines &&
         part.find_array(kTime, NamedArray::On::points) != nullptr;
}

/// An overlay in the pixels of a picture.
struct PlacedOverlay {
  const PatternOverlay* overlay = nullptr;
  std::vector<Eigen::Vector2d> points;

  [[nodiscard]] const Part& part() const { return *overlay->part; }
  [[nodiscard]] Rgb color() const { return to_rgb(overlay->color); }
  /// Pieces of its lines whose second point is one of those wanted.
  [[nodiscard]] std::vector<CurveSegment> pieces(const std::function<bool(int)>& wanted) const {
    std::vector<CurveSegment> out;
    for (const std::vector<int>& line : part().lines) {
      for (std::size_t i = 1; i < line.size(); ++i) {
        if (wanted(line[i])) out.push_back({points.at(line[i - 1]), points.at(line[i])});
      }
    }
    return out;
  }
};

PlacedOverlay placed(const PatternOverlay& overlay, const Part& sheet, const PlaneView& view,
                     const Picture& picture) {
  const Part::Kind kind = overlay.part->kind;
  if (kind != Part::Kind::lines && kind != Part::Kind::points) {
    throw Error("'" + overlay.name + "' cannot be drawn over a pattern", kPatternKey,
                "overlays of lines or points");
  }
  PlacedOverlay out{&overlay, {}};
  const Eigen::MatrixX2d places = places_in_pattern(*overlay.part, overlay.name, sheet);
  for (const auto& place : places.rowwise()) {
    out.points.push_back(to_pixels(Eigen::Vector2d(place), view, picture));
  }
  return out;
}

void draw_path(Picture& picture, const PlacedOverlay& path) {
  const Eigen::VectorXd time =
      path.part().require_array(kTime, NamedArray::On::points, 1, path.overlay->name).values;
  const auto has_grown = [&](int point) { return time[point] > 0; };
  const auto was_given = [&](int point) { return !has_grown(point); };
  stroke(picture, path.pieces(was_given), kPathThickness, kBorderColor);
  stroke(picture, path.pieces(has_grown), kPathThickness, path.color());
}

void draw_expected(Picture& picture, const std::vector<Eigen::Vector2d>& curve,
                   const PlaneView& view) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector2d& point : curve) pixels.push_back(to_pixels(point, view, picture));
  stroke(picture, dashes(pixels, kDash, kDashGap), kExpectedThickness, to_rgb(kExpectedColor));
}

}  // namespace

bool has_pattern(const Part& sheet) {
  return sheet.find_array(kPattern, NamedArray::On::points) != nullptr;
}

PatternWindow fit_pattern(const std::vector<const Part*>& sheets) {
  Eigen::AlignedBox2d box;
  for (const Part* sheet : sheets) {
    if (!has_pattern(*sheet)) continue;
    const Eigen::MatrixX2d places = pattern_of(*sheet, "sheet");
    for (const auto& place : places.rowwise()) {
      if (place.allFinite()) box.extend(place.transpose());
    }
  }
  if (box.isEmpty()) {
    throw Error("no part has a point array 'pattern': there is no flat pattern to draw",
                kPatternKey, "of the point arrays " + point_arrays(sheets));
  }
  return {box.center(), box.sizes().x(), box.sizes().y()};
}

std::vector<CurveSegment> pattern_border(const Part& sheet) {
  const Eigen::MatrixX2d places = pattern_of(sheet, "sheet");
  const EdgeConnectivity edges(sheet.triangles);
  std::vector<CurveSegment> border;
  for (int f = 0; f < sheet.triangles.rows(); ++f) {
    const auto t = sheet.triangles.row(f);
    Eigen::Matrix2d sides;
    sides << places.row(t[1]) - places.row(t[0]), places.row(t[2]) - places.row(t[0]);
    const bool clockwise = sides.determinant() < 0;
    for (int i = 0; i < 3; ++i) {
      int from = t[i], to = t[(i + 1) % 3];
      if (edges.half_edges(edges.edge_of(3 * f + i)).size() != 1) continue;
      if (clockwise) std::swap(from, to);
      const CurveSegment side{places.row(from), places.row(to)};
      if (side.from.allFinite() && side.to.allFinite()) border.push_back(side);
    }
  }
  return border;
}

Eigen::MatrixX2d places_in_pattern(const Part& overlay, const std::string& name,
                                   const Part& sheet) {
  if (has_pattern(overlay)) return pattern_of(overlay, name);
  using Place = std::array<double, 3>;
  std::map<Place, Eigen::Index> vertices;
  for (Eigen::Index v = 0; v < sheet.points.rows(); ++v) {
    if (!sheet.points.row(v).allFinite()) continue;
    vertices[{sheet.points(v, 0), sheet.points(v, 1), sheet.points(v, 2)}] = v;
  }
  const Eigen::MatrixX2d pattern = pattern_of(sheet, "sheet");
  Eigen::MatrixX2d places(overlay.points.rows(), 2);
  for (Eigen::Index i = 0; i < overlay.points.rows(); ++i) {
    const auto found =
        vertices.find({overlay.points(i, 0), overlay.points(i, 1), overlay.points(i, 2)});
    if (found == vertices.end()) {
      throw Error("point " + std::to_string(i) + " of '" + name + "' has no place in the pattern",
                  kPatternKey, "points with an array 'pattern', or vertices of the sheet");
    }
    places.row(i) = pattern.row(found->second);
  }
  return places;
}

Picture draw_pattern(const Part& sheet, const std::vector<PatternOverlay>& overlays,
                     const std::vector<Eigen::Vector2d>& expected, const PlaneView& view,
                     int width_px, int height_px) {
  Picture picture(width_px, height_px);
  std::vector<PlacedOverlay> lines, paths, points;
  for (const PatternOverlay& overlay : overlays) {
    std::vector<PlacedOverlay>& layer = is_path(*overlay.part)                     ? paths
                                        : overlay.part->kind == Part::Kind::points ? points
                                                                                   : lines;
    layer.push_back(placed(overlay, sheet, view, picture));
  }
  const std::vector<CurveSegment> border = to_pixels(pattern_border(sheet), view, picture);
  fill(picture, border, [](int) { return kSheetColor; });
  for (const PlacedOverlay& line : lines) {
    const std::vector<CurveSegment> pieces = line.pieces([](int) { return true; });
    stroke(picture, pieces, kLineThickness, line.color(), kLineOpacity);
  }
  stroke(picture, border, kBorderThickness, kBorderColor);
  for (const PlacedOverlay& path : paths) draw_path(picture, path);
  draw_expected(picture, expected, view);
  for (const PlacedOverlay& dots : points) {
    for (const Eigen::Vector2d& at : dots.points) {
      fill_disc(picture, at, kPointRadius, dots.color());
    }
  }
  return picture;
}

}  // namespace geoprior
