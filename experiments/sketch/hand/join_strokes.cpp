#include "experiments/sketch/hand/join_strokes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/geometry/planar.h"
#include "models/sketch/drawing/polyline.h"

namespace geoprior::sketch {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points chain_of(const Stroke& stroke) {
  Points chain = stroke.points;
  if (stroke.closed) chain.push_back(chain.front());
  return chain;
}

/// Nearest place of a line: how far, and at which arc length.
struct OnLine {
  double distance = 0, along = 0;
};
OnLine place_on_line(const Points& chain, const Eigen::Vector2d& x) {
  const BesideStroke at = beside(chain, x);
  const double along = std::clamp(at.along, 0.0, length(chain));
  return {(point_along(chain, along) - x).norm(), along};
}

/// Largest distance of most of a stretch from another line.
bool lies_along(const Points& stretch, double from, double to, const Points& other, double near) {
  constexpr int kSamples = 32, kMayStray = 3;
  int off = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double at = from + (to - from) * (i + 0.5) / kSamples;
    if (place_on_line(other, point_along(stretch, at)).distance > near) ++off;
  }
  return off <= kMayStray;
}

void leave_out_doubles(std::vector<Stroke>& strokes, double near,
                       std::vector<StrokeRepair>& repairs) {
  for (std::size_t i = 0; i < strokes.size();) {
    const Points chain = chain_of(strokes[i]);
    const double whole = length(chain);
    const auto twin = std::find_if(strokes.begin(), strokes.end(), [&](const Stroke& other) {
      if (&other == &strokes[i] || (strokes[i].closed && !other.closed)) return false;
      const Points line = chain_of(other);
      const double longer = length(line);
      const bool shorter = whole < longer || (whole == longer && &other < &strokes[i]);
      return shorter && lies_along(chain, 0, whole, line, near);
    });
    if (twin == strokes.end()) {
      ++i;
      continue;
    }
    repairs.push_back({strokes[i].id, "lies along '" + twin->id + "', and is left out",
                       chain.front(), place_on_line(chain_of(*twin), chain.front()).distance});
    strokes.erase(strokes.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Cuts an open stroke at an arc length, and keeps what is before it.
void keep_until(Stroke& stroke, double along) {
  Points kept;
  double before = 0;
  for (std::size_t i = 0; i < stroke.points.size(); ++i) {
    if (i > 0) before += (stroke.points[i] - stroke.points[i - 1]).norm();
    if (before >= along) break;
    kept.push_back(stroke.points[i]);
  }
  const Eigen::Vector2d end = point_along(stroke.points, along);
  if (kept.size() < 2 || kept.back() != end) kept.push_back(end);
  stroke.points = std::move(kept);
}

/// A stretch of an open line.
Points stretch_of(const Points& chain, double from, double to) {
  Stroke part;
  part.points = chain;
  keep_until(part, to);
  std::reverse(part.points.begin(), part.points.end());
  keep_until(part, std::min(to, length(chain)) - from);
  std::reverse(part.points.begin(), part.points.end());
  return part.points;
}

/// The arc length from which the last part of a stroke goes on beside another, whose end is given.
/// A stroke meets its own first half with its last one.
std::optional<double> overlap_from(const Stroke& stroke, const Stroke& other,
                                   const Eigen::Vector2d& end_of_other, double near) {
  const double whole = length(stroke.points);
  const bool own = &stroke == &other;
  const double first = own ? whole / 2 : 0;
  const Points tail = own ? stretch_of(stroke.points, first, whole) : stroke.points;
  const Points line = own ? stretch_of(stroke.points, 0, first) : other.points;
  const OnLine from = place_on_line(tail, end_of_other);
  const double at = first + from.along, over = whole - at;
  constexpr double kMost = 0.45;
  if (from.distance > near || over < near || over > kMost * whole) return std::nullopt;
  if (!lies_along(stroke.points, at, whole, line, near)) return std::nullopt;
  return at;
}

void cut_overlaps(std::vector<Stroke>& strokes, double near, std::vector<StrokeRepair>& repairs) {
  for (Stroke& stroke : strokes) {
    if (stroke.closed) continue;
    for (int end = 0; end < 2; ++end) {
      std::reverse(stroke.points.begin(), stroke.points.end());
      for (const Stroke& other : strokes) {
        if (other.closed || (&other == &stroke && end == 0)) continue;
        std::optional<double> from = overlap_from(stroke, other, other.points.front(), near);
        if (!from && &other != &stroke)
          from = overlap_from(stroke, other, other.points.back(), near);
        if (!from) continue;
        const double over = length(stroke.points) - *from;
        keep_until(stroke, *from);
        repairs.push_back({stroke.id,
                           &other == &stroke ? "goes on along its own start, and is cut off there"
                                             : "goes on along '" + other.id + "', and is cut off",
                           stroke.points.back(), over});
        break;
      }
    }
  }
}

/// Where the last parts of two lines, seen from their last points, cross: arc lengths.
std::optional<std::pair<double, double>> tail_crossing(const Points& a, const Points& b,
                                                       double reach) {
  const double whole_a = length(a), whole_b = length(b);
  double before_a = whole_a;
  for (std::size_t i = a.size() - 1; i > 0; --i) {
    const double step_a = (a[i] - a[i - 1]).norm();
    if (whole_a - before_a > reach) break;
    before_a -= step_a;
    double before_b = whole_b;
    for (std::size_t j = b.size() - 1; j > 0; --j) {
      if (whole_b - before_b > reach) break;
      const double step_b = (b[j] - b[j - 1]).norm();
      before_b -= step_b;
      if (!segments_meet(a[i - 1], a[i], b[j - 1], b[j])) continue;
      const Eigen::Vector2d u = a[i] - a[i - 1], v = b[j] - b[j - 1], w = b[j - 1] - a[i - 1];
      const double turn = cross(u, v);
      if (turn == 0) continue;
      const double at_a = before_a + std::clamp(cross(w, v) / turn, 0.0, 1.0) * step_a;
      const double at_b = before_b + std::clamp(cross(w, u) / turn, 0.0, 1.0) * step_b;
      if (whole_a - at_a <= reach && whole_b - at_b <= reach) return std::pair(at_a, at_b);
    }
  }
  return std::nullopt;
}

/// One end of one stroke and one of another, or both of its own.
void cut_pair(Stroke& a, bool at_end_a, Stroke& b, bool at_end_b, double near,
              std::vector<StrokeRepair>& repairs) {
  const bool own = &a == &b;
  Stroke other = b;
  if (!at_end_a) std::reverse(a.points.begin(), a.points.end());
  if (!at_end_b) std::reverse(other.points.begin(), other.points.end());
  const double whole_a = length(a.points), whole_b = length(other.points);
  const double reach = std::min({2 * near, whole_a / 3, whole_b / 3});
  const auto crossing = tail_crossing(a.points, other.points, reach);
  if (crossing) {
    const double over = std::max(whole_a - crossing->first, whole_b - crossing->second);
    if (own) {
      keep_until(a, crossing->first);
      std::reverse(a.points.begin(), a.points.end());
      keep_until(a, length(a.points) - (whole_b - crossing->second));
      std::reverse(a.points.begin(), a.points.end());
    } else {
      keep_until(a, crossing->first);
      keep_until(other, crossing->second);
    }
    if (over > 1e-9) {
      repairs.push_back({a.id,
                         own ? "crosses itself near its ends, and is cut off there"
                             : "crosses '" + b.id + "' near their ends; both are cut there",
                         a.points.back(), over});
    }
  }
  if (!at_end_a) std::reverse(a.points.begin(), a.points.end());
  if (own) return;
  if (!at_end_b) std::reverse(other.points.begin(), other.points.end());
  b = std::move(other);
}

}  // namespace

std::vector<StrokeRepair> cut_overshoots(std::vector<Stroke>& strokes, double near) {
  std::vector<StrokeRepair> repairs;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    if (strokes[i].closed) continue;
    cut_pair(strokes[i], true, strokes[i], false, near, repairs);
    for (std::size_t j = i + 1; j < strokes.size(); ++j) {
      if (strokes[j].closed) continue;
      for (const bool a : {false, true}) {
        for (const bool b : {false, true}) cut_pair(strokes[i], a, strokes[j], b, near, repairs);
      }
    }
  }
  return repairs;
}

std::vector<StrokeRepair> cut_double_strokes(std::vector<Stroke>& strokes, double near) {
  std::vector<StrokeRepair> repairs;
  leave_out_doubles(strokes, near, repairs);
  cut_overlaps(strokes, near, repairs);
  return repairs;
}

}  // namespace geoprior::sketch
