#include "experiments/sketch/pattern/clear_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

namespace geoprior::sketch {
namespace {

constexpr double kClearPrecision = 0.02;  // of the box, or of a hundredth of the loops' height
constexpr int kMostClearCells = 20000;

/// Distance of the origin from a segment in the maximum norm.
///
/// max(|x(t)|, |y(t)|) is convex and piecewise linear in t: its least value lies at an end, where a
/// coordinate vanishes, or where both are equal.
double maximum_norm_distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d d = b - a;
  const std::array<std::pair<double, double>, 4> zeros{{{-a.x(), d.x()},
                                                        {-a.y(), d.y()},
                                                        {a.y() - a.x(), d.x() - d.y()},
                                                        {-a.x() - a.y(), d.sum()}}};
  double least = std::min(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  for (const auto& [numerator, denominator] : zeros) {
    if (denominator == 0) continue;
    const double t = std::clamp(numerator / denominator, 0.0, 1.0);
    least = std::min(least, (a + t * d).cwiseAbs().maxCoeff());
  }
  return least;
}

std::vector<PlaneSegment> segments_of_loops(const std::vector<PlaneLoop>& loops) {
  std::vector<PlaneSegment> segments;
  for (const PlaneLoop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      segments.push_back({loop[i], loop[(i + 1) % loop.size()]});
    }
  }
  return segments;
}

bool is_inside_loops(const Eigen::Vector2d& p, const std::vector<PlaneSegment>& borders) {
  bool inside = false;
  for (const auto& [a, b] : borders) {
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x()) inside = !inside;
  }
  return inside;
}

/// Room about a point: half the height of its largest clear box; negative outside.
class ClearRoom {
 public:
  ClearRoom(const std::vector<PlaneLoop>& loops, const std::vector<PlaneSegment>& obstacles,
            double aspect)
      : borders_(segments_of_loops(loops)), all_(borders_), scale_(1 / aspect, 1) {
    all_.insert(all_.end(), obstacles.begin(), obstacles.end());
  }

  [[nodiscard]] double operator()(const Eigen::Vector2d& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : all_) {
      least = std::min(
          least, maximum_norm_distance((a - p).cwiseProduct(scale_), (b - p).cwiseProduct(scale_)));
    }
    return is_inside_loops(p, borders_) ? least : -least;
  }

 private:
  std::vector<PlaneSegment> borders_, all_;
  Eigen::Vector2d scale_;
};

struct ClearCell {
  Eigen::Vector2d middle;
  double half;  ///< of the cell's height; its width is `aspect` times as large
  double room;

  [[nodiscard]] double most() const { return room + half; }
  friend bool operator<(const ClearCell& a, const ClearCell& b) { return a.most() < b.most(); }
};

}  // namespace

Eigen::AlignedBox2d largest_clear_box(const std::vector<PlaneLoop>& loops,
                                      const std::vector<PlaneSegment>& obstacles, double aspect) {
  Eigen::AlignedBox2d box;
  for (const PlaneLoop& loop : loops) {
    for (const Eigen::Vector2d& p : loop) box.extend(p);
  }
  if (box.isEmpty()) return {};
  const ClearRoom room(loops, obstacles, aspect);
  const double height = std::max(box.sizes().y(), box.sizes().x() / aspect);
  ClearCell best{box.center(), height / 2, room(box.center())};
  std::priority_queue<ClearCell> open;
  open.push(best);
  for (int cells = 0; !open.empty() && cells < kMostClearCells; ++cells) {
    const ClearCell cell = open.top();
    open.pop();
    if (cell.most() <= best.room + kClearPrecision * std::max(best.room, 0.01 * height)) break;
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-1.0, 1.0}) {
        const double half = cell.half / 2;
        const Eigen::Vector2d middle = cell.middle + half * Eigen::Vector2d(sx * aspect, sy);
        const ClearCell quarter{middle, half, room(middle)};
        if (quarter.room > best.room) best = quarter;
        open.push(quarter);
      }
    }
  }
  if (!(best.room > 0)) return {};
  const Eigen::Vector2d reach = best.room * Eigen::Vector2d(aspect, 1);
  return {Eigen::Vector2d(best.middle - reach), Eigen::Vector2d(best.middle + reach)};
}

bool is_clear(const Eigen::AlignedBox2d& box, const std::vector<PlaneLoop>& loops,
              const std::vector<PlaneSegment>& obstacles) {
  const Eigen::Vector2d sizes = box.sizes();
  const ClearRoom room(loops, obstacles, sizes.x() / sizes.y());
  return room(box.center()) >= sizes.y() / 2;
}

}  // namespace geoprior::sketch
