#include "metrics/developability/ruling_angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace geoprior {
namespace {

using Rulings = std::vector<std::array<Eigen::Vector3d, 2>>;

const Eigen::Vector3d kApex(0, 3, 0);

TEST(RulingAngle, VanishesOnTheConeAndTellsATurn) {
  Rulings rulings;
  for (int k = 0; k < 12; ++k) {
    const Eigen::Vector3d foot(std::cos(k), 0, std::sin(k));
    rulings.push_back({foot, foot + 0.4 * (kApex - foot)});
  }
  EXPECT_NEAR(ruling_angle_rms(rulings, kApex, {0, 0, 0}).value(), 0, 1e-12);
  std::swap(rulings[3][0], rulings[3][1]);
  EXPECT_NEAR(ruling_angle_rms(rulings, kApex, {0, 0, 0}).value(), 0, 1e-12) << "without sense";
  // A tenth of a radian about the middle, one ruling of twelve.
  const Eigen::Vector3d middle = (rulings[0][0] + rulings[0][1]) / 2;
  const Eigen::Vector3d along = (rulings[0][1] - rulings[0][0]) / 2;
  const Eigen::Vector3d across = Eigen::Vector3d(0, 0, 1) * along.norm();  // foot 0 has z = 0
  const Eigen::Vector3d turned = std::cos(0.1) * along + std::sin(0.1) * across;
  rulings[0] = {middle - turned, middle + turned};
  EXPECT_NEAR(ruling_angle_rms(rulings, kApex, {0, 0, 0}).value(), 0.1 / std::sqrt(12.0), 1e-12);
}

TEST(RulingAngle, ShiftsRulingsAndLeavesOutThoseWithoutLength) {
  const Eigen::Vector3d foot(1, 0, 0);
  const Rulings moved{{foot + Eigen::Vector3d(0, 0, 5), kApex + Eigen::Vector3d(0, 0, 5)}};
  EXPECT_NEAR(ruling_angle_rms(moved, kApex, {0, 0, -5}).value(), 0, 1e-12);
  EXPECT_GT(ruling_angle_rms(moved, kApex, {0, 0, 0}).value(), std::numbers::pi / 8);
  EXPECT_FALSE(ruling_angle_rms({{foot, foot}}, kApex, {0, 0, 0}));
}

}  // namespace
}  // namespace geoprior
