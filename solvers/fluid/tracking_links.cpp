#include "solvers/fluid/tracking_links.h"

#include <algorithm>
#include <cmath>

namespace geoprior {
namespace {

double square(double x) { return x * x; }

/// Regions of every frame in the order of their centres' x: a window of it holds all within reach.
class FrameIndex {
 public:
  FrameIndex(std::span<const Region> regions, std::size_t frames) : regions_(regions) {
    order_.resize(regions.size());
    offset_.assign(frames + 1, 0);
    for (std::size_t i = 0; i < regions.size(); ++i) {
      order_[i] = static_cast<int>(i);
      ++offset_[static_cast<std::size_t>(regions[i].frame) + 1];
    }
    for (std::size_t f = 0; f < frames; ++f) offset_[f + 1] += offset_[f];
    for (std::size_t f = 0; f < frames; ++f) {
      std::sort(order_.begin() + offset_[f], order_.begin() + offset_[f + 1],
                [&](int a, int b) { return x_of(a) != x_of(b) ? x_of(a) < x_of(b) : a < b; });
    }
  }
  /// Regions of a frame whose centres are at most `reach` from `centre` along x.
  [[nodiscard]] std::span<const int> window(int frame, double centre, double reach) const {
    const auto f = static_cast<std::size_t>(frame);
    const auto begin = order_.begin() + offset_[f], end = order_.begin() + offset_[f + 1];
    const auto first =
        std::partition_point(begin, end, [&](int r) { return x_of(r) < centre - reach; });
    const auto last =
        std::partition_point(first, end, [&](int r) { return x_of(r) <= centre + reach; });
    return {first, last};
  }

 private:
  [[nodiscard]] double x_of(int r) const {
    return regions_[static_cast<std::size_t>(r)].centre.x();
  }
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

/// Squared error of the predictions known (their mean), else none.
std::optional<double> prediction_error(const Region& a, const Region& b,
                                       const std::optional<Eigen::Vector3d>& from_past,
                                       const std::optional<Eigen::Vector3d>& from_future, double dt,
                                       const TrackingOptions& options) {
  double sum = 0, count = 0;
  if (from_past) {
    sum += (b.centre - predicted(a, *from_past, dt, options)).squaredNorm();
    ++count;
  }
  if (from_future) {
    sum += (a.centre - predicted(b, *from_future, -dt, options)).squaredNorm();
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

}  // namespace

GateSpeeds gate_speeds(std::span<const Region> regions, std::span<const double> times, double cell,
                       const TrackingOptions& options) {
  if (options.largest_speed) return {*options.largest_speed, *options.largest_speed};
  const FrameIndex index(regions, times.size());
  std::array<std::vector<double>, 2> needed;
  double interval = 0;
  for (const Region& a : regions) {
    if (a.frame + 1 >= static_cast<int>(times.size())) break;
    const auto f = static_cast<std::size_t>(a.frame);
    const double dt = times[f + 1] - times[f];
    interval = interval == 0 ? dt : std::min(interval, dt);
    double nearest = -1;
    for (const int j : index.window(a.frame + 1, a.centre.x(), 1e300)) {
      const Region& b = regions[static_cast<std::size_t>(j)];
      if (b.kind != a.kind || size_cost(a, b, options) > options.new_path_cost) continue;
      const double d = (b.centre - a.centre).norm() / dt;
      if (nearest < 0 || d < nearest) nearest = d;
    }
    if (nearest >= 0) needed[a.kind == RegionKind::isolated ? 0 : 1].push_back(nearest);
  }
  GateSpeeds result{};
  for (std::size_t k = 0; k < 2; ++k) {
    result[k] = interval > 0 ? 4 * cell / interval : 0;
    if (needed[k].empty()) continue;
    const auto at = needed[k].begin() + static_cast<std::ptrdiff_t>(needed[k].size() * 9 / 10);
    std::nth_element(needed[k].begin(), at, needed[k].end());
    result[k] = std::max(result[k], 1.5 * *at);
  }
  return result;
}

std::vector<PathLink> candidate_links(std::span<const Region> regions,
                                      std::span<const double> times, double cell,
                                      const TrackingOptions& options, const RegionMotions& motions,
                                      const GateSpeeds& speeds) {
  const FrameIndex index(regions, times.size());
  std::vector<PathLink> links;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Region& a = regions[i];
    const double speed = speeds[a.kind == RegionKind::isolated ? 0 : 1];
    for (int g = 1; g <= options.largest_gap; ++g) {
      const int frame = a.frame + g;
      if (frame >= static_cast<int>(times.size())) break;
      const double dt =
          times[static_cast<std::size_t>(frame)] - times[static_cast<std::size_t>(a.frame)];
      const double known =
          g * square(options.sigma_centre * cell) + square(options.sigma_size) * a.area;
      const double unknown = known + square(speed * dt / 3);
      // No region further than this from where it stays or is predicted can cost less than c_new.
      const double drift =
          motions.from_past[i]
              ? (predicted(a, *motions.from_past[i], dt, options) - a.centre).norm()
              : 0.0;
      const double reach = drift + 1.5 * std::sqrt(options.new_path_cost * unknown) + speed * dt;
      for (const int to : index.window(frame, a.centre.x(), reach)) {
        const auto j = static_cast<std::size_t>(to);
        const Region& b = regions[j];
        if (b.kind != a.kind) continue;
        double cost = (g - 1) * options.gap_cost;
        const std::optional<double> error =
            prediction_error(a, b, motions.from_past[i], motions.from_future[j], dt, options);
        if (error) {
          cost += *error / known;
        } else {
          const double way = (b.centre - a.centre).squaredNorm();
          if (way > square(speed * dt) + known) continue;
          cost += way / unknown + 3 * std::log(unknown / known);
        }
        if (cost >= options.new_path_cost) continue;
        cost += size_cost(a, b, options);
        if (cost < options.new_path_cost) links.push_back({static_cast<int>(i), to, cost});
      }
    }
  }
  return links;
}

}  // namespace geoprior
