#include "solvers/fluid/tracking/tracking.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "solvers/fluid/tracking/events.h"
#include "solvers/fluid/tracking/links.h"
#include "solvers/fluid/tracking/path_cover.h"

namespace geoprior::fluid {
namespace {

constexpr int kMostRounds = 4;
/// Frame after frame, the best assignment of its regions to the paths that are open then.
std::vector<int> frame_by_frame(std::span<const Region> regions, const std::vector<PathLink>& links,
                                double new_path_cost) {
  std::vector<PathLink> by_target = links;
  std::stable_sort(by_target.begin(), by_target.end(), [&](const PathLink& a, const PathLink& b) {
    return regions[a.to].frame < regions[b.to].frame;
  });
  const int nodes = static_cast<int>(regions.size());
  std::vector<int> successor(regions.size(), -1);
  std::vector<PathLink> open;
  for (std::size_t begin = 0, end = 0; begin < by_target.size(); begin = end) {
    const int frame = regions[by_target[begin].to].frame;
    open.clear();
    for (; end < by_target.size(); ++end) {
      const PathLink& link = by_target[end];
      if (regions[link.to].frame != frame) break;
      if (successor[link.from] < 0) open.push_back(link);
    }
    const std::vector<int> chosen = cover_by_paths(nodes, open, new_path_cost);
    for (const PathLink& link : open) {
      if (chosen[link.from] >= 0) successor[link.from] = chosen[link.from];
    }
  }
  return successor;
}

/// The cheapest link whose ends are free, again and again.
std::vector<int> greedy(std::size_t nodes, std::vector<PathLink> links) {
  std::sort(links.begin(), links.end(), [](const PathLink& a, const PathLink& b) {
    if (a.cost != b.cost) return a.cost < b.cost;
    return a.from != b.from ? a.from < b.from : a.to < b.to;
  });
  std::vector<int> successor(nodes, -1);
  std::vector<char> entered(nodes, 0);
  for (const PathLink& link : links) {
    int& next = successor[link.from];
    char& taken = entered[link.to];
    if (next >= 0 || taken != 0) continue;
    next = link.to;
    taken = 1;
  }
  return successor;
}

std::vector<int> assign(std::span<const Region> regions, const std::vector<PathLink>& links,
                        const TrackingOptions& options) {
  switch (options.assignment) {
    case AssignmentKind::flow:
      return cover_by_paths(static_cast<int>(regions.size()), links, options.new_path_cost);
    case AssignmentKind::frame_by_frame:
      return frame_by_frame(regions, links, options.new_path_cost);
    case AssignmentKind::greedy:
      return greedy(regions.size(), links);
  }
  return {};
}

std::vector<Track> tracks_of(std::span<const Region> regions, const std::vector<int>& successor) {
  std::vector<char> entered(regions.size(), 0);
  for (const int s : successor) {
    if (s >= 0) entered[s] = 1;
  }
  std::vector<Track> tracks;
  for (int i = 0; i < std::ssize(regions); ++i) {
    if (entered[i] != 0) continue;
    Track& track = tracks.emplace_back();
    track.id = static_cast<int>(tracks.size());
    track.kind = regions[i].kind;
    for (int r = i; r >= 0; r = successor[r]) track.regions.push_back(r);
  }
  return tracks;
}

void require_ordered(std::span<const Region> regions, std::span<const double> times) {
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const int frame = regions[i].frame;
    if (frame < 0 || frame >= std::ssize(times) || (i > 0 && frame < regions[i - 1].frame)) {
      throw Error("frame " + std::to_string(frame), "region " + std::to_string(i),
                  "frames that have a time, in order");
    }
  }
}

}  // namespace

TrackResult track_regions(const std::vector<Region>& regions, const std::vector<double>& times,
                          double cell, const TrackingOptions& options) {
  require_ordered(regions, times);
  TrackResult result;
  const GateSpeeds speeds = gate_speeds(regions, times, cell, options);
  std::vector<int> successor = first_paths(regions, times, cell, options, speeds);
  // Paths tell how regions move, and motions tell the paths: a few rounds settle both.
  for (int round = 0; round < kMostRounds; ++round) {
    const RegionMotions motions = region_motions(regions, times, cell, options, speeds, successor);
    result.links = candidate_links(regions, times, cell, options, motions);
    std::vector<int> next = assign(regions, result.links, options);
    const bool settled = next == successor;
    successor = std::move(next);
    if (settled) break;
  }
  result.tracks = tracks_of(regions, successor);
  result.events = track_events(regions, times, cell, options, result.tracks, successor,
                               region_motions(regions, times, cell, options, speeds, successor));
  return result;
}

}  // namespace geoprior::fluid
