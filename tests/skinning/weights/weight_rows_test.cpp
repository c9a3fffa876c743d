#include "experiments/skinning/weights/weight_rows.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace geoprior::skinning {
namespace {

std::vector<Bone> five_bones() {
  std::vector<Bone> bones;
  for (int j = 0; j < 5; ++j) bones.push_back({j, {0, 0, 0}, {1, 0, 0}});
  return bones;
}

Eigen::VectorXd row_of(const std::vector<double>& values, int max_influences) {
  const Eigen::MatrixXd row = Eigen::Map<const Eigen::RowVectorXd>(values.data(), values.size());
  const SkinWeights weights = strongest_influences(row, five_bones(), 5, max_influences);
  return Eigen::VectorXd(weights.row(0).transpose());
}

TEST(StrongestInfluences, AreTheValuesOverTheirSumWhenNoneIsLeftOut) {
  const Eigen::VectorXd w = row_of({0.1, 0, 0.3, 0, 0.1}, 4);
  EXPECT_NEAR((w - Eigen::VectorXd::Map(std::vector<double>{0.2, 0, 0.6, 0, 0.2}.data(), 5)).norm(),
              0, 1e-15);
}

// 0.4, 0.3, 0.2 of five: 0.1 is the largest left out, and (0.3, 0.2, 0.1) / 0.6 is left.
TEST(StrongestInfluences, LoseTheLargestValueLeftOut) {
  const Eigen::VectorXd w = row_of({0.4, 0.1, 0.3, 0.05, 0.2}, 3);
  EXPECT_NEAR(w(0), 1.0 / 2, 1e-15);
  EXPECT_EQ(w(1), 0);
  EXPECT_NEAR(w(2), 1.0 / 3, 1e-15);
  EXPECT_EQ(w(3), 0);
  EXPECT_NEAR(w(4), 1.0 / 6, 1e-15);
}

// Where two influences change places both are at the value that is subtracted.
TEST(StrongestInfluences, AreContinuousWhereTheLastTwoChangePlaces) {
  const double e = 1e-9;
  const Eigen::VectorXd before = row_of({0.4, 0.2 + e, 0.2 - e, 0.2, 0}, 2);
  const Eigen::VectorXd after = row_of({0.4, 0.2 - e, 0.2 + e, 0.2, 0}, 2);
  EXPECT_LE((before - after).lpNorm<Eigen::Infinity>(), 1e-7);
}

TEST(StrongestInfluences, RefuseARowThatNoBoneHolds) {
  EXPECT_THROW(row_of({0, 0, 0, 0, 0}, 4), Error);
}

TEST(StrongestInfluences, OfEqualValuesKeepTheFirst) {
  const Eigen::VectorXd w = row_of({0.2, 0.2, 0.2, 0.2, 0.2}, 2);
  EXPECT_EQ(w(0), 0.5);
  EXPECT_EQ(w(1), 0.5);
}

}  // namespace
}  // namespace geoprior::skinning
