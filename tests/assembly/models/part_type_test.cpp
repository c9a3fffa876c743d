// Frames of ports, how far they are from being mated, and motions that carry a part onto itself.

#include "models/assembly/graph/part_type.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Pose oblique_pose() {
  Pose out = Pose::Identity();
  out.linear() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  out.translation() = Eigen::Vector3d(0.3, -2, 5);
  return out;
}

/// Four arms of one length, at right angles.
PartType crossing_track() {
  PartType out;
  out.label = "crossing";
  for (int i = 0; i < 4; ++i) {
    const double heading = i * std::numbers::pi / 2;
    out.ports.push_back({"p" + std::to_string(i),
                         plane_pose(0.1 * std::cos(heading), 0.1 * std::sin(heading), heading)});
  }
  return out;
}

TEST(Ports, MatedFramesLookAtEachOtherWithOneUp) {
  const Pose port = oblique_pose(), there = mated(port);
  EXPECT_TRUE(there.translation().isApprox(port.translation()));
  EXPECT_TRUE(there.linear().col(0).isApprox(-port.linear().col(0), 1e-15));
  EXPECT_TRUE(there.linear().col(2).isApprox(port.linear().col(2), 1e-15));
  EXPECT_TRUE(mated(there).isApprox(port, 1e-15));
}

TEST(Ports, MisfitIsDistanceAndAngleFromBeingMated) {
  const Pose port = oblique_pose();
  EXPECT_NEAR(misfit(port, mated(port)).translation, 0, 1e-15);
  EXPECT_NEAR(misfit(port, mated(port)).angle, 0, 1e-15);
  Pose moved = mated(port);
  moved.pretranslate(Eigen::Vector3d(0.003, 0, 0.004));
  EXPECT_NEAR(misfit(port, moved).translation, 0.005, 1e-15);
  // An angle of 1e-8 is seen: an arc cosine of the trace would give 0.
  for (const double angle : {1e-8, 0.1, 2., std::numbers::pi}) {
    const Pose turned =
        mated(port) * Eigen::AngleAxisd(angle, Eigen::Vector3d(2, -1, 1).normalized());
    EXPECT_NEAR(misfit(port, turned).angle, angle, angle == std::numbers::pi ? 1e-7 : 1e-14);
    EXPECT_NEAR(misfit(turned, port).angle, angle, angle == std::numbers::pi ? 1e-7 : 1e-14);
  }
  // A port that lies on the other instead of facing it is half a turn off.
  EXPECT_NEAR(misfit(port, port).angle, std::numbers::pi, 1e-7);
}

TEST(PartSymmetries, OfAStraightAreHalfATurn) {
  const auto found = find_symmetries(straight_track("s", 0.2), 1e-6);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_THAT(found[0].ports, ElementsAre(1, 0));
  EXPECT_TRUE((found[0].motion * Eigen::Vector3d(0.05, 0.01, 0.02))
                  .isApprox(Eigen::Vector3d(0.15, -0.01, 0.02), 1e-12));
}

TEST(PartSymmetries, OfACurveAreNone) {
  EXPECT_THAT(find_symmetries(curved_track("c", 0.5, 0.4), 1e-6), IsEmpty());
}

TEST(PartSymmetries, OfACrossingAreThreeTurnsThatWithNoneAreAGroup) {
  const auto found = find_symmetries(crossing_track(), 1e-6);
  ASSERT_THAT(found, SizeIs(3));
  for (int turn = 1; turn <= 3; ++turn)
    for (int i = 0; i < 4; ++i) EXPECT_EQ(found[turn - 1].ports[i], (i + turn) % 4);
}

TEST(PartSymmetries, AreNoneOfPortsThatDifferInHeight) {
  PartType ramp = straight_track("ramp", 0.2);
  ramp.ports[1].frame.translation().z() = -0.05;
  EXPECT_THAT(find_symmetries(ramp, 1e-6), IsEmpty());
}

TEST(PartSymmetries, AreTakenAwayByAMeshThatIsNotSymmetric) {
  PartType track = straight_track("s", 0.2);
  track.mesh.V.resize(4, 3);
  track.mesh.V << 0.05, 0.01, 0, 0.15, -0.01, 0, 0.05, -0.01, 0, 0.15, 0.01, 0;
  track.mesh.F.resize(2, 3);
  track.mesh.F << 0, 2, 1, 0, 1, 3;
  EXPECT_THAT(find_symmetries(track, 1e-6), SizeIs(1));
  track.mesh.V(0, 1) += 1e-3;
  EXPECT_THAT(find_symmetries(track, 1e-6), IsEmpty());
  EXPECT_THAT(find_symmetries(track, 2e-3), SizeIs(1));
}

TEST(PartSymmetries, AreTakenAwayByABoxThatIsNotSymmetric) {
  PartType track = straight_track("s", 0.2);
  track.boxes.push_back({plane_pose(0.1, 0, 0), {0.08, 0.01, 0.01}});
  EXPECT_THAT(find_symmetries(track, 1e-6), SizeIs(1));
  track.boxes.push_back({plane_pose(0.05, 0, 0), {0.01, 0.02, 0.01}});
  EXPECT_THAT(find_symmetries(track, 1e-6), IsEmpty());
}

TEST(PartSymmetries, OfAPartWithoutPortsAreNone) {
  EXPECT_THAT(find_symmetries(PartType{}, 1e-6), IsEmpty());
}

}  // namespace
}  // namespace geoprior::assembly
