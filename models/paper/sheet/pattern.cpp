#include "models/paper/sheet/pattern.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/limits.h"
#include "models/paper/contact/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

std::size_t next(std::size_t i, std::size_t n) { return i + 1 == n ? 0 : i + 1; }

using Loop = std::vector<Vector2d>;

std::string corner(const std::string& where, std::size_t i) {
  return where + " corner " + std::to_string(i);
}

std::string edge(const std::string& where, std::size_t i) {
  return where + " edge " + std::to_string(i);
}

/// The source of a loop: that of the pattern, and which hole.
std::string place_of(const std::string& where, std::size_t loop) {
  return loop == 0 ? where : where + " hole " + std::to_string(loop - 1);
}

void require_finite(const Loop& loop, const std::string& where) {
  if (loop.size() < 3) {
    throw Error("pattern has " + std::to_string(loop.size()) + " corners", where, "at least 3");
  }
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (!loop[i].allFinite()) {
      throw Error("corner of the pattern is not finite", corner(where, i), "finite numbers");
    }
  }
}

/// No corner twice, no edge that turns back onto the one before, not all on one line.
void require_distinct(const Loop& p, const std::string& where) {
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

void require_uncrossed(const Loop& p, const std::string& where) {
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

/// Nearest that two loops come to each other, over the pattern's width: well above what rounding
/// makes of loops that touch, and what the meshers take for one point.
constexpr double kNearest = 1e-6;

double loop_area(const Loop& p) {
  double twice = 0;
  // About the first corner, so that a pattern far from the origin loses no digits.
  for (std::size_t i = 1; i + 1 < p.size(); ++i) twice += cross(p[i] - p[0], p[i + 1] - p[0]);
  return twice / 2;
}

double loop_diameter(const Loop& p) {
  double longest = 0;
  for (const Vector2d& a : p) {
    for (const Vector2d& b : p) longest = std::max(longest, (a - b).norm());
  }
  return longest;
}

void require_area(const Loop& p, const std::string& where) {
  const double length = loop_diameter(p);
  if (std::abs(loop_area(p)) < kThinnest * length * length) {
    throw Error("pattern is too thin for its length", where,
                "an area of at least 1e-6 of the square of its diameter");
  }
}

bool edges_are_near(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d,
                    double distance) {
  for (int k = 0; k < 2; ++k) {
    if (std::max(a[k], b[k]) + distance < std::min(c[k], d[k])) return false;
    if (std::max(c[k], d[k]) + distance < std::min(a[k], b[k])) return false;
  }
  return segments_meet(a, b, c, d) || distance_to_segment(a, c, d) < distance ||
         distance_to_segment(b, c, d) < distance || distance_to_segment(c, a, b) < distance ||
         distance_to_segment(d, a, b) < distance;
}

void require_apart(const Pattern& pattern, std::size_t k, std::size_t l, const std::string& where) {
  const Loop &p = pattern.loop(k), &q = pattern.loop(l);
  const double distance = kNearest * width(pattern);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) {
      const Vector2d &a = p[i], &b = p[next(i, p.size())], &c = q[j], &d = q[next(j, q.size())];
      if (!edges_are_near(a, b, c, d, distance)) continue;
      throw Error("edge crosses or touches edge " + std::to_string(i) + " of " +
                      (k == 0 ? "the border" : "hole " + std::to_string(k - 1)),
                  edge(place_of(where, l), j), "holes apart from the border and from each other");
    }
  }
}

/// Whether the border passes `p` upwards (+1) or downwards (-1) on its right along edge a b.
int winding(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  if (a.y() <= p.y() && b.y() > p.y()) return orientation(a, b, p) > 0 ? 1 : 0;
  if (a.y() > p.y() && b.y() <= p.y()) return orientation(a, b, p) < 0 ? -1 : 0;
  return 0;
}

int turns_about(const Loop& loop, const Vector2d& p) {
  int turns = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    turns += winding(loop[i], loop[next(i, loop.size())], p);
  }
  return turns;
}

/// Every hole in the border and in no other hole, of loops that do not meet.
void require_nested(const Pattern& pattern, const std::string& where) {
  for (std::size_t k = 0; k < pattern.holes.size(); ++k) {
    const Vector2d& p = pattern.holes[k].front();
    const std::string here = place_of(where, k + 1);
    if (turns_about(pattern.border, p) == 0) {
      throw Error("hole lies outside of the border", here, "one border, and holes in it");
    }
    for (std::size_t l = 0; l < pattern.holes.size(); ++l) {
      if (l == k || turns_about(pattern.holes[l], p) == 0) continue;
      throw Error("hole lies in hole " + std::to_string(l), here,
                  "a sheet in one piece, without islands in its holes");
    }
  }
}

