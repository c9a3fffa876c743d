#include "solvers/fluid/tracking/links.h"

#include <algorithm>
#include <cmath>

#include "solvers/fluid/tracking/path_cover.h"

namespace geoprior::fluid {
namespace {

double square(double x) { return x * x; }

/// Regions of every frame in the order of their centres' x: a window of it holds all within reach.
class FrameIndex {
 public:
  FrameIndex(std::span<const Region> regions, std::size_t frames) : regions_(regions) {
    order_.resize(regions.size());
    offset_.assign(frames + 1, 0);
    for (int i = 0; i < std::ssize(regions); ++i) {
      order_[i] = i;
      ++offset_[regions[i].frame + 1];
    }
    for (std::size_t f = 0; f < frames; ++f) offset_[f + 1] += offset_[f];
    for (std::size_t f = 0; f < frames; ++f) {
      std::sort(order_.begin() + offset_[f], order_.begin() + offset_[f + 1],
                [&](int a, int b) { return x_of(a) != x_of(b) ? x_of(a) < x_of(b) : a < b; });
    }
  }
  /// Regions of a frame whose centres are at most `reach` from `centre` along x.
  [[nodiscard]] std::span<const int> window(int frame, double centre, double reach) const {
    const auto begin = order_.begin() + offset_[frame], end = order_.begin() + offset_[frame + 1];
    const auto first =
        std::partition_point(begin, end, [&](int r) { return x_of(r) < centre - reach; });
    const auto last =
        std::partition_point(first, end, [&](int r) { return x_of(r) <= centre + reach; });
    return {first, last};
  }

