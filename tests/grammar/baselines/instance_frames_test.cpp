#include "baselines/grammar/instance_frames.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace geoprior::grammar {
namespace {

/// A root with points of its own, and a chain of three elements along x, 1 m apart.
Hierarchy frame_chain() {
  Hierarchy h;
  const int root = h.add_type({.name = "root"});
  const int link = h.add_type({.name = "link", .parameters = {{"length", "m", 0, 10}}});
  const std::array<Eigen::Vector3d, 2> points{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5, 0, 0)};
  h.add(root, -1, {}, {}, points);
  for (int i = 0; i < 3; ++i) {
    const std::array<double, 1> length{1. + i};
    h.add(link, i, {{1. + i, 0, 0}, Eigen::Quaterniond(.8, 0, .6, 0)}, length);
  }
  return h;
}

Eigen::Affine3d turned_and_stretched() {
  Eigen::Affine3d a = Eigen::Affine3d::Identity();
  a.linear() =
      Eigen::AngleAxisd(.5, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(2, 1, .5).asDiagonal();
  a.translation() = Eigen::Vector3d(.1, .2, .3);
  return a;
}

/// A shift within a ball about (1, 0, 0), with a support.
class ShiftNearOne final : public SpatialMap {
 public:
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override {
    const double s = (x - Eigen::Vector3d::UnitX()).norm() / .5;
    if (s >= 1) return x;
    return x + std::pow(1 - s, 4) * (4 * s + 1) * Eigen::Vector3d(.1, 0, 0);
  }
  [[nodiscard]] std::optional<Eigen::AlignedBox3d> support() const override {
    return Eigen::AlignedBox3d(Eigen::Vector3d(.5, -.5, -.5), Eigen::Vector3d(1.5, .5, .5));
  }
};

TEST(GrammarInstanceFrames, TurnByThePolarRotationAndKeepParameters) {
  const Hierarchy before = frame_chain();
  const AffineMap map(turned_and_stretched());
  const Hierarchy after = instance_frames(before, map);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(.5, Eigen::Vector3d::UnitZ()));
  for (int e = 0; e < before.size(); ++e) {
    EXPECT_EQ(after.position(e), map.at(before.position(e)));
    EXPECT_NEAR(after.turn(e).angularDistance(turn * before.turn(e)), 0, 1e-7);
    for (int p = 0; p < std::ssize(before.parameters(e)); ++p)
      EXPECT_EQ(after.parameter(e, p), before.parameter(e, p));
  }
  EXPECT_EQ(after.points(0)[1], map.at(before.points(0)[1]));
}

TEST(GrammarInstanceFrames, MoveWhatIsBelowAnElementAlone) {
  const Hierarchy before = frame_chain();
  const AffineMap map(turned_and_stretched());
  const Hierarchy after = instance_frames(before, map, 2);
  for (const int e : {0, 1}) {
    EXPECT_EQ(after.position(e), before.position(e));
    EXPECT_EQ(after.turn(e).coeffs(), before.turn(e).coeffs());
  }
  for (const int e : {2, 3}) EXPECT_EQ(after.position(e), map.at(before.position(e)));
}

TEST(GrammarInstanceFrames, StayOutsideTheSupportBitForBit) {
  const Hierarchy before = frame_chain();
  const Hierarchy after = instance_frames(before, ShiftNearOne());
  EXPECT_GT(after.position(1).x(), before.position(1).x());
  for (const int e : {0, 2, 3}) {
    EXPECT_EQ(after.position(e), before.position(e));
    EXPECT_EQ(after.turn(e).coeffs(), before.turn(e).coeffs());
  }
}

}  // namespace
}  // namespace geoprior::grammar
