#include "metrics/tracks/weighted_quantile.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace geoprior {
namespace {

TEST(WeightedQuantile, SplitsTheWeightNotTheCount) {
  const Eigen::Vector4d values(4, 1, 3, 2);
  EXPECT_EQ(weighted_quantile(values, Eigen::Vector4d(1, 1, 1, 1), 0.5), 2);
  EXPECT_EQ(weighted_quantile(values, Eigen::Vector4d(5, 1, 1, 1), 0.5), 4);
  EXPECT_EQ(weighted_quantile(values, Eigen::Vector4d(1, 5, 1, 1), 0.5), 1);
  EXPECT_EQ(weighted_quantile(values, Eigen::Vector4d(1, 1, 1, 1), 1), 4);
  EXPECT_EQ(weighted_quantile(values, Eigen::Vector4d(1, 1, 1, 1), 0), 1);
}

TEST(WeightedQuantile, RefusesUnequalSizesAndNothing) {
  EXPECT_THROW(weighted_quantile(Eigen::VectorXd(), Eigen::VectorXd(), 0.5), Error);
  EXPECT_THROW(weighted_quantile(Eigen::Vector2d(1, 2), Eigen::Vector3d(1, 1, 1), 0.5), Error);
}

}  // namespace
}  // namespace geoprior
