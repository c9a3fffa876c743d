#include "metrics/graphs/plan_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using PlanLine = std::vector<Eigen::Vector2d>;

PlanLine plan_square(double half) {
  return {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
}

PlanLine closed_plan_square(double half) {
  PlanLine out = plan_square(half);
  out.push_back(out.front());
  return out;
}

TEST(PlanDistance, IsZeroOnTheLineItself) {
  const PlanDistance d = plan_distance({closed_plan_square(1)}, plan_square(1), 0.1);
  EXPECT_NEAR(d.to_target, 0, 1e-15);
  EXPECT_NEAR(d.from_target, 0, 1e-15);
}

TEST(PlanDistance, OfConcentricSquaresIsTheirGapAndMoreAtTheOuterCorners) {
  // From the inner square all is 1 away. Of the outer one, of half 2, half of each side is 1 away,
  // and the quarters by the corners sqrt(1 + t^2), t from 0 to 1, whose mean is
  // (sqrt 2 + asinh 1) / 2.
  const PlanDistance d = plan_distance({closed_plan_square(1)}, plan_square(2), 0.001);
  EXPECT_NEAR(d.to_target, 1, 1e-12);
  EXPECT_NEAR(d.from_target, (1 + (std::numbers::sqrt2 + std::asinh(1.)) / 2) / 2, 1e-6);
}

TEST(PlanDistance, WeighsLinesByTheirLength) {
  // On a long side 3 m of line, and 1 m of line 2 away from it.
  const PlanLine target{{0, 0}, {10, 0}, {10, 100}, {0, 100}};
  const std::vector<PlanLine> lines{{{3, 0}, {6, 0}}, {{4, 2}, {5, 2}}};
  EXPECT_NEAR(plan_distance(lines, target, 0.5).to_target, 0.5, 1e-12);
}

TEST(PlanFill, IsTheShareOfTheLatticeThatIsReached) {
  // Points at 0.5, 1.5, 2.5, 3.5 in x and y; a line at y = 1 reaches the two lower rows.
  const std::vector<PlanLine> lines{{{-5, 1}, {5, 1}}};
  const PlanLine region{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_DOUBLE_EQ(plan_fill(lines, region, 1, 0.6), 0.5);
  EXPECT_DOUBLE_EQ(plan_fill(lines, region, 1, 0.4), 0);
  EXPECT_DOUBLE_EQ(plan_fill(lines, region, 1, 10), 1);
}

TEST(PlanFill, CountsTheInsideOfANotConvexPolygon) {
  // An L of three unit squares, a lattice point in each; the line reaches two of them.
  const PlanLine region{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  EXPECT_DOUBLE_EQ(plan_fill({{{0, 0.5}, {2, 0.5}}}, region, 1, 0.1), 2 / 3.);
}

TEST(PlanDistance, RefusesWhatHasNoLengthOrNoInside) {
  test::expect_error([] { (void)plan_distance({}, plan_square(1), 0.1); }, {"no length"});
  test::expect_error([] { (void)plan_distance({{{0, 0}}}, plan_square(1), 0.1); }, {"no length"});
  test::expect_error(
      [] {
        (void)plan_distance({closed_plan_square(1)}, {{0, 0}, {1, 0}}, 0.1);
      },
      {"three corners"});
  test::expect_error(
      [] {
        (void)plan_fill({closed_plan_square(1)}, {{0, 0}, {1, 0}}, 0.1, 1);
      },
      {"three corners"});
  test::expect_error([] { (void)plan_fill({closed_plan_square(1)}, plan_square(1), 10, 1); },
                     {"no point of the lattice"});
}

}  // namespace
}  // namespace geoprior