std::string cut_name(const std::string& where, std::size_t k) {
  return where + " cut " + std::to_string(k);
}

/// Whether a cut begins or ends at a point.
bool ends_at(const std::vector<Loop>& cuts, const Vector2d& p, double tolerance) {
  return std::any_of(cuts.begin(), cuts.end(), [&](const Loop& cut) {
    return (cut.front() - p).norm() <= tolerance || (cut.back() - p).norm() <= tolerance;
  });
}

/// Begins on the border, on another cut or in the ground, ends there too, and meets nothing on the
/// way but ends of earlier cuts on it (a tear may end on a younger one).
/// @param others  the pattern with the cuts before this one
void require_cut(const Pattern& others, const Loop& cut, const std::string& where) {
  const double across = width(others), nearest = kNearest * across;
  if (cut.size() < 2) throw Error("cut has fewer than two points", where, "at least 2");
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const std::string here = where + " point " + std::to_string(i);
    if (!cut[i].allFinite()) throw Error("point of a cut is not finite", here, "finite numbers");
    const bool at_end = i == 0 || i + 1 == cut.size();
    if (!contains(others, cut[i], at_end ? nearest : 0)) {
      throw Error("cut leaves the pattern", here, "points of the pattern");
    }
    const double distance = nearest_on_border(others, cut[i]).distance;
    // An end lies on the border, or the mesher's rounding decides.
    if (at_end ? distance > 1e-9 * across && distance < nearest : distance < nearest) {
      throw Error("cut comes too near to the border, a hole or another cut", here,
                  "ends on them, or points apart from them");
    }
    if (i == 0) continue;
    if ((cut[i] - cut[i - 1]).norm() < nearest)
      throw Error("cut stands still", here, "points apart from each other");
    for (std::size_t j = 1; j + 1 < i; ++j) {
      if (segments_meet(cut[i - 1], cut[i], cut[j - 1], cut[j]))
        throw Error("cut crosses itself", here, "an open line that does not meet itself");
    }
    const Vector2d along = cut[i] - cut[i - 1];
    each_edge(others, [&](const Vector2d& a, const Vector2d& b) {
      const auto t = ray_hit(cut[i - 1], along, a, b, 1e-6);
      if (t && *t < 1 - 1e-6 && !ends_at(others.cuts, cut[i - 1] + *t * along, 1e-9 * across)) {
        throw Error("cut crosses the border, a hole or another cut", here,
                    "a line that ends where it meets them");
      }
    });
  }
}

/// Looks at edges in order, and keeps the point nearest to p.
struct NearestEdge {
  explicit NearestEdge(const Vector2d& to) : p(to) {
    best.distance = std::numeric_limits<double>::infinity();
  }
  void operator()(const Vector2d& a, const Vector2d& b) {
    const Vector2d along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vector2d point = t == 1 ? b : Vector2d(a + t * along);
    const double distance = (p - point).norm();
    if (distance < best.distance) best = {point, edge, t, distance};
    ++edge;
  }
  const Vector2d& p;
  BorderPoint best;
  int edge = 0;
};

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

std::vector<Vector2d> corners(const Pattern& pattern) {
  std::vector<Vector2d> all = pattern.border;
  for (const Loop& hole : pattern.holes) all.insert(all.end(), hole.begin(), hole.end());
  return all;
}

int edge_count(const Pattern& pattern) {
  int count = 0;
  each_edge(pattern, [&](const Vector2d&, const Vector2d&) { ++count; });
  return count;
}

int next_edge(const Pattern& pattern, int edge) {
  int first = 0;
  for (std::size_t k = 0; k < pattern.loop_count(); ++k) {
    const int n = static_cast<int>(pattern.loop(k).size());
    if (edge < first + n) return edge + 1 == first + n ? first : edge + 1;
    first += n;
  }
  throw Error("edge " + std::to_string(edge) + " is not there", "pattern",
              "fewer than " + std::to_string(first));
}

Eigen::AlignedBox2d bounding_box(const Pattern& pattern) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : pattern.border) box.extend(p);
  return box;
}

Pattern oriented(Pattern pattern) {
  if (loop_area(pattern.border) < 0) std::reverse(pattern.border.begin(), pattern.border.end());
  for (Loop& hole : pattern.holes) {
    if (loop_area(hole) > 0) std::reverse(hole.begin(), hole.end());
  }
  return pattern;
}

