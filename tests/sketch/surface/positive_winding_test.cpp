#include "models/sketch/surface/positive_winding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/planar.h"
#include "core/random.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

PlaneLoop box_loop(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

PlaneLoop run_backwards(PlaneLoop loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

double total_area(const std::vector<PlaneLoop>& loops) {
  double area = 0;
  for (const PlaneLoop& loop : loops) area += loop_area(loop);
  return area;
}

/// By the angles under which the segments are seen.
int winding_by_angles(const std::vector<PlaneLoop>& curves, const Eigen::Vector2d& p) {
  double angle = 0;
  for (const PlaneLoop& curve : curves) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      angle += signed_angle(curve[i] - p, curve[(i + 1) % curve.size()] - p);
    }
  }
  return static_cast<int>(std::lround(angle / (2 * std::numbers::pi)));
}

TEST(PositiveWinding, UnitesAreasThatOverlapTouchOrCoincide) {
  const auto united = [](double shift) {
    return positive_winding_border({box_loop(0, 0, 1, 1), box_loop(shift, 0, 1, 1)});
  };
  EXPECT_EQ(united(0), (std::vector<PlaneLoop>{box_loop(0, 0, 1, 1)}));
  EXPECT_EQ(united(0.5), (std::vector<PlaneLoop>{box_loop(0, 0, 1.5, 1)}));
  EXPECT_EQ(united(1), (std::vector<PlaneLoop>{box_loop(0, 0, 2, 1)}));
  EXPECT_EQ(united(2).size(), 2U);
}

TEST(PositiveWinding, LeavesOutWhatIsEncircledBackwards) {
  EXPECT_TRUE(positive_winding_border({}).empty());
  EXPECT_TRUE(positive_winding_border({run_backwards(box_loop(0, 0, 1, 1))}).empty());
  EXPECT_TRUE(
      positive_winding_border({box_loop(0, 0, 1, 1), run_backwards(box_loop(0, 0, 1, 1))}).empty());
  // A figure of eight: its left half runs counter-clockwise, its right half clockwise.
  const auto eight = positive_winding_border({{{0, 0}, {2, 1}, {2, 0}, {0, 1}}});
  ASSERT_EQ(eight.size(), 1U);
  EXPECT_EQ(eight[0], run_backwards({{0, 1}, {1, 0.5}, {0, 0}}));
}

// Components that do not touch: a box, a hole in it, an island in the hole, and one on top of the
// box's rim of which nothing is to be seen.
TEST(PositiveWinding, NestsComponents) {
  const auto loops =
      positive_winding_border({box_loop(0, 0, 10, 10), run_backwards(box_loop(2, 2, 6, 6)),
                               box_loop(4, 4, 2, 2), box_loop(0.5, 0.5, 1, 1)});
  ASSERT_EQ(loops.size(), 3U);
  EXPECT_EQ(loop_area(loops[0]), 100);
  EXPECT_EQ(loop_area(loops[1]), -36);
  EXPECT_EQ(loop_area(loops[2]), 4);
}

// The border encloses exactly the points around which the curves wind more than 0 times.
TEST(PositiveWinding, AgreesWithTheAngleOfTheCurves) {
  RandomStream random(8, "closed chains");
  const auto coordinate = [&](std::uint32_t steps) {
    return static_cast<double>(random.below(steps + 1)) / steps;
  };
  for (int round = 0; round < 300; ++round) {
    // On a grid of 4 points a side, segments often coincide and meet at their ends.
    const std::uint32_t steps = round % 2 == 0 ? 3 : 1000;
    std::vector<PlaneLoop> curves(1 + random.below(3));
    for (PlaneLoop& curve : curves) {
      const std::uint32_t corners = 3 + random.below(10);
      for (std::uint32_t i = 0; i < corners; ++i) {
        const double x = coordinate(steps);
        curve.emplace_back(x, coordinate(steps));
      }
    }
    const auto loops = positive_winding_border(curves);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d p(coordinate(9973), coordinate(9967));
      bool on_line = false;
      for (const PlaneLoop& curve : curves) {
        for (std::size_t k = 0; k < curve.size(); ++k) {
          const Eigen::Vector2d &a = curve[k], &b = curve[(k + 1) % curve.size()];
          on_line = on_line || std::abs(cross(b - a, p - a)) < 1e-9;
        }
      }
      if (on_line) continue;
      EXPECT_EQ(winding_by_angles(loops, p), winding_by_angles(curves, p) > 0 ? 1 : 0) << round;
    }
  }
}

TEST(PositiveWinding, NamesAPointThatIsNotFinite) {
  PlaneLoop broken = box_loop(0, 0, 1, 1);
  broken[2].y() = NAN;
  EXPECT_THAT(test::error_of([&] {
                positive_winding_border({box_loop(0, 0, 1, 1), broken});
              }),
              ::testing::HasSubstr("point 2 of curve 1"));
}

// n boxes in a row, each over half of the next: one long box.
TEST(PositiveWinding, IsIndependentOfTheOrderOfCurves) {
  std::vector<PlaneLoop> curves;
  for (int i = 0; i < 50; ++i) curves.push_back(box_loop(i, 0.25 * (i % 3), 2, 1));
  const auto loops = positive_winding_border(curves);
  std::reverse(curves.begin(), curves.end());
  EXPECT_EQ(positive_winding_border(curves), loops);
  EXPECT_EQ(loops.size(), 1U);
  EXPECT_GT(total_area(loops), 51);
}

}  // namespace
}  // namespace geoprior::sketch
