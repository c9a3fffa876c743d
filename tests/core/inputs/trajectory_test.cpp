#include "core/inputs/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace geoprior {
namespace {

Keyframe key(double time, const Eigen::Vector3d& shift, double turn_deg = 0,
             const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  return {time, shift,
          Eigen::Quaterniond(Eigen::AngleAxisd(turn_deg * std::numbers::pi / 180, axis))};
}

Eigen::Vector3d along(double x) { return {x, -2 * x, 0.5}; }

// Two keys at rest: the Hermite cubic is the smoothstep 3 s^2 - 2 s^3, so 5/32 at a quarter.
TEST(Trajectory, BetweenTwoKeysIsTheSmoothStep) {
  const Trajectory t{{key(1, along(0)), key(3, along(4))}};
  EXPECT_NEAR((t.at(1.5).shift - along(4 * 5.0 / 32)).norm(), 0, 1e-15);
  EXPECT_NEAR((t.at(2).shift - along(2)).norm(), 0, 1e-15);
}

TEST(Trajectory, StandsStillBeforeTheFirstAndAfterTheLastKey) {
  const Trajectory t{{key(1, along(1), 20), key(3, along(4), 50)}};
  EXPECT_EQ(t.at(-5).shift, along(1));
  EXPECT_EQ(t.at(9).shift, along(4));
  EXPECT_NEAR(t.at(9).turn.angularDistance(t.keys[1].turn), 0, 1e-12);
  EXPECT_EQ(Trajectory{}.at(3).shift, Eigen::Vector3d::Zero());
}

// Velocity in the middle of equal steps is their finite difference, so a straight line of three
// keys passes its middle at 2 m in 2 s.
TEST(Trajectory, PassesAMiddleKeyAtTheMeanSpeed) {
  const Trajectory t{{key(0, along(0)), key(1, along(1)), key(2, along(2))}};
  const double h = 1e-7;  // the acceleration jumps at a key: the difference is off by h times that
  const Eigen::Vector3d velocity = (t.at(1 + h).shift - t.at(1 - h).shift) / (2 * h);
  EXPECT_NEAR((velocity - along(1) + along(0)).norm(), 0, 1e-6);
}

// A plain Hermite spline through 0, 1, 1, 0.2 would overshoot 1 between the two equal keys.
TEST(Trajectory, NeverOvershootsTwoKeys) {
  const Trajectory t{{key(0, along(0)), key(0.1, along(1)), key(2, along(1)), key(2.1, along(0.2)),
                      key(5, along(0.3))}};
  for (std::size_t i = 0; i + 1 < t.keys.size(); ++i) {
    for (int k = 0; k <= 200; ++k) {
      const double s = k / 200.0;
      const double time = (1 - s) * t.keys[i].time + s * t.keys[i + 1].time;
      const Eigen::Vector3d x = t.at(time).shift;
      const Eigen::Vector3d a = t.keys[i].shift, b = t.keys[i + 1].shift;
      for (int c = 0; c < 3; ++c) {
        EXPECT_GE(x[c], std::min(a[c], b[c]) - 1e-14) << "at " << time;
        EXPECT_LE(x[c], std::max(a[c], b[c]) + 1e-14) << "at " << time;
      }
    }
  }
}

// About one axis rotations add like angles: the same smoothstep holds.
TEST(Trajectory, TurnsAboutAFixedAxisLikeANumber) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -1).normalized();
  const Trajectory t{{key(0, along(0), 10, axis), key(2, along(0), 130, axis)}};
  const double angle = 10 + 120 * 5.0 / 32;
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle * std::numbers::pi / 180, axis));
  EXPECT_NEAR(t.at(0.5).turn.angularDistance(expected), 0, 1e-7);
}

// Rotations about different axes: the angular velocity is the same on both sides of a key.
TEST(Trajectory, TurnsWithoutAJerkAtAKey) {
  Trajectory t{{key(0, along(0), 0), key(1, along(0), 60, Eigen::Vector3d(1, 1, 0).normalized()),
                key(2, along(0), 110, Eigen::Vector3d(1, 1, 0.4).normalized()),
                key(3, along(0), 90, Eigen::Vector3d(0, 1, 1).normalized())}};
  const double h = 1e-5;
  for (const double time : {1.0, 2.0}) {
    const Eigen::Quaterniond q = t.at(time).turn;
    const Eigen::Vector3d before = 2 / h * (t.at(time - h).turn.conjugate() * q).vec();
    const Eigen::Vector3d after = 2 / h * (q.conjugate() * t.at(time + h).turn).vec();
    EXPECT_GT(after.norm(), 0.1);
    EXPECT_NEAR((after - before).norm(), 0, 1e-3);
  }
}

}  // namespace
}  // namespace geoprior
