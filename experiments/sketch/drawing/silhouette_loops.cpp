#include "experiments/sketch/drawing/silhouette_loops.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

double twice_signed_area(const std::vector<Eigen::Vector2d>& points) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += cross(points[i] - points[0], points[(i + 1) % points.size()] - points[0]);
  return sum;
}

/// Grows a stroke at its last point until that is its first.
class SilhouetteChain {
 public:
  SilhouetteChain(Stroke first, std::vector<Stroke>& open, double snap)
      : chain_(std::move(first)),
        last_(chain_.id),
        length_(length(chain_)),
        open_(open),
        snap_(snap) {}

  std::optional<SilhouetteGap> close() {
    while (true) {
      const Eigen::Vector2d end = chain_.points.back();
      const auto [nearest, at_its_end] = nearest_free_end(end);
      const bool own = nearest == open_.size();
      const Stroke& next = own ? chain_ : open_[nearest];
      const Eigen::Vector2d target = at_its_end ? next.points.back() : next.points.front();
      if ((target - end).norm() > snap_) return SilhouetteGap{last_, next.id, end, target};
      if (end != target) closed_.push_back({last_, next.id, end, target});
      chain_.points.back() = (end + target) / 2;
      if (own) {
        chain_.points.front() = chain_.points.back();
        chain_.points.pop_back();
        chain_.closed = true;
        return std::nullopt;
      }
      append(nearest, at_its_end);
    }
  }

  Stroke take() { return std::move(chain_); }
  [[nodiscard]] const std::vector<SilhouetteGap>& closed() const { return closed_; }

 private:
  /// Which stroke, `open_.size()` for the chain itself, and whether its last point.
  [[nodiscard]] std::pair<std::size_t, bool> nearest_free_end(const Eigen::Vector2d& end) const {
    // Of equally near ones the chain's own start: it closes what can be closed.
    std::pair<std::size_t, bool> nearest{open_.size(), false};
    double least = (chain_.points.front() - end).norm();
    // A chain that has not yet left its start is not closed by it.
    if (length_ <= 2 * snap_) least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < open_.size(); ++i) {
      for (const bool last : {false, true}) {
        const double distance =
            ((last ? open_[i].points.back() : open_[i].points.front()) - end).norm();
        if (distance < least) {
          least = distance;
          nearest = {i, last};
        }
      }
    }
    return nearest;
  }

  void append(std::size_t which, bool backwards) {
    Stroke next = std::move(open_[which]);
    open_.erase(open_.begin() + which);
    if (backwards) std::reverse(next.points.begin(), next.points.end());
    chain_.points.insert(chain_.points.end(), next.points.begin() + 1, next.points.end());
    chain_.id += "+" + next.id;
    length_ += length(next);
    last_ = next.id;
  }

  Stroke chain_;
  std::string last_;  ///< id of the stroke at its end
  std::vector<SilhouetteGap> closed_;
  double length_;
  std::vector<Stroke>& open_;
  double snap_;
};

Eigen::Vector2d meeting_point(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                              const Eigen::Vector2d& c, const Eigen::Vector2d& d) {
  const double turn = cross(b - a, d - c);
  if (turn == 0) return (b + c) / 2;  // on one line
  return a + std::clamp(cross(c - a, d - c) / turn, 0.0, 1.0) * (b - a);
}

/// StrokeChords of a stroke by their index.
class StrokeChords {
 public:
  explicit StrokeChords(const Stroke& stroke)
      : points_(stroke.points), closed_(stroke.closed && stroke.points.size() > 2) {}

  [[nodiscard]] std::size_t size() const { return points_.size() - (closed_ ? 0 : 1); }
  [[nodiscard]] const Eigen::Vector2d& from(std::size_t i) const { return points_[i]; }
  [[nodiscard]] const Eigen::Vector2d& to(std::size_t i) const {
    return points_[(i + 1) % points_.size()];
  }
  [[nodiscard]] double low(std::size_t i, int axis) const {
    return std::min(from(i)[axis], to(i)[axis]);
  }
  [[nodiscard]] double high(std::size_t i, int axis) const {
    return std::max(from(i)[axis], to(i)[axis]);
  }
  /// The axis along which they are shorter all together: there fewer of them overlap.
  [[nodiscard]] int short_axis() const {
    Eigen::Vector2d extent(0, 0);
    for (std::size_t i = 0; i < size(); ++i) extent += (to(i) - from(i)).cwiseAbs();
    return extent.x() <= extent.y() ? 0 : 1;
  }

  /// Where chord i meets chord j, a later one.
  [[nodiscard]] std::optional<Eigen::Vector2d> meeting(std::size_t i, std::size_t j) const {
    const bool follows = j == i + 1, precedes = closed_ && i == 0 && j + 1 == size();
    if (follows || precedes) {
      // Neighbours share a point; they share more when the line turns back on itself.
      const std::size_t first = follows ? i : j, second = follows ? j : i;
      const Eigen::Vector2d &a = from(first), &b = to(first), &c = to(second);
      if (orientation(a, b, c) == 0 && (b - a).dot(c - b) < 0) return b;
      return std::nullopt;
    }
    for (const int axis : {0, 1}) {
      if (high(i, axis) < low(j, axis) || high(j, axis) < low(i, axis)) return std::nullopt;
    }
    if (!segments_meet(from(i), to(i), from(j), to(j))) return std::nullopt;
    return meeting_point(from(i), to(i), from(j), to(j));
  }

 private:
  const std::vector<Eigen::Vector2d>& points_;
  bool closed_;
};

}  // namespace

SilhouetteLoops join_silhouettes(std::span<const Stroke> strokes, double snap) {
  SilhouetteLoops result;
  std::vector<Stroke> open;
  for (const Stroke& stroke : strokes) (stroke.closed ? result.loops : open).push_back(stroke);
  while (!open.empty() && !result.gap) {
    Stroke first = std::move(open.front());
    open.erase(open.begin());
    SilhouetteChain chain(std::move(first), open, snap);
    result.gap = chain.close();
    result.closed.insert(result.closed.end(), chain.closed().begin(), chain.closed().end());
    if (!result.gap) result.loops.push_back(chain.take());
  }
  for (Stroke& loop : result.loops) {
    if (twice_signed_area(loop.points) < 0) std::reverse(loop.points.begin(), loop.points.end());
  }
  return result;
}

std::optional<Eigen::Vector2d> self_crossing(const Stroke& stroke) {
  if (stroke.points.size() < 3) return std::nullopt;
  const StrokeChords chords(stroke);
  const int axis = chords.short_axis();
  std::vector<std::size_t> in_order(chords.size());
  std::iota(in_order.begin(), in_order.end(), std::size_t{0});
  std::stable_sort(in_order.begin(), in_order.end(), [&](std::size_t a, std::size_t b) {
    return chords.low(a, axis) < chords.low(b, axis);
  });
  std::pair<std::size_t, std::size_t> first{chords.size(), 0};
  std::optional<Eigen::Vector2d> point;
  for (std::size_t k = 0; k < in_order.size(); ++k) {
    for (std::size_t m = k + 1;
         m < in_order.size() && chords.low(in_order[m], axis) <= chords.high(in_order[k], axis);
         ++m) {
      const std::pair<std::size_t, std::size_t> pair = std::minmax({in_order[k], in_order[m]});
      if (pair >= first) continue;
      if (const auto meeting = chords.meeting(pair.first, pair.second)) {
        first = pair;
        point = meeting;
      }
    }
  }
  return point;
}

}  // namespace geoprior::sketch
