#include "solvers/skinning/field/caps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/geometry/procedural.h"
#include "core/mesh.h"
#include "solvers/skinning/field/sampling.h"

namespace geoprior::skinning {
namespace {

std::vector<Eigen::Vector3d> ring(double a, double b, int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double psi = 2 * std::numbers::pi * i / count;
    points.emplace_back(0.0, a * std::cos(psi), b * std::sin(psi));
  }
  return points;
}

const BoneEnd kEnd{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()};

// rho(psi) = pole = r makes the dome a sphere: radius and radial normals hold to the finite
// differences of the normal.
TEST(DomeCap, OfARoundRingIsAHemisphere) {
  const CapSamples cap = dome_cap(kEnd, ring(0.05, 0.05, 64), 0.05);
  ASSERT_EQ(cap.points.size(), 17U);
  for (std::size_t i = 0; i < cap.points.size(); ++i) {
    EXPECT_NEAR(cap.points[i].norm(), 0.05, 1e-12);
    EXPECT_GT(cap.points[i].x(), 0);
    EXPECT_NEAR(cap.normals[i].dot(cap.points[i].normalized()), 1, 1e-7);
  }
}

// The series of order two holds an ellipse of small eccentricity to second order of its flattening
// (5 %: 2.5e-3).
TEST(DomeCap, StaysInsideTheRingItContinues) {
  const CapSamples cap = dome_cap(kEnd, ring(0.0525, 0.0475, 64), 0.045);
  for (const Eigen::Vector3d& p : cap.points) {
    EXPECT_LT(p.norm(), 0.0525 * (1 + 2.5e-3));
    EXPECT_GT(p.norm(), 0.045 * (1 - 1e-12));
  }
}

TEST(DomeCap, OfSkinOnOneSideOnlyIsAPointOnTheAxis) {
  std::vector<Eigen::Vector3d> half = ring(0.05, 0.05, 64);
  std::erase_if(half, [](const Eigen::Vector3d& p) { return p.y() < 0; });
  const CapSamples cap = dome_cap(kEnd, half, 0.04);
  ASSERT_EQ(cap.points.size(), 1U);
  EXPECT_NEAR((cap.points[0] - 0.04 * Eigen::Vector3d::UnitX()).norm(), 0, 1e-15);
}

// A bone between two others is closed at both joints, one at the end of a chain at one.
TEST(BoneSamples, HaveACapForEveryJointSharedWithAnotherBone) {
  const RiggedMesh rig = capsule_finger();
  const BonePartition partition = partition_bones(rig, PartitionRule::closest_bone, 1);
  const Eigen::MatrixX3d normals = vertex_normals(rig.mesh);
  SamplingOptions options;
  options.caps = CapKind::point;
  const auto last = static_cast<int>(partition.bones.size()) - 1;
  ASSERT_EQ(last, 3);
  for (int b = 0; b <= last; ++b) {
    const BoneSamples samples =
        sample_bone(rig.mesh, normals, partition, b, options, RandomStream(1, "caps"));
    EXPECT_EQ(samples.cap_count, b == 0 || b == last ? 1 : 2) << "bone " << b;
  }
}

}  // namespace
}  // namespace geoprior::skinning
