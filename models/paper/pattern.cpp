#include "models/paper/pattern.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/limits.h"
#include "core/planar.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

std::size_t next(std::size_t i, std::size_t n) { return i + 1 == n ? 0 : i + 1; }

std::string corner(const std::string& where, std::size_t i) {
  return where + " corner " + std::to_string(i);
}

std::string edge(const std::string& where, std::size_t i) {
  return where + " edge " + std::to_string(i);
}

void require_finite(const Pattern& pattern, const std::string& where) {
  if (pattern.border.size() < 3) {
    throw Error("pattern has " + std::to_string(pattern.border.size()) + " corners", where,
                "at least 3");
  }
  require_count(static_cast<double>(pattern.border.size()), "corners", kMostCorners, where);
  for (std::size_t i = 0; i < pattern.border.size(); ++i) {
    if (!pattern.border[i].allFinite()) {
      throw Error("corner of the pattern is not finite", corner(where, i), "finite numbers");
    }
  }
}

/// No corner twice, no edge that turns back onto the one before, not all on one line.
void require_distinct(const Pattern& pattern, const std::string& where) {
  const std::vector<Vector2d>& p = pattern.border;
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (p[i] == p[j]) {
        throw Error("corner is the same point as corner " + std::to_string(i), corner(where, j),
                    "each corner once, the first not repeated at the end");
      }
    }
  }
  bool bends = false;
  for (std::size_t i = 0; i < n; ++i) bends = bends || orientation(p[0], p[1], p[i]) != 0;
  if (!bends) throw Error("corners of the pattern are collinear", where, "a polygon with area");
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d& before = p[i == 0 ? n - 1 : i - 1];
    const Vector2d& after = p[next(i, n)];
    if (orientation(before, p[i], after) == 0 && (before - p[i]).dot(after - p[i]) > 0) {
      throw Error("border turns back onto itself", corner(where, i), "no spikes");
    }
  }
}

void require_uncrossed(const Pattern& pattern, const std::string& where) {
  const std::vector<Vector2d>& p = pattern.border;
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (next(j, n) == i) continue;  // neighbours share a corner
      if (segments_meet(p[i], p[next(i, n)], p[j], p[next(j, n)])) {
        throw Error("edge crosses or touches edge " + std::to_string(i), edge(where, j),
                    "a border that does not meet itself");
      }
    }
  }
}

/// Area over the square of the diameter, below which the mesher's coordinates run out of digits.
constexpr double kThinnest = 1e-6;

/// Whether the border passes `p` upwards (+1) or downwards (-1) on its right along edge a b.
int winding(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  if (a.y() <= p.y() && b.y() > p.y()) return orientation(a, b, p) > 0 ? 1 : 0;
  if (a.y() > p.y() && b.y() <= p.y()) return orientation(a, b, p) < 0 ? -1 : 0;
  return 0;
}

}  // namespace

Pattern rectangle_pattern(double width, double height) {
  if (!(width > 0 && height > 0 && std::isfinite(width * height))) {
    throw Error("rectangle has no area", "pattern", "positive width and height");
  }
  const double x = width / 2, y = height / 2;
  return {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}};
}

Pattern disc_pattern(double radius, int corners) {
  if (!(radius > 0 && std::isfinite(radius))) {
    throw Error("disc has no area", "pattern", "a positive radius");
  }
  if (corners < 3) throw Error("disc has too few corners", "pattern", "at least 3");
  Pattern disc;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    disc.border.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return disc;
}

void require_simple(const Pattern& pattern, const std::string& where) {
  require_finite(pattern, where);
  require_distinct(pattern, where);
  require_uncrossed(pattern, where);
  if (!(signed_area(pattern) > 0)) {
    throw Error("border of the pattern runs clockwise", where, "counter-clockwise");
  }
  const double length = diameter(pattern);
  if (signed_area(pattern) < kThinnest * length * length) {
    throw Error("pattern is too thin for its length", where,
                "an area of at least 1e-6 of the square of its diameter");
  }
}

double signed_area(const Pattern& pattern) {
  double twice = 0;
  const std::vector<Vector2d>& p = pattern.border;
  // About the first corner, so that a pattern far from the origin loses no digits.
  for (std::size_t i = 1; i + 1 < p.size(); ++i) twice += cross(p[i] - p[0], p[i + 1] - p[0]);
  return twice / 2;
}

double diameter(const Pattern& pattern) {
  double longest = 0;
  for (const Vector2d& a : pattern.border) {
    for (const Vector2d& b : pattern.border) longest = std::max(longest, (a - b).norm());
  }
  return longest;
}

double width(const Pattern& pattern) {
  if (pattern.border.empty()) return 0;
  Vector2d low = pattern.border.front(), high = low;
  for (const Vector2d& p : pattern.border) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).maxCoeff();
}

bool contains(const Pattern& pattern, const Vector2d& p, double tolerance) {
  int turns = 0;
  const std::size_t n = pattern.border.size();
  for (std::size_t i = 0; i < n; ++i) {
    turns += winding(pattern.border[i], pattern.border[next(i, n)], p);
  }
  return turns != 0 || nearest_on_border(pattern, p).distance <= tolerance;
}

BorderPoint nearest_on_border(const Pattern& pattern, const Vector2d& p) {
  BorderPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  const std::size_t n = pattern.border.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d& a = pattern.border[i];
    const Vector2d along = pattern.border[next(i, n)] - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vector2d point = t == 1 ? pattern.border[next(i, n)] : Vector2d(a + t * along);
    const double distance = (p - point).norm();
    if (distance < best.distance) best = {point, static_cast<int>(i), t, distance};
  }
  return best;
}

}  // namespace geoprior::paper
