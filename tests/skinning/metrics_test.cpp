#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/procedural.h"
#include "experiments/skinning/scene.h"
#include "experiments/skinning/topic.h"
#include "tests/testbed/metric_table.h"

namespace geoprior::skinning {
namespace {

/// The tube bent in steps of 30 degrees, posed by linear blending.
class BentTube : public ::testing::Test {
 protected:
  BentTube() {
    scene.rig = two_bone_cylinder();
    scene.regions = {make_joint_region(scene.rig, "upper", {1}, {Eigen::Vector3d::UnitY()})};
    for (int i = 0; i < 6; ++i) {
      const double degrees = 30 * i;
      scene.frame_parameter.push_back(degrees);
      Pose pose = rest_pose(2);
      pose[1].linear() =
          Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitY())
              .toRotationMatrix();
      scene.frame_pose.push_back(pose);
    }
  }

  [[nodiscard]] Frame posed(std::size_t i) const {
    Frame frame;
    frame.parameter = scene.frame_parameter[i];
    Part& part = frame.parts["surface"];
    part.triangles = scene.rig.mesh.F;
    part.points.resize(scene.rig.mesh.V.rows(), 3);
    for (int v = 0; v < scene.rig.mesh.vertex_count(); ++v) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (SkinWeights::InnerIterator it(scene.rig.weights, v); it; ++it) {
        sum += it.value() * (scene.frame_pose[i][it.col()] * scene.rig.mesh.V.row(v).transpose());
      }
      part.points.row(v) = sum.transpose();
    }
    return frame;
  }

  std::optional<double> value(const std::string& name, const Frame& frame,
                              const Frame* reference = nullptr) const {
    return table.of_frame(name, scene, frame, reference);
  }

  SkinningScene scene;
  test::MetricTable table{skinning::metrics()};
};

TEST_F(BentTube, RestFrameHasNothingToReport) {
  const Frame rest = posed(0);
  for (const char* name : {"volume_change", "volume_change_global", "overlap_excess",
                           "overlap_excess_raw", "intersecting_pairs", "rest_identity"}) {
    EXPECT_NEAR(value(name, rest).value(), 0, 1e-12) << name;  // weights that sum to 1 by round-off
  }
  for (const char* name : {"mid_ring_min", "mid_ring_max", "section_shrink", "area_ratio_p05"}) {
    EXPECT_NEAR(value(name, rest).value(), 1, 1e-12) << name;
  }
  EXPECT_GT(value("overlap_noise_floor", rest).value(), 0);
}

TEST_F(BentTube, BentFramesFollowTheClosedForms) {
  for (std::size_t i = 1; i < 6; ++i) {
    const Frame frame = posed(i);
    const double half = frame.parameter * std::numbers::pi / 360;
    EXPECT_NEAR(value("mid_ring_min", frame).value(), std::cos(half), 1e-12);
    EXPECT_NEAR(value("mid_ring_max", frame).value(), 1, 1e-12);
    EXPECT_LE(value("elbow_collapse", frame).value(), std::cos(half) + 1e-9);
    EXPECT_LT(value("volume_change", frame).value(), 0);
    EXPECT_EQ(value("volume_change_size", frame).value(), -value("volume_change", frame).value());
    EXPECT_FALSE(value("rest_identity", frame).has_value());
  }
  // Folded to 150 degrees the tube runs into itself.
  EXPECT_GT(value("overlap_excess", posed(5)).value(),
            100 * value("overlap_noise_floor", posed(5)).value());
  EXPECT_GT(value("intersecting_pairs", posed(5)).value(), 10);
}

TEST_F(BentTube, OverlapBelowTheFloorCountsAsNone) {
  const Frame shallow = posed(2);
  const Frame deep = posed(5);
  EXPECT_EQ(value("overlap_excess", shallow).value(), 0);
  EXPECT_DOUBLE_EQ(value("overlap_excess_ratio", deep, &deep).value(), 1);
  EXPECT_EQ(value("overlap_excess_ratio", shallow, &deep).value(), 0);
  // Against a reference without overlap, its floor is what counts.
  EXPECT_GT(value("overlap_excess_ratio", deep, &shallow).value(), 100);
  EXPECT_FALSE(value("overlap_excess_ratio", deep).has_value());
}

TEST_F(BentTube, DistanceIsToTheReferenceFrame) {
  const Frame frame = posed(3);
  Frame moved = frame;
  moved.parts["surface"].points.col(1).array() += 0.01;
  EXPECT_NEAR(value("distance_to_reference_rms", moved, &frame).value(), 0.01, 1e-12);
  EXPECT_NEAR(value("distance_to_reference_max", moved, &frame).value(), 0.01, 1e-12);
  EXPECT_FALSE(value("distance_to_reference_max", moved).has_value());
}

TEST_F(BentTube, PopsAreSeenAndRigidMotionIsNot) {
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < 6; ++i) frames.push_back(posed(i));
  const auto pops = [&](const std::vector<Frame>& sequence) {
    return table.of_sequence("second_difference_max", scene, sequence);
  };
  const double smooth = pops(frames).value();
  // The pull of the blended ring is about r (30 degrees)^2 / 4; rigid ends would add 0.5 m times
  // (30 degrees)^2 = 0.14 m.
  EXPECT_LT(smooth, 0.06);
  const int ring = mid_ring({}).front();
  frames[3].parts["surface"].points.row(ring) += Eigen::RowVector3d(0, 0.1, 0);
  EXPECT_GT(pops(frames).value(), 0.15);
  frames.erase(frames.begin() + 1);
  EXPECT_FALSE(pops(frames).has_value());  // unequal steps
}

TEST_F(BentTube, WithoutARegionTheWholeBodyIsMeasured) {
  scene.regions.clear();
  const Frame deep = posed(5);
  EXPECT_GT(value("overlap_excess", deep).value(), 0);
  EXPECT_GT(value("intersecting_pairs", deep).value(), 10);
  for (const char* name : {"volume_change", "section_shrink", "outer_bulge", "area_ratio_p05",
                           "mid_ring_min", "singular_value_max"}) {
    EXPECT_FALSE(value(name, deep).has_value()) << name;
  }
}

TEST_F(BentTube, OpenMeshHasNoOverlapVolume) {
  scene.rig.mesh.F.conservativeResize(scene.rig.mesh.F.rows() - 1, 3);
  scene.regions.clear();
  EXPECT_FALSE(value("overlap_excess", posed(1)).has_value());
  EXPECT_FALSE(value("volume_change_global", posed(1)).has_value());
}

TEST_F(BentTube, FramesThatDoNotFitTheSceneAreRefused) {
  Frame frame = posed(1);
  frame.parts["surface"].points.conservativeResize(7, 3);
  EXPECT_THROW(value("volume_change", frame), Error);
  frame.parts.clear();
  EXPECT_THROW(value("volume_change", frame), Error);
}

TEST_F(BentTube, RememberedValuesFollowTheContent) {
  // The same scene object, other geometry: nothing stale may come back.
  const Frame deep = posed(5);
  const double before = value("overlap_excess_raw", deep).value();
  scene.rig.mesh.V *= 0.5;
  for (JointRegion::Hinge& hinge : scene.regions.front().hinges) hinge.radius *= 0.5;
  const Frame half = posed(5);
  // Half the size is an eighth of the volume, up to the columns' error.
  EXPECT_NEAR(value("overlap_excess_raw", half).value() / before, 0.125, 1e-6);
}

}  // namespace
}  // namespace geoprior::skinning
