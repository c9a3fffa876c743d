#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "experiments/fluid/injected/sequence.h"
#include "metrics/tracks/scores.h"
#include "solvers/fluid/extraction.h"
#include "tests/support/long_tests.h"

namespace geoprior::fluid {
namespace {

TrackedFrames truth_of(const InjectedSequence& sequence) {
  TrackedFrames frames(sequence.frame_count());
  for (const InjectedTruth& t : sequence.truth()) {
    frames[t.frame].push_back({t.id, t.isolated ? 1 : 0, t.centre, t.box_min, t.box_max});
  }
  return frames;
}

TrackedFrames found_in(const Extraction& extraction, int shortest) {
  TrackedFrames frames(extraction.times.size());
  for (const Track& track : extraction.tracking.tracks) {
    if (std::ssize(track.regions) < shortest) continue;
    for (const int r : track.regions) {
      const Region& region = extraction.regions[r];
      frames[region.frame].push_back({track.id, region.kind == RegionKind::isolated ? 1 : 0,
                                      region.centre, region.box_min, region.box_max});
    }
  }
  return frames;
}

/// Bumps, a merge, falling drops with rings, a crossing; the unit of lengths is that of resolution
/// 1 at every resolution: the mean edge of its mesh.
InjectedOptions scene(int resolution, std::uint64_t seed) {
  InjectedOptions options;
  options.merges = 1;
  options.rings = 2;
  options.noise = 0.02;  // h: about what contouring itself makes
  options.dropout = 0.05;
  options.longest_dropout = 2;
  options.resolution = resolution;
  options.seed = seed;
  return options;
}

ExtractionOptions with_unit() {
  ExtractionOptions options;
  options.segmentation.cell = 0.0115;
  return options;
}

Extraction extracted(const InjectedSequence& sequence) {
  RunContext context;
  return extract_regions(sequence, with_unit(), context);
}

TrackingScores scores(const InjectedSequence& sequence, const Extraction& extraction) {
  // Centres of regions and features agree to within three cells.
  return tracking_scores(truth_of(sequence), found_in(extraction, with_unit().shortest_track),
                         {TrackSimilarity::distance, 0.12, 0.5});
}

/// What is found in `scene(1, 1)`: looked at by two tests, made once.
const Extraction& found_in_first_scene() {
  static const Extraction found = extracted(InjectedSequence(scene(1, 1)));
  return found;
}

/// One seed; with GEOPRIOR_LONG, three.
TEST(LongExtraction, TracksInjectedFeaturesThroughNoiseAndDropouts) {
  for (std::uint64_t seed = 1; seed <= (test::at_length() ? 3 : 1); ++seed) {
    const InjectedSequence sequence(scene(1, seed));
    const TrackingScores s =
        scores(sequence, seed == 1 ? found_in_first_scene() : extracted(sequence));
    EXPECT_GE(s.idf1, 0.95) << "seed " << seed;
    EXPECT_EQ(s.fragments, 0) << "seed " << seed;
    EXPECT_EQ(s.switches, 0) << "seed " << seed;
    EXPECT_LT(s.lifetime_error, 1) << "seed " << seed;
  }
}

/// Twice as fine; with GEOPRIOR_LONG, also four times.
TEST(LongExtraction, FindsTheSameTracksOnFinerMeshes) {
  for (int resolution = 2; resolution <= (test::at_length() ? 4 : 2); resolution *= 2) {
    InjectedOptions options = scene(resolution, 1);
    options.bumps = 1;
    options.merges = 0;
    options.rings = options.drops = 1;
    options.frames = test::at_length() && resolution == 2 ? 30 : 18;
    const InjectedSequence sequence(options);
    const TrackingScores s = scores(sequence, extracted(sequence));
    EXPECT_GE(s.idf1, 0.95) << resolution;
    EXPECT_EQ(s.fragments, 0) << resolution;
    EXPECT_EQ(s.switches, 0) << resolution;
  }
}

TEST(LongExtraction, FindsWhatCausedTheWaves) {
  const InjectedSequence sequence(scene(1, 1));
  const Extraction& extraction = found_in_first_scene();
  const auto track_at = [&](int id, bool at_end) {
    const InjectedTruth* seen = nullptr;
    for (const InjectedTruth& t : sequence.truth()) {
      if (t.id == id && (at_end || seen == nullptr)) seen = &t;
    }
    for (const Track& track : extraction.tracking.tracks) {
      const int r = at_end ? track.regions.back() : track.regions.front();
      const Region& region = extraction.regions[r];
      if (region.frame == seen->frame && (region.centre - seen->centre).norm() < 0.06)
        return track.id;
    }
    return -1;
  };
  int causes = 0;
  for (const InjectedCause& cause : sequence.causes()) {
    if (cause.merge) continue;
    ++causes;
    const int from = track_at(cause.from, true), to = track_at(cause.to, false);
    const auto& events = extraction.tracking.events;
    EXPECT_EQ(std::count_if(events.begin(), events.end(),
                            [&](const TrackEvent& e) {
                              return e.kind == TrackEventKind::causes && e.from == from &&
                                     e.to == to;
                            }),
              1)
        << cause.from << " -> " << cause.to;
  }
  EXPECT_EQ(causes, 2);
}

TEST(Extraction, CallsBackWithEveryFrameAndCanLabelItAgain) {
  InjectedOptions options;
  options.frames = 8;
  const InjectedSequence sequence(options);
  RunContext context;
  int calls = 0;
  std::vector<int> labels;
  const Extraction extraction = extract_regions(
      sequence, {}, context, [&](int f, const SurfaceFrame& frame, const SegmentedFrame& s) {
        EXPECT_EQ(f, calls++);
        EXPECT_EQ(static_cast<int>(s.label.size()), frame.mesh.vertex_count());
        if (f == 5) labels = s.label;
      });
  EXPECT_EQ(calls, 8);
  EXPECT_EQ(extraction.segmenter->segment(sequence.frame(5), 5).label, labels);
}

TEST(Extraction, IsTheSameForOneThreadAndTwo) {
  InjectedOptions options = scene(1, 4);
  options.frames = 12;
  const InjectedSequence sequence(options);
  const auto run = [&](int threads) {
    Extraction extraction;
    with_threads(threads, [&] { extraction = extracted(sequence); });
    return extraction;
  };
  const Extraction one = run(1), two = run(2);
  ASSERT_EQ(one.regions.size(), two.regions.size());
  for (std::size_t r = 0; r < one.regions.size(); ++r) {
    EXPECT_EQ(one.regions[r].centre, two.regions[r].centre);
    EXPECT_EQ(one.regions[r].support, two.regions[r].support);
  }
  ASSERT_EQ(one.tracking.tracks.size(), two.tracking.tracks.size());
  for (std::size_t t = 0; t < one.tracking.tracks.size(); ++t)
    EXPECT_EQ(one.tracking.tracks[t].regions, two.tracking.tracks[t].regions);
}

TEST(Extraction, OneFrameGivesTracksOfOneRegion) {
  InjectedOptions options;
  const SurfaceFrame frame = InjectedSequence(options).frame(20);
  RunContext context;
  const Extraction extraction = extract_regions(StoredSequence({frame}, "one frame"), {}, context);
  EXPECT_FALSE(extraction.regions.empty());
  EXPECT_EQ(extraction.tracking.tracks.size(), extraction.regions.size());
  EXPECT_TRUE(extraction.tracking.events.empty());
}

TEST(InjectedSequence, SurfacesAreManifoldAndTheTankIsClosed) {
  InjectedOptions options = scene(1, 1);
  for (const bool tank : {false, true}) {
    options.tank = tank;
    const TriMesh mesh = InjectedSequence(options).frame(18).mesh;
    EXPECT_TRUE(non_manifold_edges(mesh.F).empty());
    EXPECT_EQ(boundary_edges(mesh.F).empty(), tank);
  }
}

TEST(InjectedSequence, TruthIsWhereTheMeshIs) {
  InjectedOptions options = scene(1, 2);
  options.noise = 0;
  options.velocity = true;
  const InjectedSequence sequence(options);
  const SurfaceFrame frame = sequence.frame(18);
  int drops = 0;
  for (const InjectedTruth& t : sequence.truth()) {
    if (t.frame != 18 || !t.isolated) continue;
    ++drops;
    int on_it = 0;
    for (Eigen::Index v = 0; v < frame.mesh.V.rows(); ++v) {
      const double d = (frame.mesh.V.row(v).transpose() - t.centre).norm();
      if (std::abs(d - t.radius) > 0.01 * options.cell + 0.02 * t.radius) continue;
      ++on_it;
      EXPECT_GT(frame.velocity.row(v).norm(), 0);
    }
    EXPECT_GT(on_it, 50);
  }
  EXPECT_GT(drops, 0);
}

TEST(InjectedSequence, IsTheSameForASeedAndRefusesNonsense) {
  EXPECT_TRUE(InjectedSequence(scene(1, 5)).frame(9).mesh.V ==
              InjectedSequence(scene(1, 5)).frame(9).mesh.V);
  InjectedOptions options;
  options.drops = options.rings + 1;
  EXPECT_THROW(InjectedSequence{options}, Error);
  options = {};
  options.resolution = 0;
  EXPECT_THROW(InjectedSequence{options}, Error);
  EXPECT_THROW((void)InjectedSequence(InjectedOptions{}).frame(99), Error);
}

}  // namespace
}  // namespace geoprior::fluid
