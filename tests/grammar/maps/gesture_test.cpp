// Gestures over time: what a fraction of them is, and how they are drawn.

#include "experiments/grammar/maps/gesture.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/grammar/maps/sampled_map.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using geoprior::test::expect_error;
using Kind = Stroke::Kind;

/// Three strokes, a lattice whose outermost layer rests, and a tetrahedron as cage.
Gesture gesture_of_all() {
  Gesture out;
  out.strokes = {{.path = {{0, 0, 4}, {1, 0, 4.5}, {1.5, 1, 5}}, .radius = 4},
                 {.kind = Kind::inflate, .path = {{1, 1, 3}}, .radius = 3, .amount = 0.3},
                 {.kind = Kind::twist, .path = {{0, 0, 2}, {0, 0, 5}}, .radius = 4, .amount = 1}};
  Lattice lattice{{-9, -9, -6}, {9, 9, 14}, {3, 3, 3}, std::vector<Vector3d>(27, {0, 0, 0})};
  lattice.shifts[13] = {2, 1, -1};
  out.lattice = lattice;
  Cage cage;
  cage.rest.V.resize(4, 3);
  cage.rest.V << -30, -30, -20, 40, -30, -20, 0, 50, -20, 0, 0, 50;
  cage.rest.F.resize(4, 3);
  cage.rest.F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  cage.moved = cage.rest.V;
  cage.moved(3, 0) += 5;
  out.cage = cage;
  return out;
}

Gesture strokes_alone() { return {gesture_of_all().strokes, {}, {}}; }

TEST(GrammarGesture, NothingDoneIsTheIdentityBitForBit) {
  const auto map = map_of(gesture_of_all(), 0);
  ASSERT_TRUE(map->support());
  EXPECT_TRUE(map->support()->isEmpty());
  for (const Vector3d& x : samples::points_in(samples::kSampledBox, 100, 1)) {
    EXPECT_EQ(map->at(x), x);
    EXPECT_EQ(map->with_jacobian(x).jacobian, Eigen::Matrix3d::Identity());
  }
}

TEST(GrammarGesture, AnEmptyGestureIsTheIdentity) {
  EXPECT_TRUE(map_of({}, 1)->support()->isEmpty());
  EXPECT_EQ(map_of({}, 1)->at({1, 2, 3}), Vector3d(1, 2, 3));
}

TEST(GrammarGesture, StrokesComeOneAfterTheOtherInEqualShares) {
  const Gesture all = strokes_alone();
  const auto alone = [&](int i, double fraction) {
    return map_of({{all.strokes[i]}, {}, {}}, fraction);
  };
  const auto first = map_of(all, 1. / 3), second = map_of(all, 0.5), third = map_of(all, 1);
  for (const Vector3d& x : samples::points_in(samples::kSampledBox, 100, 2)) {
    const Vector3d a = alone(0, 1)->at(x), b = alone(1, 1)->at(a);
    EXPECT_LT((first->at(x) - a).norm(), 1e-13);
    EXPECT_LT((second->at(x) - alone(1, 0.5)->at(a)).norm(), 1e-13);
    EXPECT_LT((third->at(x) - alone(2, 1)->at(b)).norm(), 1e-13);
  }
}

/// No more than 60 m a unit of the fraction: three strokes that move a point by at most 5 m each,
/// in a third of the time, the lattice and the cage.
TEST(GrammarGesture, MovesOnContinuouslyWithItsFraction) {
  constexpr double kStep = 1e-7;
  const Gesture gesture = gesture_of_all();
  const std::vector<Vector3d> points = samples::points_in(samples::kSampledBox, 20, 3);
  std::vector<double> fractions{0, 1. / 3, 2. / 3, 0.5, 1 - kStep};
  for (double f = 0.003; f < 0.99; f += 0.017) fractions.push_back(f);
  for (const double f : fractions) {
    const auto before = map_of(gesture, std::max(0., f - kStep)),
               after = map_of(gesture, f + kStep);
    for (const Vector3d& x : points)
      EXPECT_LT((after->at(x) - before->at(x)).norm(), 120 * kStep + 1e-13) << "at " << f;
  }
}

TEST(GrammarGesture, StrokesAndLatticeKeepASupportAndTheCageHasNone) {
  Gesture gesture = gesture_of_all();
  EXPECT_FALSE(map_of(gesture, 0.5)->support());
  gesture.cage.reset();
  const auto map = map_of(gesture, 0.5);
  ASSERT_TRUE(map->support());
  const Eigen::AlignedBox3d wide(Vector3d(-30, -30, -30), Vector3d(30, 30, 30));
  for (const Vector3d& x : samples::points_in(wide, 500, 4)) {
    if (map->support()->contains(x)) continue;
    EXPECT_EQ(map->at(x), x);
  }
}

TEST(GrammarGesture, RefusesAFractionOutsideOfTheGesture) {
  for (const double f : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()})
    expect_error([&] { map_of(strokes_alone(), f); }, {"fraction", "0 to 1"});
}

TEST(GrammarGesture, NamesTheStrokeThatIsWrongEvenWhereNothingIsDone) {
  Gesture gesture = strokes_alone();
  gesture.strokes[1].radius = -1;
  expect_error([&] { map_of(gesture, 0); }, {"strokes[1]", "radius"});
  expect_error([&] { drawn(gesture); }, {"strokes[1]", "radius"});
}

TEST(GrammarGesture, RefusesAnOpenCageAndALatticeThatMissesShifts) {
  Gesture gesture = gesture_of_all();
  gesture.lattice->shifts.pop_back();
  expect_error([&] { map_of(gesture, 1); }, {"26 shifts"});
  gesture = gesture_of_all();
  gesture.cage->rest.F = gesture.cage->rest.F.topRows(3).eval();
  expect_error([&] { map_of(gesture, 1); }, {"edge"});
}

TEST(GrammarGesture, DrawingHoldsThePathsAndCirclesOfTheTools) {
  const Gesture gesture = gesture_of_all();
  const DrawnGesture lines = drawn(gesture);
  for (const std::vector<int>& line : lines.lines) {
    EXPECT_GE(line.size(), 2u);
    for (const int i : line) EXPECT_TRUE(lines.points.at(i).allFinite());
  }
  for (const Stroke& stroke : gesture.strokes) {
    if (stroke.path.size() > 1) {
      for (const Vector3d& x : stroke.path)
        EXPECT_NE(std::find(lines.points.begin(), lines.points.end(), x), lines.points.end());
    }
    const auto is_circle = [&](const std::vector<int>& line) {
      return line.size() > 20 && std::all_of(line.begin(), line.end(), [&](int i) {
               return std::abs((lines.points[i] - stroke.path.front()).norm() -
                               0.314 * stroke.radius) < 1e-9;
             });
    };
    EXPECT_TRUE(std::any_of(lines.lines.begin(), lines.lines.end(), is_circle));
  }
}

TEST(GrammarGesture, DrawingHoldsTheMovedLatticeAndCage) {
  const Gesture gesture = gesture_of_all();
  const DrawnGesture lattice = drawn({{}, gesture.lattice, {}});
  EXPECT_EQ(lattice.lines.size(), 27u);  // 3 x 3 along each axis
  const Vector3d middle = Vector3d(0, 0, 4) + gesture.lattice->shifts[13];
  EXPECT_NE(std::find(lattice.points.begin(), lattice.points.end(), middle), lattice.points.end());
  const DrawnGesture cage = drawn({{}, {}, gesture.cage});
  EXPECT_EQ(cage.lines.size(), 6u);
}

}  // namespace
}  // namespace geoprior::grammar
