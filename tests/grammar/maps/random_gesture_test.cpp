// Random gestures: reproducible, of their stated sizes, invertible.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "experiments/grammar/maps/gesture.h"
#include "tests/grammar/maps/sampled_map.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using Kind = Stroke::Kind;

constexpr int kGestures = 200;

TEST(GrammarRandomGesture, SameSeedAndNumberSameGesture) {
  for (int i = 0; i < kGestures; ++i) {
    const Stroke a = random_gesture(7, i, samples::kSampledBox).strokes.at(0),
                 b = random_gesture(7, i, samples::kSampledBox).strokes.at(0),
                 other_number = random_gesture(7, i + 1, samples::kSampledBox).strokes.at(0),
                 other_seed = random_gesture(8, i, samples::kSampledBox).strokes.at(0);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.path, b.path);
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_EQ(a.amount, b.amount);
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.along, b.along);
    EXPECT_NE(a.path, other_number.path);
    EXPECT_NE(a.path, other_seed.path);
  }
}

TEST(GrammarRandomGesture, SizesAreInProportionToTheBox) {
  const double diagonal = samples::kSampledBox.diagonal().norm();
  std::array<int, 4> count{};
  for (int i = 0; i < kGestures; ++i) {
    const Gesture gesture = random_gesture(1, i, samples::kSampledBox);
    ASSERT_EQ(gesture.strokes.size(), 1u);
    const Stroke& stroke = gesture.strokes[0];
    ++count[static_cast<std::size_t>(stroke.kind)];
    EXPECT_TRUE(samples::kSampledBox.contains(stroke.path.front()));
    EXPECT_GE(stroke.radius, 0.5 * diagonal);
    EXPECT_LE(stroke.radius, 1.2 * diagonal);
    switch (stroke.kind) {
      case Kind::grab: {
        const double length = (stroke.path.at(1) - stroke.path[0]).norm();
        EXPECT_GE(length, 0.08 * diagonal * (1 - 1e-12));
        EXPECT_LE(length, 0.3 * diagonal * (1 + 1e-12));
        break;
      }
      case Kind::inflate:
        EXPECT_GE(stroke.amount, -0.25);
        EXPECT_LE(stroke.amount, 0.4);
        break;
      case Kind::twist:
      case Kind::bend:
        EXPECT_LE(std::abs(stroke.amount), 0.9);
        EXPECT_NEAR(stroke.axis.norm(), 1, 1e-12);
        EXPECT_NEAR(stroke.axis.dot(stroke.along), 0, 1e-12);
        break;
    }
  }
  for (const int n : count) EXPECT_GT(n, 30);  // 50 expected, standard deviation 6
}

TEST(GrammarRandomGesture, IsInvertible) {
  for (int i = 0; i < kGestures; ++i) {
    const auto map = map_of(random_gesture(2, i, samples::kSampledBox), 1);
    EXPECT_GT(samples::least_determinant(*map, samples::points_in(samples::kSampledBox, 50, i)),
              0.1)
        << "gesture " << i;
  }
}

TEST(GrammarRandomGesture, MovesWhatIsInTheBox) {
  for (int i = 0; i < kGestures; ++i) {
    const auto map = map_of(random_gesture(3, i, samples::kSampledBox), 1);
    double largest = 0;
    for (const Vector3d& x : samples::points_in(samples::kSampledBox, 50, i))
      largest = std::max(largest, (map->at(x) - x).norm());
    EXPECT_GT(largest, 0) << "gesture " << i;
    EXPECT_LT(largest, 0.5 * samples::kSampledBox.diagonal().norm()) << "gesture " << i;
  }
}

TEST(GrammarRandomGesture, RefusesABoxWithoutExtent) {
  geoprior::test::expect_error([] { random_gesture(1, 0, {}); }, {"random gesture"});
  geoprior::test::expect_error(
      [] {
        random_gesture(1, 0, {Vector3d(1, 1, 1), Vector3d(1, 1, 1)});
      },
      {"random gesture"});
}

}  // namespace
}  // namespace geoprior::grammar
