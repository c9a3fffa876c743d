#include "metrics/arrangement/spacing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "core/random.h"
#include "metrics/arrangement/point_grid.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using Eigen::Vector3d;

/// n x n x n points one apart.
std::vector<Vector3d> cubic_lattice(int n) {
  std::vector<Vector3d> out;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) out.emplace_back(x, y, z);
  return out;
}

std::vector<Vector3d> scattered_points(int n, double thickness) {
  RandomStream random(7, "scattered points");
  std::vector<Vector3d> out;
  for (int i = 0; i < n; ++i)
    out.emplace_back(random.uniform(), random.uniform(), thickness * random.uniform());
  return out;
}

TEST(ArrangementSpacing, OfALatticeIsItsConstantOverTheExtents) {
  const std::vector<Vector3d> x = cubic_lattice(6);
  const std::vector<double> touching(x.size(), 0.5), apart(x.size(), 0.25), close(x.size(), 0.625);
  EXPECT_EQ(*check_spacing(x, touching, 1e-9).smallest_ratio, 1);
  EXPECT_TRUE(check_spacing(x, touching, 1e-9).too_close.empty());
  EXPECT_EQ(*check_spacing(x, apart, 1e-9).smallest_ratio, 2);
  // 3 n^2 (n - 1) pairs are one apart; the diagonals of faces are longer than 1.25.
  EXPECT_EQ(*check_spacing(x, close, 1e-9).smallest_ratio, 0.8);
  EXPECT_EQ(check_spacing(x, close, 1e-9).too_close.size(), 3 * 36 * 5);
}

TEST(ArrangementSpacing, ElementsWithoutExtentAreNotSeen) {
  const std::vector<Vector3d> x{{0, 0, 0}, {0.1, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(*check_spacing(x, std::vector<double>{0.5, 0, 0.5}, 0).smallest_ratio, 2);
  EXPECT_FALSE(check_spacing(x, std::vector<double>{0.5, 0, 0}, 0).smallest_ratio);
  // Pairs have the numbers of the points, those that are not seen counted.
  const SpacingCheck close = check_spacing(x, std::vector<double>{1.5, 0, 1.5}, 0);
  EXPECT_EQ(close.too_close, (std::vector<std::pair<int, int>>{{0, 2}}));
}

TEST(ArrangementSpacing, FindsALargeElementBehindSmallOnes) {
  // The nearest of the first is small and far enough; the pair that is too close is the other one.
  const std::vector<Vector3d> x{{0, 0, 0}, {1, 0, 0}, {0, 3, 0}};
  const SpacingCheck check = check_spacing(x, std::vector<double>{0.5, 0.1, 3.5}, 1e-9);
  EXPECT_EQ(*check.smallest_ratio, 0.75);
  using Pairs = std::vector<std::pair<int, int>>;
  EXPECT_EQ(check.too_close, (Pairs{{0, 2}, {1, 2}}));  // also sqrt(10) < 3.6
}

TEST(ArrangementSpacing, IsThatOfAllPairs) {
  for (const double thickness : {0.0, 1e-3, 1.0}) {
    const std::vector<Vector3d> x = scattered_points(300, thickness);
    RandomStream random(3, "extents");
    std::vector<double> extents;
    for (std::size_t i = 0; i < x.size(); ++i) extents.push_back(0.02 * random.uniform());
    double smallest = std::numeric_limits<double>::infinity();
    std::set<std::pair<int, int>> too_close;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double distance = (x[i] - x[j]).norm(), sum = extents[i] + extents[j];
        smallest = std::min(smallest, distance / sum);
        if (distance < sum - 1e-9) too_close.insert({static_cast<int>(j), static_cast<int>(i)});
      }
    const SpacingCheck check = check_spacing(x, extents, 1e-9);
    EXPECT_EQ(*check.smallest_ratio, smallest);
    EXPECT_EQ(std::set(check.too_close.begin(), check.too_close.end()), too_close);
    EXPECT_EQ(check.too_close.size(), too_close.size());
  }
}

TEST(ArrangementSpacing, NearestOfAGridIsThatOfAllPoints) {
  for (const double thickness : {0.0, 1.0}) {
    const PointGrid grid(scattered_points(200, thickness));
    for (const Vector3d& x : {Vector3d(0.3, 0.4, 0.1), Vector3d(9, -4, 3), Vector3d(1, 1, 1)}) {
      PointGrid::Nearest all;
      for (int i = 0; i < grid.size(); ++i)
        if (const double d = (grid.point(i) - x).norm(); d < all.distance) all = {i, d};
      EXPECT_EQ(grid.nearest(x).point, all.point);
      EXPECT_EQ(grid.nearest(x).distance, all.distance);
    }
  }
  EXPECT_EQ(PointGrid({}).nearest({0, 0, 0}).point, -1);
  EXPECT_EQ(PointGrid({{1, 2, 3}}).nearest({0, 0, 0}, 0).point, -1);
}

TEST(ArrangementSpacing, NearestNeighboursOfALatticeDoNotVary) {
  const std::vector<double> distances = nearest_neighbour_distances(cubic_lattice(4));
  EXPECT_EQ(distances, std::vector<double>(64, 1.0));
  EXPECT_EQ(*coefficient_of_variation(distances), 0);
  EXPECT_TRUE(nearest_neighbour_distances(std::vector<Vector3d>{{1, 2, 3}}).empty());
  // Of 1 and 3: the mean is 2, the standard deviation of the population 1.
  EXPECT_EQ(*coefficient_of_variation(std::vector<double>{1, 3}), 0.5);
  EXPECT_FALSE(coefficient_of_variation({}));
}

TEST(ArrangementSpacing, HoleOfALatticeIsHalfTheDiagonalOfACube) {
  EXPECT_NEAR(*largest_hole(std::vector<Vector3d>{{1, 1, 1}, {1.5, 1.5, 1.5}}, cubic_lattice(4)),
              std::sqrt(0.75), 1e-15);
  EXPECT_FALSE(largest_hole({}, cubic_lattice(2)));
  EXPECT_FALSE(largest_hole(cubic_lattice(2), {}));
}

TEST(ArrangementSpacing, RefusesExtentsThatAreNone) {
  const std::vector<Vector3d> x{{0, 0, 0}, {1, 0, 0}};
  test::expect_error([&] { (void)check_spacing(x, std::vector<double>{1}, 0); },
                     {"1 extents for 2 points"});
  test::expect_error([&] { (void)check_spacing(x, std::vector<double>{1, -1}, 0); }, {"point 1"});
}

}  // namespace
}  // namespace geoprior
