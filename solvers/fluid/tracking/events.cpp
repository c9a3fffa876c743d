#include "solvers/fluid/tracking/events.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

namespace geoprior::fluid {
namespace {

// Chosen: the thesis proposes a graph of causes, and no figures.
constexpr double kOverlapForEvent = 0.3;  ///< share of cubes that makes a split or merge
constexpr double kCauseDelay = 0.25;      ///< from a drop's end to the wave's begin, at most (s)
constexpr double kCauseReach = 6;         ///< from the drop to the wave, beside its radius (h)

/// Looks for events at the ends of tracks.
class EventFinder {
 public:
  EventFinder(std::span<const Region> regions, std::span<const double> times, double cell,
              const TrackingOptions& options, const std::vector<Track>& tracks,
              const std::vector<int>& successor, const RegionMotions& motions)
      : regions_(regions),
        times_(times),
        cell_(cell),
        options_(options),
        tracks_(tracks),
        successor_(successor),
        motions_(motions),
        track_of_(regions.size(), 0),
        begins_(regions.size(), 0),
        offset_(times.size() + 1, 0) {
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      for (const int r : tracks[t].regions) track_of_[r] = tracks[t].id;
      begins_[tracks[t].regions.front()] = 1;
    }
    for (const Region& r : regions) ++offset_[r.frame + 1];
    for (std::size_t f = 0; f < times.size(); ++f) offset_[f + 1] += offset_[f];
  }

  std::vector<TrackEvent> events() {
    for (const Track& track : tracks_) {
      const bool was_split = find_split(track);
      if (!was_split && track.kind == RegionKind::differential) find_cause(track);
      find_merge(track);
    }
    std::sort(events_.begin(), events_.end(), [](const TrackEvent& a, const TrackEvent& b) {
      return std::tie(a.frame, a.kind, a.from, a.to) < std::tie(b.frame, b.kind, b.from, b.to);
    });
    return std::move(events_);
  }

 private:
  [[nodiscard]] const Region& region(int r) const { return regions_[r]; }
  [[nodiscard]] double time_of(int r) const { return times_[region(r).frame]; }
  /// Way of a region over dt (m).
  [[nodiscard]] Eigen::Vector3d way(int r, double dt) const {
    // The better known of both: a track's first region has no past, its last no future.
    const RegionMotion& past = motions_.from_past[r];
    const RegionMotion& future = motions_.from_future[r];
    const bool by_past = past.velocity_variance <= future.velocity_variance;
    return predicted(region(r), by_past ? past : future, dt, options_) - region(r).centre;
  }
  /// Best region of `frame` that `suits` and overlaps with r, which moves if `moves_other` is not
  /// set; -1: none.
  template <class Suits>
  [[nodiscard]] int best_overlap(int r, int frame, bool moves_other, const Suits& suits) const {
    int best = -1;
    double most = kOverlapForEvent;
    const double dt = times_[frame] - time_of(r);
    const Eigen::Vector3d own_way = moves_other ? Eigen::Vector3d::Zero() : way(r, dt);
    for (int o = offset_[frame]; o < offset_[frame + 1]; ++o) {
      if (track_of_[o] == track_of_[r] || !suits(o)) continue;
      const double share = moves_other ? support_overlap(region(o), region(r), way(o, -dt), cell_)
                                       : support_overlap(region(r), region(o), own_way, cell_);
      if (share > most) {
        most = share;
        best = o;
      }
    }
    return best;
  }

  bool find_split(const Track& track) {
    const int first = track.regions.front();
    const int frame = region(first).frame;
    if (frame == 0) return false;
    const int from = best_overlap(first, frame - 1, true, [&](int o) {
      // A drop is no piece of a drop that merely passes, but of a wave that throws it.
      return successor_[o] >= 0 &&
             (region(o).kind == RegionKind::differential || track.kind == RegionKind::isolated);
    });
    if (from < 0) return false;
    add(TrackEventKind::split, frame, track_of_[from], track.id);
    return true;
  }

  void find_merge(const Track& track) {
    const int last = track.regions.back();
    const int frame = region(last).frame + 1;
    if (frame >= std::ssize(times_)) return;
    const int into = best_overlap(last, frame, false, [&](int o) {
      return begins_[o] == 0 &&
             (region(o).kind == track.kind || track.kind == RegionKind::isolated);
    });
    if (into >= 0) add(TrackEventKind::merge, frame, track.id, track_of_[into]);
  }

  void find_cause(const Track& wave) {
    const Region& first = region(wave.regions.front());
    const double begin = time_of(wave.regions.front());
    const Eigen::AlignedBox3d box(first.box_min, first.box_max);
    double nearest = std::numeric_limits<double>::infinity();
    int cause = 0;
    for (const Track& drop : tracks_) {
      const int last = drop.regions.back();
      const double delay = begin - time_of(last);
      if (drop.kind != RegionKind::isolated || delay <= 0) continue;
      const auto next = static_cast<std::size_t>(region(last).frame) + 1;
      const double step = times_[next] - time_of(last);
      if (delay > std::max(kCauseDelay, step)) continue;
      const Eigen::Vector3d at = region(last).centre, on = at + way(last, step);
      const double distance =
          std::sqrt(std::min(box.squaredExteriorDistance(at), box.squaredExteriorDistance(on)));
      const double size = std::cbrt(0.75 / std::numbers::pi * region(last).volume);
      if (distance > kCauseReach * cell_ + size || distance >= nearest) continue;
      nearest = distance;
      cause = drop.id;
    }
    if (cause > 0) add(TrackEventKind::causes, first.frame, cause, wave.id);
  }

  void add(TrackEventKind kind, int frame, int from, int to) {
    events_.push_back({kind, frame, from, to});
  }

  std::span<const Region> regions_;
  std::span<const double> times_;
  double cell_;
  const TrackingOptions& options_;
  const std::vector<Track>& tracks_;
  const std::vector<int>& successor_;
  const RegionMotions& motions_;
  std::vector<int> track_of_;  // id
  std::vector<char> begins_;
  std::vector<int> offset_;  // of the frames in regions_
  std::vector<TrackEvent> events_;
};

}  // namespace

double support_overlap(const Region& a, const Region& b, const Eigen::Vector3d& shift,
                       double cell) {
  if (a.support.empty() || b.support.empty()) return 0;
  const Eigen::Array3d reach = Eigen::Array3d::Constant(4 * cell);
  if ((a.box_min.array() + shift.array() > b.box_max.array() + reach).any() ||
      (a.box_max.array() + shift.array() < b.box_min.array() - reach).any())
    return 0;
  const auto cubes = [&](double d) { return std::llround(d / (2 * cell)); };
  const std::int64_t by = support_key(cubes(shift.x()), cubes(shift.y()), cubes(shift.z()));
  const bool a_smaller = a.support.size() <= b.support.size();
  const std::vector<std::int64_t>& small = a_smaller ? a.support : b.support;
  const std::vector<std::int64_t>& large = a_smaller ? b.support : a.support;
  std::size_t shared = 0;
  for (const std::int64_t key : small)
    shared += touches_support(large, a_smaller ? key + by : key - by);
  return static_cast<double>(shared) / static_cast<double>(small.size());
}

std::vector<TrackEvent> track_events(std::span<const Region> regions, std::span<const double> times,
                                     double cell, const TrackingOptions& options,
                                     const std::vector<Track>& tracks,
                                     const std::vector<int>& successor,
                                     const RegionMotions& motions) {
  return EventFinder(regions, times, cell, options, tracks, successor, motions).events();
}

}  // namespace geoprior::fluid
