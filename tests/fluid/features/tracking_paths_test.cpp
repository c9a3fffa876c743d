#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "solvers/fluid/tracking/events.h"
#include "solvers/fluid/tracking/tracking.h"

namespace geoprior::fluid {
namespace {

constexpr double kTrackedCell = 0.02, kStep = 1.0 / 30;

std::vector<double> times(int frames) {
  std::vector<double> t;
  for (int f = 0; f < frames; ++f) t.push_back(f * kStep);
  return t;
}

Region region(int frame, RegionKind kind, const Eigen::Vector3d& centre, double radius) {
  Region r;
  r.frame = frame;
  r.kind = kind;
  r.centre = centre;
  const double disc = std::numbers::pi * radius * radius;
  r.area = kind == RegionKind::isolated ? 4 * disc : disc;
  r.volume = kind == RegionKind::isolated ? 4.0 / 3 * disc * radius : 0;
  const double high = kind == RegionKind::isolated ? radius : kTrackedCell;
  const Eigen::Vector3d half(radius, radius, high);
  r.box_min = centre - half;
  r.box_max = centre + half;
  const auto cube = [](double x) {
    return static_cast<std::int64_t>(std::floor(x / (2 * kTrackedCell)));
  };
  for (double x = r.box_min.x(); x <= r.box_max.x(); x += kTrackedCell) {
    for (double y = r.box_min.y(); y <= r.box_max.y(); y += kTrackedCell)
      r.support.push_back(support_key(cube(x), cube(y), cube(centre.z())));
  }
  std::sort(r.support.begin(), r.support.end());
  r.support.erase(std::unique(r.support.begin(), r.support.end()), r.support.end());
  return r;
}
Region drop(int frame, const Eigen::Vector3d& centre, double radius = 0.05) {
  return region(frame, RegionKind::isolated, centre, radius);
}
Region wave(int frame, double x, double y, double radius = 0.15) {
  return region(frame, RegionKind::differential, {x, y, 0}, radius);
}

/// Two equal drops on one line, head on, that pass through each other's prediction by staying.
std::vector<Region> crossing_drops(int frames) {
  std::vector<Region> regions;
  for (int f = 0; f < frames; ++f) {
    const double t = (f - 0.5 * (frames - 1)) * kStep, z = 1 - 0.5 * 9.81 * t * t;
    regions.push_back(drop(f, {0.9 * t, 0, z}));
    regions.push_back(drop(f, {-0.9 * t, 0.01, z}));
  }
  return regions;
}

/// Regions come in pairs: a track that keeps to one of them has numbers of one parity.
bool is_straight(const Track& track) {
  for (const int r : track.regions) {
    if (r % 2 != track.regions.front() % 2) return false;
  }
  return true;
}

TEST(Tracking, BallisticPredictionFollowsDropsThroughACrossing) {
  const std::vector<Region> regions = crossing_drops(20);
  const TrackResult result = track_regions(regions, times(20), kTrackedCell, {});
  ASSERT_EQ(result.tracks.size(), 2u);
  for (const Track& track : result.tracks) {
    EXPECT_EQ(track.regions.size(), 20u);
    EXPECT_TRUE(is_straight(track));
    EXPECT_EQ(track.kind, RegionKind::isolated);
  }
}

TEST(Tracking, VelocitiesThatAreGivenAreUsed) {
  // 12 cells a frame, and from the second frame on beside each other's old places.
  std::vector<Region> regions;
  for (int f = 0; f < 5; ++f) {
    for (const double lane : {0.0, 1.0}) {
      Region r = drop(f, {0.24 * (f + lane), 0, 1});
      r.velocity = {0.24 / kStep, 0, 0};
      r.has_velocity = true;
      regions.push_back(r);
    }
  }
  TrackingOptions options;
  options.ballistic = false;
  const TrackResult result = track_regions(regions, times(5), kTrackedCell, options);
  ASSERT_EQ(result.tracks.size(), 2u);
  for (const Track& track : result.tracks) EXPECT_TRUE(is_straight(track));
}

TEST(Tracking, GapsAreBridgedUpToTheLargest) {
  std::vector<Region> regions;
  for (int f = 0; f < 16; ++f) {
    if (f != 6 && f != 7) regions.push_back(wave(f, 0.02 * f, 0));
  }
  EXPECT_EQ(track_regions(regions, times(16), kTrackedCell, {}).tracks.size(), 1u);
  TrackingOptions options;
  options.largest_gap = 2;
  EXPECT_EQ(track_regions(regions, times(16), kTrackedCell, options).tracks.size(), 2u);
}

TEST(Tracking, KindsAreNeverLinkedNorVeryDifferentSizes) {
  const TrackResult kinds =
      track_regions({drop(0, {0, 0, 0.1}), wave(1, 0, 0)}, times(2), kTrackedCell, {});
  EXPECT_EQ(kinds.tracks.size(), 2u);
  // ln(area ratio) = 2 ln 3 is 4.4 sigma.
  const TrackResult sizes =
      track_regions({wave(0, 0, 0, 0.1), wave(1, 0, 0, 0.3)}, times(2), kTrackedCell, {});
  EXPECT_EQ(sizes.tracks.size(), 2u);
}

TEST(Tracking, EveryRegionIsInOneTrackAndIdsFollowTheirBeginnings) {
  RandomStream random(9, "regions");
  std::vector<Region> regions;
  for (int f = 0; f < 12; ++f) {
    for (int i = 0; i < 10; ++i)
      regions.push_back(wave(f, 3 * random.uniform(), 3 * random.uniform()));
  }
  for (const AssignmentKind kind :
       {AssignmentKind::flow, AssignmentKind::frame_by_frame, AssignmentKind::greedy}) {
    TrackingOptions options;
    options.assignment = kind;
    const TrackResult result = track_regions(regions, times(12), kTrackedCell, options);
    std::vector<int> seen(regions.size(), 0);
    int last_begin = 0;
    for (int t = 0; t < std::ssize(result.tracks); ++t) {
      const Track& track = result.tracks[t];
      EXPECT_EQ(track.id, t + 1);
      EXPECT_GE(track.regions.front(), last_begin);
      last_begin = track.regions.front();
      for (std::size_t k = 0; k < track.regions.size(); ++k) {
        ++seen[track.regions[k]];
        if (k > 0) {
          EXPECT_GT(regions[track.regions[k]].frame, regions[track.regions[k - 1]].frame);
        }
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<int>(regions.size()));
  }
}

// With links between consecutive frames only, the flow is the assignments frame by frame.
TEST(Tracking, FlowEqualsFrameByFrameWithoutGaps) {
  RandomStream random(2, "walkers");
  std::vector<Eigen::Vector2d> at(15);
  for (auto& x : at) x = {random.uniform(), random.uniform()};
  std::vector<Region> regions;
  for (int f = 0; f < 15; ++f) {
    for (auto& x : at) {
      x += 0.02 * Eigen::Vector2d(random.normal(), random.normal());
      regions.push_back(wave(f, x.x(), x.y(), 0.1));
    }
  }
  TrackingOptions options;
  options.largest_gap = 1;
  const TrackResult flow = track_regions(regions, times(15), kTrackedCell, options);
  options.assignment = AssignmentKind::frame_by_frame;
  const TrackResult frames = track_regions(regions, times(15), kTrackedCell, options);
  ASSERT_EQ(flow.tracks.size(), frames.tracks.size());
  for (std::size_t t = 0; t < flow.tracks.size(); ++t)
    EXPECT_EQ(flow.tracks[t].regions, frames.tracks[t].regions);
}

TEST(Tracking, ADropThatEndsCausesTheWaveThatBeginsThere) {
  std::vector<Region> regions;
  for (int f = 0; f < 6; ++f) {
    const double t = (5 - f) * kStep;
    regions.push_back(drop(f, {0.3, 0.2, 0.08 + 2 * t}));
  }
  for (int f = 7; f < 12; ++f) {
    regions.push_back(wave(f, 0.3, 0.2, 0.1 + 0.01 * f));
    regions.push_back(wave(f, 1.5, 0.2, 0.1 + 0.01 * f));  // too far to be its doing
  }
  const TrackResult result = track_regions(regions, times(12), kTrackedCell, {});
  ASSERT_EQ(result.tracks.size(), 3u);
  ASSERT_EQ(result.events.size(), 1u);
  EXPECT_EQ(result.events[0].kind, TrackEventKind::causes);
  EXPECT_EQ(result.events[0].frame, 7);
  EXPECT_EQ(result.events[0].from, 1);
  EXPECT_EQ(result.events[0].to, 2);
}

TEST(Tracking, SplitsAndMergesAreEventsBetweenTracks) {
  // One wave; in frame 5 a small piece beside it is its own until frame 9.
  std::vector<Region> regions;
  for (int f = 0; f < 14; ++f) {
    regions.push_back(wave(f, 0, 0, 0.2));
    if (f >= 5 && f <= 9) regions.push_back(wave(f, 0.2, 0, 0.06));
  }
  const TrackResult result = track_regions(regions, times(14), kTrackedCell, {});
  ASSERT_EQ(result.tracks.size(), 2u);
  ASSERT_EQ(result.events.size(), 2u);
  EXPECT_EQ(result.events[0].kind, TrackEventKind::split);
  EXPECT_EQ(result.events[0].frame, 5);
  EXPECT_EQ(result.events[0].from, 1);
  EXPECT_EQ(result.events[0].to, 2);
  EXPECT_EQ(result.events[1].kind, TrackEventKind::merge);
  EXPECT_EQ(result.events[1].frame, 10);
  EXPECT_EQ(result.events[1].from, 2);
  EXPECT_EQ(result.events[1].to, 1);
}

TEST(Tracking, SupportsOverlapWhereTheyHaveMoved) {
  const Region a = wave(0, 0, 0), b = wave(1, 1, 0);
  EXPECT_EQ(support_overlap(a, b, Eigen::Vector3d::Zero(), kTrackedCell), 0);
  EXPECT_EQ(support_overlap(a, b, {1, 0, 0}, kTrackedCell), 1);
}

TEST(Tracking, NothingGivesNothingAndDisorderIsAnError) {
  EXPECT_TRUE(track_regions({}, {}, kTrackedCell, {}).tracks.empty());
  EXPECT_TRUE(track_regions({}, times(3), kTrackedCell, {}).tracks.empty());
  EXPECT_THROW(track_regions({wave(1, 0, 0), wave(0, 0, 0)}, times(2), kTrackedCell, {}), Error);
  EXPECT_THROW(track_regions({wave(2, 0, 0)}, times(2), kTrackedCell, {}), Error);
}

}  // namespace
}  // namespace geoprior::fluid
