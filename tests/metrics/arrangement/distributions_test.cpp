#include "metrics/arrangement/distributions.h"

#include <gtest/gtest.h>

#include <vector>

namespace geoprior {
namespace {

TEST(ArrangementDistributions, OfTheSameSharesHaveNoDistance) {
  EXPECT_EQ(*kolmogorov_smirnov(std::vector<double>{3, 1, 2}, std::vector<double>{1, 2, 3}), 0);
  EXPECT_EQ(*kolmogorov_smirnov(std::vector<double>{1, 2}, std::vector<double>{1, 1, 2, 2}), 0);
}

TEST(ArrangementDistributions, ApartHaveTheDistanceOne) {
  EXPECT_EQ(*kolmogorov_smirnov(std::vector<double>{1, 2}, std::vector<double>{3}), 1);
  EXPECT_EQ(*kolmogorov_smirnov(std::vector<double>{3}, std::vector<double>{1, 2}), 1);
}

TEST(ArrangementDistributions, DifferByTheLargestDifferenceOfShares) {
  // Shares up to 1: 2/4 against 1/4; up to 2: 3/4 against 1/4; up to 3: 3/4 against 4/4.
  EXPECT_EQ(*kolmogorov_smirnov(std::vector<double>{1, 1, 2, 4}, std::vector<double>{1, 3, 3, 3}),
            0.5);
  // Uniform values moved by a quarter of their range.
  std::vector<double> x, moved;
  for (int i = 0; i < 100; ++i) {
    x.push_back(i);
    moved.push_back(i + 25);
  }
  EXPECT_DOUBLE_EQ(*kolmogorov_smirnov(x, moved), 0.25);
}

TEST(ArrangementDistributions, OfNothingHaveNone) {
  EXPECT_FALSE(kolmogorov_smirnov(std::vector<double>{}, std::vector<double>{1}));
}

}  // namespace
}  // namespace geoprior
