#include "metrics/arrangement/crossings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"

namespace geoprior {
namespace {

using Eigen::Vector3d;
using CrossingPairs = std::vector<std::pair<int, int>>;

TEST(ArrangementCrossings, DistanceOfAxesInClosedForm) {
  const ThickSegment x{{-1, 0, 0}, {1, 0, 0}, 0};
  // Skew, end against middle, end against end, parallel, in line, and points.
  EXPECT_EQ(axes_distance(x, {{0, -1, 2}, {0, 1, 2}, 0}), 2);
  EXPECT_EQ(axes_distance(x, {{0.5, 3, 0}, {0.5, 9, 0}, 0}), 3);
  EXPECT_EQ(axes_distance(x, {{4, 4, 0}, {9, 9, 0}, 0}), 5);
  EXPECT_EQ(axes_distance(x, {{0.5, 1, 0}, {7, 1, 0}, 0}), 1);
  EXPECT_EQ(axes_distance(x, {{3, 0, 0}, {4, 0, 0}, 0}), 2);
  EXPECT_EQ(axes_distance(x, {{0, 0, 7}, {0, 0, 7}, 0}), 7);
  EXPECT_EQ(axes_distance({{0, 3, 0}, {0, 3, 0}, 0}, {{4, 0, 0}, {4, 0, 0}, 0}), 5);
}

TEST(ArrangementCrossings, CountDeeperThanTheTolerance) {
  // Two crossed rods whose axes are 1 m apart, each of radius r.
  const auto count = [](double r) {
    const std::vector<ThickSegment> rods{{{-2, 0, 0}, {2, 0, 0}, r}, {{0, -2, 1}, {0, 2, 1}, r}};
    return crossings(rods, 1e-9).size();
  };
  EXPECT_EQ(count(0.499), 0);
  EXPECT_EQ(count(0.5), 0);
  EXPECT_EQ(count(0.501), 1);
}

TEST(ArrangementCrossings, OfACombAreItsTeethAndItsBack) {
  // A back along x and ten teeth that leave it: each tooth crosses the back, and no other.
  std::vector<ThickSegment> comb{{{0, 0, 0}, {10, 0, 0}, 0.1}};
  for (int i = 0; i < 10; ++i) comb.push_back({{i + 0.5, 0, 0}, {i + 0.5, 3, 0}, 0.1});
  const CrossingPairs found = crossings(comb, 1e-9);
  ASSERT_EQ(found.size(), 10);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(found[i], std::pair(0, i + 1));
  EXPECT_TRUE(crossings(comb, 1e-9, [](int lower, int) { return lower == 0; }).empty());
  EXPECT_TRUE(crossings({}, 1e-9).empty());
}

TEST(ArrangementCrossings, AreThoseOfAllPairs) {
  RandomStream random(1, "crossings");
  const auto point = [&] { return Vector3d(random.uniform(), random.uniform(), random.uniform()); };
  std::vector<ThickSegment> rods;
  for (int i = 0; i < 200; ++i) {
    const Vector3d a = point();
    rods.push_back({a, a + 0.3 * (point() - Vector3d(0.5, 0.5, 0.5)), 0.03 * random.uniform()});
  }
  CrossingPairs all;
  for (int i = 0; i < 200; ++i)
    for (int j = i + 1; j < 200; ++j)
      if (axes_distance(rods[i], rods[j]) < rods[i].radius + rods[j].radius - 1e-9)
        all.emplace_back(i, j);
  EXPECT_GT(all.size(), 20);
  EXPECT_EQ(crossings(rods, 1e-9), all);
}

}  // namespace
}  // namespace geoprior
