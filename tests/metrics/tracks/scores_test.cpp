#include "metrics/tracks/scores.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "metrics/tracks/optimal_assignment.h"

namespace geoprior {
namespace {

/// A unit cube at x.
TrackedObject cube(int id, double x, int kind = 0) {
  const Eigen::Vector3d c(x, 0, 0), half = Eigen::Vector3d::Constant(0.5);
  return {id, kind, c, c - half, c + half};
}

TEST(OptimalAssignment, IsTheBestOfAllPermutations) {
  RandomStream random(3, "assignment");
  for (int trial = 0; trial < 100; ++trial) {
    const int rows = 1 + static_cast<int>(random.below(5)),
              columns = 1 + static_cast<int>(random.below(5));
    Eigen::MatrixXd value(rows, columns);
    for (Eigen::Index i = 0; i < value.size(); ++i) value(i) = 10 * random.uniform() - 3;
    std::vector<int> order(std::max(rows, columns));
    for (int i = 0; i < std::ssize(order); ++i) order[i] = i;
    double best = -1e30;
    do {
      double sum = 0;
      for (int i = 0; i < rows; ++i) {
        const int j = order[i];
        if (j < columns) sum += value(i, j);
      }
      best = std::max(best, sum);
    } while (std::next_permutation(order.begin(), order.end()));
    const std::vector<int> column = optimal_assignment(value);
    double sum = 0;
    int assigned = 0;
    for (int i = 0; i < rows; ++i) {
      if (column[i] < 0) continue;
      sum += value(i, column[i]);
      ++assigned;
    }
    EXPECT_EQ(assigned, std::min(rows, columns));
    EXPECT_NEAR(sum, best, 1e-12);
  }
}

TEST(TrackingScores, PerfectTracksScoreOne) {
  const TrackedFrames truth{{cube(1, 0), cube(2, 5)}, {cube(1, 1), cube(2, 6)}, {cube(1, 2)}};
  TrackedFrames found = truth;
  for (auto& frame : found) {
    for (TrackedObject& o : frame) o.id += 40;
  }
  const TrackingScores s = tracking_scores(truth, found, {});
  EXPECT_EQ(s.matches, 5);
  EXPECT_EQ(s.switches + s.fragments + s.misses + s.false_alarms, 0);
  for (const double score : {s.mota, s.motp, s.idf1, s.hota, s.precision, s.recall})
    EXPECT_DOUBLE_EQ(score, 1);
  EXPECT_EQ(s.lifetime_error, 0);
}

// One true track of four frames, found as ids 7 7 8 8, and one false alarm: MOTA = 1 - (0 misses +
// 1 false alarm + 1 switch) / 4. IDF1: track 7 or 8 keeps 2 frames, 2 * 2 / (4 + 5). HOTA at every
// threshold: DetA = 4 / (4 + 5 - 4), each match has AssA = 2 / (4 + 2 - 2).
TEST(TrackingScores, ASwitchByHand) {
  const TrackedFrames truth{{cube(1, 0)}, {cube(1, 1)}, {cube(1, 2)}, {cube(1, 3)}};
  const TrackedFrames found{{cube(7, 0)}, {cube(7, 1)}, {cube(8, 2), cube(9, 20)}, {cube(8, 3)}};
  const TrackingScores s = tracking_scores(truth, found, {});
  EXPECT_EQ(s.switches, 1);
  EXPECT_EQ(s.fragments, 0);
  EXPECT_EQ(s.false_alarms, 1);
  EXPECT_DOUBLE_EQ(s.mota, 0.5);
  EXPECT_DOUBLE_EQ(s.idf1, 4.0 / 9);
  EXPECT_DOUBLE_EQ(s.precision, 0.8);
  EXPECT_NEAR(s.detection, 0.8, 1e-12);
  EXPECT_NEAR(s.association, 0.5, 1e-12);
  EXPECT_NEAR(s.hota, std::sqrt(0.4), 1e-12);
}

// Found in frames 0, 1, 4 of 0 ... 4: one fragment, two misses, MOTA = 3/5, IDF1 = 6 / 8.
TEST(TrackingScores, AGapIsAFragmentAndNoSwitch) {
  TrackedFrames truth, found(5);
  for (int f = 0; f < 5; ++f) truth.push_back({cube(1, f)});
  for (const std::size_t f : {0U, 1U, 4U}) found[f] = {cube(3, static_cast<double>(f))};
  const TrackingScores s = tracking_scores(truth, found, {});
  EXPECT_EQ(s.fragments, 1);
  EXPECT_EQ(s.switches, 0);
  EXPECT_DOUBLE_EQ(s.mota, 0.6);
  EXPECT_DOUBLE_EQ(s.idf1, 0.75);
}

// Two tracks that exchange ids half way: every object is found, half of the identities are right.
TEST(TrackingScores, CrossedIdentitiesHalveIdf1AndLeaveRecall) {
  TrackedFrames truth, found;
  for (int f = 0; f < 10; ++f) {
    truth.push_back({cube(1, 0), cube(2, 5)});
    found.push_back({cube(f < 5 ? 1 : 2, 0), cube(f < 5 ? 2 : 1, 5)});
  }
  const TrackingScores s = tracking_scores(truth, found, {});
  EXPECT_DOUBLE_EQ(s.recall, 1);
  EXPECT_EQ(s.switches, 2);
  EXPECT_DOUBLE_EQ(s.mota, 0.9);
  EXPECT_DOUBLE_EQ(s.idf1, 0.5);
  EXPECT_NEAR(s.association, 5.0 / 15, 1e-12);
}

// Cubes shifted by s overlap with (1 - s) / (1 + s): 1/3 at a half. Of HOTA's thresholds 0.05 ...
// 0.95 six are at most 1/3.
TEST(TrackingScores, SimilarityIsTheOverlapOrTheDistance) {
  const TrackedFrames truth{{cube(1, 0)}}, found{{cube(1, 0.5)}};
  TrackingScores s = tracking_scores(truth, found, {TrackSimilarity::box_overlap, 1, 0.3});
  EXPECT_NEAR(s.motp, 1.0 / 3, 1e-12);
  EXPECT_NEAR(s.hota, 6.0 / 19, 1e-12);
  EXPECT_DOUBLE_EQ(s.distance_rms, 0.5);
  EXPECT_EQ(tracking_scores(truth, found, {}).matches, 0);
  s = tracking_scores(truth, found, {TrackSimilarity::distance, 2, 0.5});
  EXPECT_DOUBLE_EQ(s.motp, 0.75);
}

TEST(TrackingScores, AMatchIsKeptWhileItIsSimilarEnough) {
  // Frame 1: id 8 lies nearer, but 7 was the match before.
  const TrackedFrames truth{{cube(1, 0)}, {cube(1, 0)}};
  const TrackedFrames found{{cube(7, 0)}, {cube(7, 0.2), cube(8, 0.1)}};
  EXPECT_EQ(tracking_scores(truth, found, {}).switches, 0);
}

TEST(TrackingScores, KindsNeverMatch) {
  const TrackingScores s = tracking_scores({{cube(1, 0, 0)}}, {{cube(1, 0, 1)}}, {});
  EXPECT_EQ(s.matches, 0);
  EXPECT_DOUBLE_EQ(s.mota, -1);
  EXPECT_DOUBLE_EQ(s.hota, 0);
}

TEST(TrackingScores, LifetimeErrorCountsFramesAtBothEnds) {
  TrackedFrames truth, found(6);
  for (int f = 0; f < 6; ++f) truth.push_back({cube(1, f)});
  for (const std::size_t f : {1U, 2U, 3U}) found[f] = {cube(3, static_cast<double>(f))};
  EXPECT_DOUBLE_EQ(tracking_scores(truth, found, {}).lifetime_error, 3);
}

TEST(TrackingScores, NothingTrueAndNothingFoundIsPerfect) {
  EXPECT_DOUBLE_EQ(tracking_scores({{}}, {{}}, {}).idf1, 1);
  EXPECT_DOUBLE_EQ(tracking_scores({{}}, {{cube(1, 0)}}, {}).idf1, 0);
}

TEST(TrackingScores, UnequalFramesAndDoubleIdsAreErrors) {
  EXPECT_THROW(tracking_scores({{}}, {{}, {}}, {}), Error);
  EXPECT_THROW(tracking_scores({{cube(1, 0), cube(1, 3)}}, {{}}, {}), Error);
}

}  // namespace
}  // namespace geoprior
