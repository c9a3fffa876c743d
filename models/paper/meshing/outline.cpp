#include "models/paper/meshing/outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "models/paper/sheet/valid.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;
using Loop = std::vector<Vector2d>;

/// A corner that turns by more is one of the shape, not of a curve's flattening.
constexpr double kSharp = 20 * std::numbers::pi / 180;
/// Farthest that a line turns between two new corners.
constexpr double kMostTurn = 30 * std::numbers::pi / 180;
/// A line that turns by less is straight.
constexpr double kStraight = 1e-6;
/// Points of the outline within this share of the pattern's width.
constexpr double kOnOutline = 1e-9;
/// A kept point this near to the outline, in edge lengths, keeps the outline beside it.
constexpr double kBeside = 0.25;
/// Halvings of the edge before the outline is left as it is.
constexpr int kMostHalvings = 8;
/// The area under a moved line is quadratic in how far it moves.
constexpr int kAreaSteps = 4;

/// A corner of a loop, and whether it stays.
struct Corner {
  Vector2d point;
  bool stays = false;
};

double turn_at(const Vector2d& before, const Vector2d& at, const Vector2d& after) {
  return std::abs(signed_angle(at - before, after - at));
}

/// Twice the area between a line and its chord, positive on the chord's right.
double twice_area(std::span<const Vector2d> line) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    sum += cross(line[i] - line[0], line[i + 1] - line[0]);
  return sum;
}

/// Corners with the kept points that lie on the sides between them.
std::vector<Corner> with_kept(const std::vector<Corner>& shape, const std::vector<Vector2d>& kept,
                              double tolerance) {
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Vector2d &a = shape[i].point, along = shape[(i + 1) % shape.size()].point - a;
    std::vector<std::pair<double, Vector2d>> stops;
    corners.push_back(shape[i]);
    for (const Vector2d& p : kept) {
      const double t = (p - a).dot(along) / along.squaredNorm();
      if ((p - a).norm() <= tolerance) {
        corners.back().stays = true;
      } else if (t > 0 && t < 1 && (p - a - t * along).norm() <= tolerance &&
                 (1 - t) * along.norm() > tolerance) {
        stops.emplace_back(t, p);
      }
    }
    std::sort(stops.begin(), stops.end(),
              [](const auto& s, const auto& u) { return s.first < u.first; });
    for (const auto& [t, p] : stops) {
      if ((corners.back().point - p).norm() > tolerance) corners.push_back({p, true});
    }
  }
  return corners;
}

void mark_shape(double edge, std::vector<Corner>& corners) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    Corner &before = corners[(i + n - 1) % n], &at = corners[i], &after = corners[(i + 1) % n];
    if (turn_at(before.point, at.point, after.point) > kSharp) at.stays = true;
    if ((after.point - at.point).norm() >= edge) at.stays = after.stays = true;
  }
}

/// Moves the inner points of a line along their normals until its area is `twice`.
void keep_area(double twice, double farthest, std::vector<Vector2d>& line) {
  std::vector<Vector2d> normals(line.size(), Vector2d::Zero());
  double slope = 0;  // of twice the area against how far points move
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vector2d across = line[i + 1] - line[i - 1];
    normals[i] = Vector2d(across.y(), -across.x()).normalized();
    slope += across.norm();
  }
  double moved = 0;
  for (int step = 0; step < kAreaSteps && slope > 0; ++step) {
    const double to = std::clamp(moved + (twice - twice_area(line)) / slope, -farthest, farthest);
    for (std::size_t i = 1; i + 1 < line.size(); ++i) line[i] += (to - moved) * normals[i];
    moved = to;
  }
}

/// Points at equal distances along a line, its ends among them.
std::vector<Vector2d> evenly(std::span<const Vector2d> line, double length, int pieces) {
  std::vector<Vector2d> points{line.front()};
  double passed = 0;
  std::size_t i = 0;
  for (int k = 1; k < pieces; ++k) {
    const double at = length * k / pieces;
    while (i + 2 < line.size() && passed + (line[i + 1] - line[i]).norm() < at) {
      passed += (line[i + 1] - line[i]).norm();
      ++i;
    }
    const Vector2d along = line[i + 1] - line[i];
    points.emplace_back(line[i] + (at - passed) / along.norm() * along);
  }
  points.push_back(line.back());
  return points;
}

