#include "metrics/arrangement/lengths.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using Eigen::Vector3d;

TEST(ArrangementLengths, AreOutOfTheRangeByTheDistanceFromIt) {
  EXPECT_EQ(out_of_range(2, 1, 3), 0);
  EXPECT_EQ(out_of_range(1, 1, 3), 0);
  EXPECT_EQ(out_of_range(0.25, 1, 3), 0.75);
  EXPECT_EQ(out_of_range(5, 1, 3), 2);
}

TEST(ArrangementLengths, AttachmentGapIsFromThePlaceNotFromTheSegment) {
  const Vector3d a(0, 0, 0), b(4, 0, 0);
  EXPECT_EQ(attachment_gap({1, 0, 0}, a, b, 0.25), 0);
  // On the segment, but 2 m from where it is to hang.
  EXPECT_EQ(attachment_gap({3, 0, 0}, a, b, 0.25), 2);
  EXPECT_EQ(attachment_gap({1, 3, 4}, a, b, 0.25), 5);
}

TEST(ArrangementLengths, DistanceFromASegmentEndsAtItsEnds) {
  const Vector3d a(0, 0, 0), b(4, 0, 0);
  EXPECT_EQ(distance_from_segment({1, 2, 0}, a, b), 2);
  EXPECT_EQ(distance_from_segment({7, 4, 0}, a, b), 5);
  EXPECT_EQ(distance_from_segment({-3, 0, 4}, a, b), 5);
  EXPECT_EQ(distance_from_segment({0, 0, 2}, a, a), 2);
}

TEST(ArrangementLengths, PitchesAreOfNeighboursInTheOrderOfTheirPlaces) {
  const std::vector<Vector3d> x{{5, 0, 0}, {0, 0, 0}, {2, 0, 0}};
  const auto pitches = neighbour_pitches(x, std::vector<double>{5, 0, 2});
  ASSERT_EQ(pitches.size(), 2);
  const auto expect_pitch = [](const NeighbourPitch& p, int before, int after, double distance) {
    EXPECT_EQ(p.before, before);
    EXPECT_EQ(p.after, after);
    EXPECT_EQ(p.distance, distance);
  };
  expect_pitch(pitches[0], 1, 2, 2);
  expect_pitch(pitches[1], 2, 0, 3);
  EXPECT_TRUE(neighbour_pitches(std::vector<Vector3d>{{1, 1, 1}}, std::vector<double>{0}).empty());
  test::expect_error([&] { (void)neighbour_pitches(x, std::vector<double>{1}); },
                     {"1 places for 3 points"});
}

}  // namespace
}  // namespace geoprior