void require_simple_loops(const Pattern& pattern, const std::string& where) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < pattern.loop_count(); ++k) {
    require_finite(pattern.loop(k), place_of(where, k));
    count += pattern.loop(k).size();
  }
  require_count(static_cast<double>(count), "corners", kMostCorners, where);
  for (std::size_t k = 0; k < pattern.loop_count(); ++k) {
    require_distinct(pattern.loop(k), place_of(where, k));
    require_uncrossed(pattern.loop(k), place_of(where, k));
    require_area(pattern.loop(k), place_of(where, k));
  }
  for (std::size_t l = 1; l < pattern.loop_count(); ++l) {
    for (std::size_t k = 0; k < l; ++k) require_apart(pattern, k, l, where);
  }
  require_nested(pattern, where);
}

void require_simple(const Pattern& pattern, const std::string& where) {
  require_simple_loops(pattern, where);
  if (!(loop_area(pattern.border) > 0)) {
    throw Error("border of the pattern runs clockwise", where, "counter-clockwise");
  }
  for (std::size_t k = 0; k < pattern.holes.size(); ++k) {
    if (loop_area(pattern.holes[k]) < 0) continue;
    throw Error("hole of the pattern runs counter-clockwise", place_of(where, k + 1), "clockwise");
  }
  if (pattern.cuts.empty()) return;
  std::size_t points = 0;
  for (const Loop& cut : pattern.cuts) points += cut.size();
  require_count(static_cast<double>(points), "points of cuts", kMostCorners, where);
  Pattern before{pattern.border, pattern.holes};
  for (std::size_t k = 0; k < pattern.cuts.size(); ++k) {
    require_cut(before, pattern.cuts[k], cut_name(where, k));
    before.cuts.push_back(pattern.cuts[k]);
  }
}

double signed_area(const Pattern& pattern) {
  double area = loop_area(pattern.border);
  for (const Loop& hole : pattern.holes) area += loop_area(hole);
  return area;
}

double diameter(const Pattern& pattern) { return loop_diameter(pattern.border); }

double width(const Pattern& pattern) {
  return pattern.border.empty() ? 0 : bounding_box(pattern).sizes().maxCoeff();
}

double band_width(const Pattern& pattern) {
  double length = 0;
  each_loop_edge(pattern, [&](const Vector2d& a, const Vector2d& b) { length += (b - a).norm(); });
  const double half = length / 2;
  return (half - std::sqrt(std::max(0.0, half * half - 4 * signed_area(pattern)))) / 2;
}

bool contains(const Pattern& pattern, const Vector2d& p, double tolerance) {
  int turns = 0;
  for (std::size_t k = 0; k < pattern.loop_count(); ++k) turns += turns_about(pattern.loop(k), p);
  // Beside a cut there is ground on both sides.
  return turns != 0 || nearest_on_loops(pattern, p).distance <= tolerance;
}

std::optional<Vector2d> leaves_pattern(const Pattern& pattern, const Vector2d& a, const Vector2d& b,
                                       double tolerance) {
  const Vector2d along = b - a;
  std::vector<double> stops{0, 1};
  each_edge(pattern, [&](const Vector2d& c, const Vector2d& d) {
    if (!segments_meet(a, b, c, d)) return;
    // Edges on the segment's line begin and end on others that cross it, or at its ends.
    for (const Vector2d& corner : {c, d}) {
      if (distance_to_segment(corner, a, b) <= tolerance)
        stops.push_back((corner - a).dot(along) / along.squaredNorm());
    }
    const double det = cross(along, d - c);
    if (det != 0) stops.push_back(cross(c - a, d - c) / det);
  });
  std::sort(stops.begin(), stops.end());
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const double from = std::clamp(stops[i], 0.0, 1.0), to = std::clamp(stops[i + 1], 0.0, 1.0);
    const Vector2d middle = a + (from + to) / 2 * along;
    if (!contains(pattern, middle, tolerance)) return middle;
  }
  return std::nullopt;
}

BorderPoint nearest_on_border(const Pattern& pattern, const Vector2d& p) {
  NearestEdge nearest(p);
  each_edge(pattern, nearest);
  return nearest.best;
}

BorderPoint nearest_on_loops(const Pattern& pattern, const Vector2d& p) {
  NearestEdge nearest(p);
  each_loop_edge(pattern, nearest);
  return nearest.best;
}

double distance_to_cuts(const Pattern& pattern, const Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  each_cut_edge(pattern, [&](const Vector2d& a, const Vector2d& b) {
    nearest = std::min(nearest, distance_to_segment(p, a, b));
  });
  return nearest;
}

}  // namespace geoprior::paper
