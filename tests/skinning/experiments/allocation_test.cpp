// A pose is solved in the buffers of the one before it.
#include <gtest/gtest.h>

#include "baselines/skinning/centers_of_rotation/centers_of_rotation.h"
#include "baselines/skinning/delta_mush.h"
#include "baselines/skinning/direct_delta_mush/direct_delta_mush.h"
#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "baselines/skinning/linear_blend/linear_blend.h"
#include "core/parallel.h"
#include "solvers/skinning/implicit.h"
#include "tests/core/allocations.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

using namespace fixtures;

/// Allocations of the second of two poses, on one thread; absent where they are not counted.
template <class Deform>
std::optional<std::size_t> of_second_pose(const RiggedMesh& rig, const Deform& deform) {
  const Pose first = curled(rig, 0.9), second = curled(rig, 0.4);
  std::optional<std::size_t> count;
  with_threads(1, [&] {
    const auto of_first = test::allocations_of([&] { deform(first); });
    if (of_first) {
      EXPECT_GT(*of_first, 0U) << "the posed vertices need room";
    }
    count = test::allocations_of([&] { deform(second); });
  });
  return count;
}

class AllocationsOfAPose : public testing::Test {
 protected:
  void expect_none(const std::function<void(const Pose&)>& deform) {
    const auto count = of_second_pose(rig, deform);
    if (!count) GTEST_SKIP() << "a sanitizer build";
    EXPECT_EQ(*count, 0U);
  }
  const RiggedMesh rig = capsule_finger();
  Eigen::MatrixX3d posed;
  RunContext context;
};

TEST_F(AllocationsOfAPose, LinearBlendMakesNone) {
  const LinearBlend method(rig);
  expect_none([&](const Pose& pose) { method.deform(pose, posed); });
}

TEST_F(AllocationsOfAPose, DualQuaternionsMakeNone) {
  const DualQuaternionBlend method(rig);
  expect_none([&](const Pose& pose) { method.deform(pose, posed); });
}

TEST_F(AllocationsOfAPose, DeltaMushMakesNone) {
  DeltaMush method(rig, {});
  expect_none([&](const Pose& pose) { method.deform(pose, posed); });
}

TEST_F(AllocationsOfAPose, CentersOfRotationMakeNone) {
  const CentersOfRotation method(rig);
  expect_none([&](const Pose& pose) { method.deform(pose, posed); });
}

TEST_F(AllocationsOfAPose, DirectDeltaMushMakesNone) {
  const DirectDeltaMush method(rig);
  expect_none([&](const Pose& pose) { method.deform(pose, posed); });
}

TEST_F(AllocationsOfAPose, ImplicitSkinningMakesNone) {
  ImplicitOptions options;
  options.projection = ProjectionKind::marching;
  ImplicitSkinning method(rig, options, context);
  expect_none([&](const Pose& pose) { method.deform(pose, posed, context); });
}

TEST_F(AllocationsOfAPose, TheSmoothCorrectionMakesNone) {
  ImplicitSkinning method(rig, {}, context);
  expect_none([&](const Pose& pose) { method.deform(pose, posed, context); });
}

}  // namespace
}  // namespace geoprior::skinning
