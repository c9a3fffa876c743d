#include "experiments/paper/scene/svg_pattern.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "testbed/formats/svg/document.h"

namespace geoprior::paper {
namespace {

// The keys of the scene that errors name.
const std::string kFileKey = "scene.pattern.file: ";
const std::string kPathKey = "scene.pattern.path: ";

constexpr const char* kShapes = "path, polygon, polyline, rect, circle, ellipse";

/// Height of a box about a line's points, over its length, under which they lie on a line.
constexpr double kFlattest = 1e-6;

SvgDocument read_drawing(const std::filesystem::path& file, const SvgPatternOptions& options) {
  SvgReadOptions read;
  read.tolerance = options.tolerance;
  read.unit_m = options.unit_m;
  try {
    return read_svg_document(file, read);
  } catch (const Error& error) {
    throw Error(kFileKey + error.what());
  }
}

/// A line encloses nothing, whatever it is filled with.
bool encloses(const SvgShape& shape) { return shape.element != "line"; }

std::string ids_of(const std::vector<const SvgShape*>& shapes) {
  constexpr std::size_t kMostIds = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(shapes.size(), kMostIds); ++i) {
    const std::string& id = shapes[i]->tags.id;
    list += (list.empty() ? "" : ", ") +
            (id.empty() ? "(a " + shapes[i]->element + " without id)" : id);
  }
  return list + (shapes.size() > kMostIds ? ", …" : "");
}

const SvgShape& choose_shape(const SvgDocument& drawing, const std::optional<std::string>& id) {
  std::vector<const SvgShape*> shapes, named;
  for (const SvgShape& shape : drawing.shapes) {
    if (encloses(shape)) shapes.push_back(&shape);
    if (id && shape.tags.id == *id) named.push_back(&shape);
  }
  if (!id && shapes.size() == 1) return *shapes[0];
  if (shapes.empty() && named.empty()) {
    throw Error("draws no shape that encloses anything", kFileKey + drawing.name, kShapes);
  }
  if (!id) {
    throw Error(std::to_string(shapes.size()) + " shapes, and 'path' names none",
                kPathKey + drawing.name, ids_of(shapes));
  }
  if (named.empty())
    throw Error("no shape with id '" + *id + "'", kPathKey + drawing.name, ids_of(shapes));
  if (named.size() > 1) {
    throw Error("'" + *id + "' is drawn " + std::to_string(named.size()) + " times",
                kPathKey + drawing.name, "a shape that is drawn once");
  }
  if (!encloses(*named[0])) {
    throw Error("a line encloses nothing",
                kPathKey + drawing.place(named[0]->element, named[0]->tags), kShapes);
  }
  return *named[0];
}

/// Whether the points lie on a line, by the axes of their moments of inertia.
bool is_flat(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p / static_cast<double>(points.size());
  double xx = 0, xy = 0, yy = 0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d d = p - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double large = (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy);
  return xx * yy - xy * xy <= kFlattest * kFlattest * large * large;
}

std::vector<Eigen::Vector2d> closed_loop(const SvgSubpath& line, const std::string& where) {
  std::vector<Eigen::Vector2d> loop = line.points;
  loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  const std::string here =
      where + (line.character > 0 ? ", character " + std::to_string(line.character) : "");
  if (loop.size() < 3) throw Error("the outline has fewer than three points", here, "an area");
  if (is_flat(loop)) {
    throw Error("the outline is flattened to a line", here,
                "an outline with area, and transforms that leave it one");
  }
  return loop;
}

/// The loop of the largest area is the border, the others are holes in their order.
Pattern loops_of(const SvgShape& shape, const std::string& where) {
  if (shape.lines.empty())
    throw Error("has no extent or no data, and draws nothing", where, "an outline with area");
  std::size_t points = 0;
  for (const SvgSubpath& line : shape.lines) points += line.points.size();
  // A closed line may name its first point again.
  if (points > kMostCorners + shape.lines.size())
    throw Error("the outline has too many corners", where, std::to_string(kMostCorners));
  Pattern pattern;
  for (const SvgSubpath& line : shape.lines) pattern.holes.push_back(closed_loop(line, where));
  const auto area = [](const std::vector<Eigen::Vector2d>& loop) {
    return std::abs(signed_area({loop}));
  };
  const auto largest =
      std::max_element(pattern.holes.begin(), pattern.holes.end(),
                       [&](const auto& a, const auto& b) { return area(a) < area(b); });
  pattern.border = std::move(*largest);
  pattern.holes.erase(largest);
  return pattern;
}

void move(Pattern& pattern, const Eigen::Vector2d& shift) {
  for (Eigen::Vector2d& p : pattern.border) p += shift;
  for (std::vector<Eigen::Vector2d>& hole : pattern.holes) {
    for (Eigen::Vector2d& p : hole) p += shift;
  }
}

}  // namespace

Pattern read_svg_pattern(const std::filesystem::path& file, const SvgPatternOptions& options) {
  const SvgDocument drawing = read_drawing(file, options);
  const SvgShape& shape = choose_shape(drawing, options.path);
  const std::string where = kFileKey + drawing.place(shape.element, shape.tags);
  Pattern pattern = loops_of(shape, where);
  require_simple_loops(pattern, where);
  move(pattern, options.centred ? Eigen::Vector2d(-bounding_box(pattern).center())
                                : Eigen::Vector2d(-drawing.user_origin));
  return oriented(std::move(pattern));
}

}  // namespace geoprior::paper