 private:
  [[nodiscard]] double x_of(int r) const { return regions_[r].centre.x(); }
  std::span<const Region> regions_;
  std::vector<int> order_;
  std::vector<std::ptrdiff_t> offset_;
};

double size_cost(const Region& a, const Region& b, const TrackingOptions& options) {
  double cost = 0;
  if (a.area > 0 && b.area > 0) cost += square(std::log(b.area / a.area) / options.sigma_area);
  if (a.kind == RegionKind::isolated && a.volume > 0 && b.volume > 0)
    cost += square(std::log(b.volume / a.volume) / options.sigma_volume);
  return cost;
}

bool is_too_fast(const Region& a, const Region& b, double dt, const TrackingOptions& options) {
  return options.largest_speed && (b.centre - a.centre).norm() > *options.largest_speed * dt;
}

/// Cost of finding `seen` (m) where `motion` leads.
double prediction_cost(const Region& from, const RegionMotion& motion, const Eigen::Vector3d& seen,
                       double dt, int gap, double variance, const TrackingOptions& options) {
  const double s = gap * variance + motion.variance(dt);
  return (seen - predicted(from, motion, dt, options)).squaredNorm() / s +
         std::min(3 * std::log(s / (2 * variance)), options.new_path_cost / 2);
}

}  // namespace

GateSpeeds gate_speeds(std::span<const Region> regions, std::span<const double> times, double cell,
                       const TrackingOptions& options) {
  const FrameIndex index(regions, times.size());
  const auto nearest = [&](const Region& a, int frame) {
    int best = -1;
    double least = 0;
    for (const int j : index.window(frame, a.centre.x(), 1e300)) {
      const Region& b = regions[j];
      if (b.kind != a.kind || size_cost(a, b, options) > options.new_path_cost) continue;
      const double d = (b.centre - a.centre).squaredNorm();
      if (best >= 0 && d >= least) continue;
      least = d;
      best = j;
    }
    return best;
  };
  std::array<std::vector<double>, 2> needed;
  double interval = 0;
  for (int i = 0; i < std::ssize(regions); ++i) {
    const Region& a = regions[i];
    if (a.frame + 1 >= std::ssize(times)) break;
    const std::size_t f = a.frame;
    const double dt = times[f + 1] - times[f];
    interval = interval == 0 ? dt : std::min(interval, dt);
    const int j = nearest(a, a.frame + 1);
    if (j < 0 || nearest(regions[j], a.frame) != i) continue;
    const double way = (regions[j].centre - a.centre).norm();
    needed[a.kind == RegionKind::isolated ? 0 : 1].push_back(way / dt);
  }
  GateSpeeds result{};
  for (std::size_t k = 0; k < 2; ++k) {
    result[k] = interval > 0 ? 4 * cell / interval : cell;
    if (needed[k].empty()) continue;
    const auto at = needed[k].begin() + (needed[k].size() * 9 / 10);
    std::nth_element(needed[k].begin(), at, needed[k].end());
    result[k] = std::max(result[k], 1.5 * *at);
  }
  return result;
}

std::vector<int> first_paths(std::span<const Region> regions, std::span<const double> times,
                             double cell, const TrackingOptions& options,
                             const GateSpeeds& speeds) {
  const FrameIndex index(regions, times.size());
  std::vector<int> successor(regions.size(), -1), predecessor(regions.size(), -1);
  std::vector<PathLink> links;
  std::size_t first_open = 0;  // regions before it are too old to be linked
  for (int frame = 1; frame < std::ssize(times); ++frame) {
    links.clear();
    while (first_open < regions.size() && regions[first_open].frame < frame - options.largest_gap)
      ++first_open;
    for (std::size_t i = first_open; i < regions.size() && regions[i].frame < frame; ++i) {
      if (successor[i] >= 0) continue;
      const Region& a = regions[i];
      const int g = frame - a.frame;
      const double dt = times[frame] - times[a.frame];
      const double variance = centre_variance(a, cell, options);
      const RegionMotion past =
          region_motion(regions, times, cell, options, speeds, predecessor, i);
      const double reach =
          std::sqrt((options.new_path_cost + 3) * (g * variance + past.variance(dt)));
      for (const int to : index.window(frame, predicted(a, past, dt, options).x(), reach)) {
        const Region& b = regions[to];
        if (b.kind != a.kind || is_too_fast(a, b, dt, options)) continue;
        const double cost = prediction_cost(a, past, b.centre, dt, g, variance, options) +
                            (g - 1) * options.gap_cost + size_cost(a, b, options);
        if (cost < options.new_path_cost) links.push_back({static_cast<int>(i), to, cost});
      }
    }
    const std::vector<int> chosen =
        cover_by_paths(static_cast<int>(regions.size()), links, options.new_path_cost);
    for (const PathLink& link : links) {
      if (chosen[link.from] != link.to) continue;
      successor[link.from] = link.to;
      predecessor[link.to] = link.from;
    }
  }
  return successor;
}

std::vector<PathLink> candidate_links(std::span<const Region> regions,
                                      std::span<const double> times, double cell,
                                      const TrackingOptions& options,
                                      const RegionMotions& motions) {
  const FrameIndex index(regions, times.size());
  std::vector<PathLink> links;
  for (int i = 0; i < std::ssize(regions); ++i) {
    const Region& a = regions[i];
    const double variance = centre_variance(a, cell, options);
    for (int g = 1; g <= options.largest_gap; ++g) {
      const int frame = a.frame + g;
      if (frame >= std::ssize(times)) break;
      const double dt = times[frame] - times[a.frame];
      const RegionMotion& past = motions.from_past[i];
      // The mean of two terms, neither below 3 ln(1/2), is under c_new: so is either under twice.
      const double reach =
          std::sqrt((2 * options.new_path_cost + 6) * (g * variance + past.variance(dt)));
      const double x = predicted(a, past, dt, options).x();
      for (const int to : index.window(frame, x, reach)) {
        const Region& b = regions[to];
        if (b.kind != a.kind || is_too_fast(a, b, dt, options)) continue;
        const double ahead = prediction_cost(a, past, b.centre, dt, g, variance, options);
        const double back = prediction_cost(b, motions.from_future[to], a.centre, -dt, g,
                                            centre_variance(b, cell, options), options);
        double cost = 0.5 * (ahead + back) + (g - 1) * options.gap_cost;
        if (cost >= options.new_path_cost) continue;
        cost += size_cost(a, b, options);
        if (cost < options.new_path_cost) links.push_back({i, to, cost});
      }
    }
  }
  return links;
}

}  // namespace geoprior::fluid