/// A line between two corners that stay with fewer corners; the line itself where it has no more
/// than it needs.
std::vector<Vector2d> thinned(std::span<const Vector2d> line, double edge) {
  double length = 0, turn = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    length += (line[i + 1] - line[i]).norm();
    if (i > 0) turn += turn_at(line[i - 1], line[i], line[i + 1]);
  }
  // Without a point between its ends a line has no area to keep.
  const int least = turn > kStraight ? 2 : 1;
  const int pieces = std::max({least, static_cast<int>(std::lround(length / edge)),
                               static_cast<int>(std::ceil(turn / kMostTurn - 1e-9))});
  if (pieces >= std::ssize(line) - 1) return {line.begin(), line.end()};
  std::vector<Vector2d> points = evenly(line, length, pieces);
  keep_area(twice_area(line), edge / 4, points);
  return points;
}

Loop resampled_loop(const Loop& loop, double edge, const std::vector<Vector2d>& kept,
                    double tolerance) {
  std::vector<Corner> corners;
  for (const Vector2d& p : loop) corners.push_back({p});
  mark_shape(edge, corners);
  corners = with_kept(corners, kept, tolerance);
  const auto first =
      std::find_if(corners.begin(), corners.end(), [](const Corner& c) { return c.stays; });
  // Of a curve without a corner of its own the first one is as good as any.
  if (first == corners.end()) {
    corners.front().stays = true;
  } else {
    std::rotate(corners.begin(), first, corners.end());
  }
  corners.push_back(corners.front());
  Loop result;
  std::size_t begin = 0;
  bool changed = false;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (!corners[i].stays) continue;
    std::vector<Vector2d> line;
    for (std::size_t k = begin; k <= i; ++k) line.push_back(corners[k].point);
    const std::vector<Vector2d> fewer = thinned(line, edge);
    changed = changed || fewer.size() < line.size();
    result.insert(result.end(), fewer.begin(), fewer.end() - 1);
    begin = i;
  }
  return changed && result.size() > 2 ? result : loop;
}

template <class Check>
bool passes(Check&& check) {
  try {
    check();
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

Pattern resampled(const Pattern& pattern, double edge, const std::vector<Vector2d>& kept,
                  const std::function<bool(const Pattern&)>& accepts) {
  const double tolerance = kOnOutline * width(pattern);
  for (int halving = 0; halving < kMostHalvings; ++halving, edge /= 2) {
    Pattern result{resampled_loop(pattern.border, edge, kept, tolerance), {}, pattern.cuts};
    for (const Loop& hole : pattern.holes)
      result.holes.push_back(resampled_loop(hole, edge, kept, tolerance));
    if (result.border == pattern.border && result.holes == pattern.holes) return pattern;
    const bool holds = std::all_of(kept.begin(), kept.end(), [&](const Vector2d& p) {
      return contains(result, p, tolerance) || !contains(pattern, p, tolerance);
    });
    if (holds && passes([&] { require_simple(result, "outline"); }) && accepts(result))
      return result;
  }
  return pattern;
}

Sheet with_outline(Sheet sheet, double edge) {
  std::vector<Vector2d> kept;
  for (const Handle& handle : sheet.handles) {
    for (const Vector2d& p : handle.anchors()) {
      const BorderPoint beside = nearest_on_loops(sheet.pattern, p);
      kept.push_back(p);
      if (beside.distance < kBeside * edge) kept.push_back(beside.point);
    }
  }
  for (const Loop& cut : sheet.pattern.cuts) kept.insert(kept.end(), {cut.front(), cut.back()});
  Sheet tried = sheet;
  sheet.pattern = resampled(sheet.pattern, edge, kept, [&](const Pattern& pattern) {
    tried.pattern = pattern;
    return passes([&] { require_valid(tried, "sheet"); });
  });
  return sheet;
}

}  // namespace geoprior::paper
