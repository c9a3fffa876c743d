#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "models/paper/meshing/transfer.h"
#include "solvers/paper/hybrid.h"
#include "solvers/paper/sheet/invariants.h"
#include "tests/paper/contact/plane_shapes.h"
#include "tests/paper/sheet/hybrid_fixture.h"
#include "tests/support/long_tests.h"
#include "tests/support/recording.h"

namespace geoprior::paper {
namespace {

using ::testing::IsEmpty;

/// The pass line of the thesis' claim that the sheet stays a developable image of its pattern.
constexpr double kRms = 1e-3;
constexpr double kLargest = 1e-2;

/// Height of the middle of a thin strip, ends hinged, over its length, when they have approached by
/// `shortening` of it: Euler's elastica, w = k / K(k) with 2 - 2 E(k) / K(k) = shortening.
double relative_elastica_height(double shortening) {
  // Complete elliptic integrals by the arithmetic-geometric mean.
  const auto integrals = [](double k) {
    double a = 1, b = std::sqrt(1 - k * k), c = k, sum = k * k / 2;
    for (double power = 1; std::abs(c) > 1e-16; power *= 2) {
      c = (a - b) / 2;
      const double mean = (a + b) / 2;
      b = std::sqrt(a * b);
      a = mean;
      sum += power * c * c;
    }
    const double K = std::numbers::pi / (2 * a);
    return std::pair(K, K * (1 - sum));
  };
  double low = 0, high = 0.99;
  for (int i = 0; i < 100; ++i) {
    const double k = (low + high) / 2;
    const auto [K, E] = integrals(k);
    (2 - 2 * E / K < shortening ? low : high) = k;
  }
  return low / integrals(low).first;
}

TEST(HybridBend, MakesACylinderOfTheHeightOfTheElastica) {
  const Sheet sheet = bent_sheet();
  HybridMesher last{{}};
  ShellState end;
  run_hybrid(sheet, {}, 1, [&](const HybridMesher& mesher, const ShellState& state) {
    EXPECT_THAT(broken_invariants(mesher.structure(), sheet.pattern, state.mesh), IsEmpty());
    const Isometry strain = isometry(state);
    EXPECT_LE(strain.rms, kRms) << state.time;
    EXPECT_LE(strain.largest, kLargest) << state.time;
    EXPECT_TRUE(mesher.structure().singular_points.empty()) << state.time;
    EXPECT_LE(state.mesh.triangle_count(), 300);
    end = state;
  });
  const double height = end.x.col(2).cwiseAbs().maxCoeff();
  // 2 % of the width, the bound for smooth scenes.
  EXPECT_NEAR(height, 0.2 * relative_elastica_height(0.4), 0.02 * 0.2);
}

bool same_lines(const std::vector<Ruling>& rulings, const std::vector<Ruling>& others) {
  return std::equal(rulings.begin(), rulings.end(), others.begin(), others.end(),
                    [](const Ruling& r, const Ruling& s) { return r.a == s.a && r.b == s.b; });
}

// Between two looks no ruling turns, comes or goes, and the sheet still bends to the elastica.
TEST(HybridBend, LooksInEveryFourthFrameOnly) {
  const Sheet sheet = bent_sheet();
  HybridOptions options;
  options.look_frames = 4;
  std::vector<int> changed;
  std::vector<Ruling> before;
  ShellState end;
  int frame = 0;
  run_hybrid(sheet, options, 1, [&](const HybridMesher& mesher, const ShellState& state) {
    const std::vector<Ruling>& rulings = mesher.structure().rulings;
    if (!same_lines(rulings, before)) changed.push_back(frame);
    before = rulings;
    end = state;
    ++frame;
  });
  ASSERT_FALSE(changed.empty());
  for (const int k : changed) EXPECT_EQ(k % 4, changed.front() % 4) << k;
  EXPECT_LT(std::ssize(changed), frame / 3);
  EXPECT_NEAR(end.x.col(2).cwiseAbs().maxCoeff(), 0.2 * relative_elastica_height(0.4), 0.02 * 0.2);
}

/// What changes of the mesh do to a sheet that is pinched, and then held for two seconds.
struct Changes {
  int frames = 0, at_rest = 0;
  double farthest = 0;    ///< that one moved the sheet (m)
  double most_share = 0;  ///< of it in the way that the sheet goes between two looks
};
Changes changes_of_pinched_sheet(const HybridOptions& options) {
  Sheet sheet = pinched_sheet();
  sheet.duration = 4;
  Changes changes;
  std::vector<Ruling> before;
  std::size_t points = 0;
  ShellState found;
  run_hybrid(
      sheet, options, 1,
      [&](const HybridMesher& mesher, const ShellState& state) {
        const std::vector<Ruling>& rulings = mesher.structure().rulings;
        const bool same = same_lines(rulings, before);
        before = rulings;
        const bool points_changed =
            std::exchange(points, mesher.structure().singular_points.size()) !=
            mesher.structure().singular_points.size();
        if (same || points_changed) return;
        ++changes.frames;
        if (state.time > 2.6) ++changes.at_rest;
        const ShellState carried = transfer_state(found, state.mesh);
        const double moved = (state.x - carried.x).rowwise().norm().maxCoeff();
        const double way = found.v.rowwise().norm().maxCoeff() * 5 * sheet.frame_interval;
        changes.farthest = std::max(changes.farthest, moved);
        changes.most_share = std::max(changes.most_share, moved / way);
      },
      [&](const HybridMesher&, const ShellState& state) { found = state; });
  return changes;
}

// A change of the mesh that moves the sheet farther than it goes by itself is what one sees of it.
TEST(HybridBend, MovesTheSheetLessByAChangeOfRulingsThanItWent) {
  const HybridOptions options;
  const Changes changes = changes_of_pinched_sheet(options);
  EXPECT_GT(changes.frames, 0);
  EXPECT_EQ(changes.at_rest, 0);
  EXPECT_LE(changes.most_share, options.jump_share);
  EXPECT_LE(changes.farthest, 0.25 * options.seeding_distance);
  HybridOptions restless;
  restless.jump_share = 1e6;
  EXPECT_GT(changes_of_pinched_sheet(restless).most_share, options.jump_share);
}

// An edge of the default length crosses a band of 18 mm: without room for vertices between its
// sides the band bends in pleats.
TEST(HybridBend, HasVerticesBetweenTheSidesOfABand) {
  Sheet sheet = bent_sheet();
  sheet.pattern = rectangle_pattern(0.2, 0.018);
  sheet.handles = {
      edge_handle("left", {-0.1, -0.009}, {-0.1, 0.009}, {{0, {0, 0, 0}}, {1, {0.04, 0, 0}}}),
      edge_handle("right", {0.1, -0.009}, {0.1, 0.009}, {{0, {0, 0, 0}}, {1, {-0.04, 0, 0}}})};
  test::Recording recording;
  RunContext context(1);
  make_hybrid_sheet(sheet, {})->run(recording, context, {});
  const NamedArray* pattern = recording.frames.front().parts.at("surface").find_array("pattern");
  ASSERT_NE(pattern, nullptr);
  const auto inside = (pattern->values.col(1).array().abs() < 0.008).count();
  EXPECT_GE(inside, 15);
}

// A hole in a cylinder changes little of its height: the strips at its sides carry the bending. A
// tenth of the elastica's is more than the hole's share of the width's stiffness moves it.
TEST(HybridBend, BendsASheetWithAHole) {
  const Sheet sheet = bent_sheet_with_hole();
  std::vector<Eigen::MatrixX3d> places;
  std::size_t at_hole = 0;
  for (int run = 0; run < 2; ++run) {
    std::size_t frame = 0;
    run_hybrid(sheet, {}, 1, [&](const HybridMesher& mesher, const ShellState& state) {
      ASSERT_THAT(broken_invariants(mesher.structure(), sheet.pattern, state.mesh), IsEmpty());
      EXPECT_EQ(plane_shapes::euler_characteristic(state.mesh), 0);
      const Isometry strain = isometry(state);
      EXPECT_LE(strain.rms, kRms) << state.time;
      EXPECT_LE(strain.largest, kLargest) << state.time;
      EXPECT_TRUE(mesher.structure().singular_points.empty()) << state.time;
      for (const Ruling& r : mesher.structure().rulings) {
        for (const Eigen::Vector2d& end : {r.a, r.b})
          at_hole += nearest_on_border(sheet.pattern, end).edge >= 4 ? 1 : 0;
      }
      if (run == 0) places.push_back(state.x);
      EXPECT_TRUE(places[frame++] == state.x) << "the second run differs at " << state.time;
    });
  }
  EXPECT_GT(at_hole, 10U) << "rulings end at the hole";
  const double height = places.back().col(2).cwiseAbs().maxCoeff();
  EXPECT_NEAR(height, 0.2 * relative_elastica_height(0.4),
              0.1 * 0.2 * relative_elastica_height(0.4));
}

TEST(HybridPinch, PutsASingularPointWithConesWhereTheEdgeIsPinched) {
  const Sheet sheet = pinched_sheet();
  std::size_t before_pinch = 99, cones = 0;
  PaperStructure structure;
  HybridOptions by_compression;
  by_compression.energy_test = false;
  by_compression.test = CompressionTest::threshold;
  by_compression.compression_threshold = 1e-3;
  run_hybrid(sheet, by_compression, 1, [&](const HybridMesher& mesher, const ShellState& state) {
    EXPECT_THAT(broken_invariants(mesher.structure(), sheet.pattern, state.mesh), IsEmpty());
    const Isometry strain = isometry(state);
    EXPECT_LE(strain.rms, kRms) << state.time;
    EXPECT_LE(strain.largest, kLargest) << state.time;
    structure = mesher.structure();
    if (state.time < 1.01) before_pinch = structure.singular_points.size();
  });
  EXPECT_EQ(before_pinch, 0U);
  ASSERT_GE(structure.singular_points.size(), 1U);
  for (const PaperPiece& piece : structure.pieces) {
    cones += piece.kind == PaperPiece::Kind::cone ? 1 : 0;
  }
  EXPECT_GE(cones, 1U);
  // The first one lies in the half of the edge that is pinched.
  EXPECT_LT(structure.singular_points[0].position.x(), 0);
}

/// What a pinched sheet does under a threshold of compression.
struct Pinched {
  double compression = 0;  ///< largest met
  std::size_t singular_points = 0;
};
Pinched pinched(double threshold) {
  HybridOptions options;
  options.test = CompressionTest::threshold;
  options.compression_threshold = threshold;
  options.energy_test = false;
  // The compression is looked for in every frame here too, and asks for what it asks for.
  options.look_frames = 1;
  options.jump_share = 1e6;
  Pinched result;
  run_hybrid(
      pinched_sheet(), options, 1,
      [&](const HybridMesher& mesher, const ShellState&) {
        result.singular_points = mesher.structure().singular_points.size();
      },
      [&](const HybridMesher& mesher, const ShellState& state) {
        result.compression =
            std::max(result.compression, largest_compression(mesher.structure(), state));
      });
  return result;
}

// The compression that the motion brings about is measured here, on a sheet that may not crumple: a
// strain is never 1. A threshold above it changes nothing, one below it is passed.
TEST(HybridPinch, CrumplesWhenTheCompressionPassesTheThresholdAndNotBefore) {
  const Pinched whole = pinched(1);
  ASSERT_EQ(whole.singular_points, 0U);
  RecordProperty("largest_compression", std::to_string(whole.compression));
  EXPECT_GT(whole.compression, 1e-3);
  EXPECT_EQ(pinched(1.02 * whole.compression).singular_points, 0U);
  EXPECT_GE(pinched(0.5 * whole.compression).singular_points, 1U);
}

/// Thesis, Figure 3.11 left: towards zero the sheet crumples more than it bends. Factors of a
/// hundred, because where singular points are drawn moves their number by a few.
TEST(HybridPinch, CrumplesMoreTheLessCompressionIsAdmissible) {
  const std::size_t few = pinched(1e-3).singular_points, many = pinched(1e-5).singular_points;
  EXPECT_GE(few, 1U);
  EXPECT_GT(many, few);
}

/// Facts that hold in every frame of every motion. Returns the frames that miss the isometry line.
int wander(std::uint64_t seed, int frames) {
  const Sheet sheet = wandering_sheet(seed, frames);
  const HybridOptions options;
  std::vector<SingularPoint> known;
  int strained = 0, frame = 0;
  run_hybrid(sheet, options, seed, [&](const HybridMesher& mesher, const ShellState& state) {
    ++frame;
    ASSERT_TRUE(state.x.allFinite() && state.v.allFinite()) << "frame " << frame;
    ASSERT_THAT(broken_invariants(mesher.structure(), sheet.pattern, state.mesh), IsEmpty())
        << "frame " << frame;
    const auto& points = mesher.structure().singular_points;
    for (const SingularPoint& old : known) {
      const auto now = std::find_if(points.begin(), points.end(),
                                    [&](const SingularPoint& p) { return p.id == old.id; });
      if (now == points.end()) {
        EXPECT_EQ(old.weakening, 0) << "the paper has yielded there, frame " << frame;
        continue;
      }
      ASSERT_EQ(now->position, old.position);
      ASSERT_GE(now->weakening, old.weakening);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GE((points[i].position - points[j].position).norm(),
                  options.singular_spacing * options.seeding_distance);
      }
    }
    known = points;
    const Isometry strain = isometry(state);
    if (strain.rms > kRms || strain.largest > kLargest) ++strained;
    EXPECT_LE(state.mesh.triangle_count(), 600) << "frame " << frame;
  });
  EXPECT_EQ(frame, frames);
  // Discs of half the spacing about the points do not overlap: their number is bounded.
  EXPECT_LT(known.size(), 70U);
  testing::Test::RecordProperty("frames_beyond_isometry_line", strained);
  return strained;
}

class LongHybridWandering : public testing::TestWithParam<int> {};

TEST_P(LongHybridWandering, KeepsItsInvariantsUnderRandomHandles) {
  const int frames = test::at_length() ? 500 : 25;
  const int strained = wander(static_cast<std::uint64_t>(GetParam()), frames);
  // Handles that wander may leave no isometric shape near: with seed 2 a dense sheet (1,500
  // triangles) is strained beyond the line in 8 of the 500 frames, up to 2.9e-3; the hybrid's in 6.
  EXPECT_LE(strained, test::at_length() ? 8 : 0);
}

/// One seed for 25 frames; with GEOPRIOR_LONG, twenty for 500.
INSTANTIATE_TEST_SUITE_P(Seeds, LongHybridWandering, testing::Range(1, test::at_length() ? 21 : 2));

TEST(HybridProcess, GoesOnFromACheckpointAsIfItHadNotStopped) {
  struct Sink final : FrameSink {
    std::vector<Eigen::MatrixX3d> places;
    std::vector<std::size_t> pieces;
    std::vector<State> states;
    void frame(Frame f) override {
      places.push_back(f.require_part("surface").points);
      pieces.push_back(f.require_table("pieces").rows.rows());
    }
    void event(const Event&) override {}
    void artifact(Artifact) override {}
    void checkpoint(const State& state) override { states.push_back(state); }
  };
  constexpr std::size_t kFrames = 54;  // the middle lies between two looks
  Sheet sheet = pinched_sheet();
  sheet.duration = sheet.frame_time(kFrames);
  Sink whole, again, rest;
  RunContext context(1);
  make_hybrid_sheet(sheet, {})->run(whole, context, {});
  with_threads(1, [&] { make_hybrid_sheet(sheet, {})->run(again, context, {}); });
  ASSERT_EQ(whole.places.size(), kFrames + 1);
  EXPECT_TRUE(whole.places == again.places) << "depends on the number of threads";
  EXPECT_NE(whole.places[kFrames / 2].rows(), whole.places[kFrames].rows())
      << "nothing was remeshed";
  make_hybrid_sheet(sheet, {})->run(rest, context, whole.states[kFrames / 2]);
  ASSERT_EQ(rest.places.size(), kFrames / 2);
  for (std::size_t i = 0; i < rest.places.size(); ++i) {
    EXPECT_TRUE(rest.places[i] == whole.places[kFrames / 2 + 1 + i])
        << "frame " << kFrames / 2 + 1 + i;
    EXPECT_EQ(rest.pieces[i], whole.pieces[kFrames / 2 + 1 + i]);
  }
}

}  // namespace
}  // namespace geoprior::paper
