#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/procedural.h"
#include "experiments/skinning/scene/scene.h"
#include "experiments/skinning/topic.h"
#include "metrics/volume/volume.h"
#include "tests/testbed/runner/metric_table.h"

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
  for (const char* name : {"volume_change",
                           "volume_change_global",
                           "overlap_excess",
                           "overlap_excess_raw",
                           "intersecting_pairs",
                           "rest_identity",
                           "volume_change_union",
                           "volume_change_union_body",
                           "overlap_excess_body",
                           "overlap_excess_largest",
                           "overlap_excess_sum",
                           "overlap_excess_outside",
                           "overlap_cut_area",
                           "intersecting_pairs_body",
                           "intersecting_pairs_at_rest",
                           "intersecting_pairs_body_at_rest",
                           "roughness_max",
                           "roughness_max_outer",
                           "lumps_max",
                           "lumps_rms_outer",
                           "harm"}) {
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

TEST_F(BentTube, OverlapOfTheWholeBodyIsThatOfItsOnlyRegion) {
  // Bent by 120 degrees the limbs meet up to r / tan 30 degrees = 1.7 r from the joint.
  const Frame deep = posed(4);
  const double region = value("overlap_excess_raw", deep).value();
  const double body = value("overlap_excess_raw_body", deep).value();
  EXPECT_EQ(value("overlap_cut_area", deep).value(), 0);
  EXPECT_EQ(value("overlap_excess_outside", deep).value(), 0);
  EXPECT_NEAR(
      body, region,
      value("overlap_noise_floor", deep).value() + value("overlap_noise_floor_body", deep).value());
  EXPECT_EQ(value("overlap_excess_largest", deep), value("overlap_excess", deep));
  EXPECT_EQ(value("intersecting_pairs_body", deep), value("intersecting_pairs", deep));
  // What is inside twice counts once.
  const double rest = signed_volume(scene.rig.mesh.V, scene.rig.mesh.F);
  EXPECT_NEAR(value("volume_change_union_body", deep).value(),
              value("volume_change_global", deep).value() - body / rest, 1e-9);
  EXPECT_LT(value("volume_change_union", deep).value(), value("volume_change", deep).value());
}

TEST_F(BentTube, VolumeIsOfTheBodyOverTheRegion) {
  // Skin that slides along the tube changes nothing, though the border of the region goes with it.
  const JointRegion& region = scene.regions.front();
  const TriMesh& mesh = scene.rig.mesh;
  const double rest = region_volume(mesh.V, mesh.F, region);
  Frame moved = posed(0);
  Eigen::MatrixX3d& points = moved.parts["surface"].points;
  const double half = CylinderOptions().half_length;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double t = std::clamp(points(v, 0) / half, -1.0, 1.0);
    points(v, 0) += 0.1 * half * (1 - t * t) * (1 + t);
  }
  EXPECT_NEAR(value("volume_change", moved).value(), 0, 1e-12);
  EXPECT_GT(region_volume(points, mesh.F, region) / rest, 1.01);
  // A tube that is wider by a tenth gains 0.21 of all of it.
  points.rightCols<2>() *= 1.1;
  const double gain = 0.21 * signed_volume(mesh.V, mesh.F);
  EXPECT_NEAR(value("volume_change", moved).value(), gain / rest, 1e-9);
  EXPECT_NEAR(value("volume_change_union", moved).value(), gain / rest, 1e-6);
  // Of an open mesh the region's own is left.
  scene.rig.mesh.F.conservativeResize(mesh.F.rows() - 1, 3);
  EXPECT_NE(value("volume_change", moved), gain / rest);
  EXPECT_TRUE(value("volume_change", moved).has_value());
  EXPECT_FALSE(value("volume_change_union", moved).has_value());
}

TEST_F(BentTube, OverlapThatARegionsBoxCutsIsSaid) {
  // By 150 degrees they meet up to r / tan 15 degrees = 3.7 r: beyond the box of 3 r.
  const Frame deep = posed(5);
  const double region = value("overlap_excess_raw", deep).value();
  const double body = value("overlap_excess_raw_body", deep).value();
  EXPECT_GT(value("overlap_cut_area", deep).value(), 1e-3);
  EXPECT_GT(body, 1.02 * region);
  EXPECT_DOUBLE_EQ(value("overlap_excess_outside", deep).value(), body - region);
}

TEST_F(BentTube, EveryRegionOverlaps) {
  const double first = value("overlap_excess", posed(5)).value();
  scene.regions.push_back(scene.regions.front());
  EXPECT_DOUBLE_EQ(value("overlap_excess_sum", posed(5)).value(), 2 * first);
  EXPECT_DOUBLE_EQ(value("overlap_excess_largest", posed(5)).value(), first);
}

TEST_F(BentTube, RoughnessSeesAVertexPulledOut) {
  const Frame smooth = posed(2);
  Frame bumped = smooth;
  Part& surface = bumped.parts["surface"];
  // On the outside, z > 0, between the bones: the bend is about +y.
  int outermost = 0;
  for (int v = 0; v < scene.rig.mesh.vertex_count(); ++v) {
    const auto x = scene.rig.mesh.V.row(v);
    const auto best = scene.rig.mesh.V.row(outermost);
    if (std::abs(x.x()) < 0.06 && x.z() > best.z() - 1e-12) outermost = v;
  }
  surface.points.row(outermost) +=
      0.01 * vertex_normals({surface.points, surface.triangles}).row(outermost);
  EXPECT_GT(value("lumps_max", bumped).value(), 0.008);
  EXPECT_EQ(value("lumps_max_outer", bumped), value("lumps_max", bumped));
  EXPECT_LT(value("lumps_max_outer", smooth).value(), 0.002);
  EXPECT_GT(value("roughness_max_outer", bumped).value(),
            5 * value("roughness_max_outer", smooth).value());
}

TEST_F(BentTube, HarmIsWhatDualQuaternionsDidNotAskFor) {
  // Linear blending differs where the limbs blend only, and dual quaternions change the section
  // there; the ends of the tube are rigid.
  Frame frame = posed(2);
  EXPECT_LT(value("harm", frame).value(), 0.05);
  EXPECT_GT(value("harm_area", frame).value(), 0.3);
  for (Eigen::Index v = 0; v < frame.parts["surface"].points.rows(); ++v) {
    if (scene.rig.mesh.V(v, 0) < -0.3) frame.parts["surface"].points(v, 1) += 0.02;
  }
  // 0.02 m over the radius of 0.1 m; the ends' own rings are smaller.
  EXPECT_GE(value("harm", frame).value(), 0.2 - 1e-6);
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

TEST_F(BentTube, OverlapOfTheBodyOverThatOfTheReference) {
  // The box of the region cuts the overlap at 150 degrees, so that the two ratios differ.
  const Frame deep = posed(5);
  const Frame half = posed(4);
  EXPECT_DOUBLE_EQ(value("overlap_excess_ratio_body", deep, &deep).value(), 1);
  EXPECT_NEAR(value("overlap_excess_ratio_body", deep, &half).value(),
              value("overlap_excess_raw_body", deep).value() /
                  value("overlap_excess_raw_body", half).value(),
              1e-9);
  EXPECT_GT(value("overlap_excess_ratio_body", deep, &half).value(),
            1.02 * value("overlap_excess_ratio", deep, &half).value());
  EXPECT_FALSE(value("overlap_excess_ratio_body", deep).has_value());
}

TEST_F(BentTube, PairsOfThePoseAndAtRestAreTwoNumbers) {
  // A sliver through the tube's wall at rest, far from the region; in the pose it is taken out. The
  // number of the pose does not go below zero, and that at rest stays.
  Eigen::MatrixX3d& V = scene.rig.mesh.V;
  int pulled = 0;
  V.col(0).minCoeff(&pulled);
  const Eigen::RowVector3d apart = V.row(pulled);
  Frame clear = posed(0);
  V.row(pulled) = Eigen::RowVector3d(apart.x() + 0.3, 0.03, 0.4);  // through the wall at r = 0.1
  const double at_rest = value("intersecting_pairs_body", posed(0)).value();
  EXPECT_GT(at_rest, 0);
  EXPECT_EQ(value("intersecting_pairs_body", clear).value(), 0);
  EXPECT_EQ(value("intersecting_pairs_body_at_rest", clear).value(), at_rest);
  EXPECT_EQ(value("intersecting_pairs_body_at_rest", posed(5)).value(), at_rest);
  EXPECT_GT(value("intersecting_pairs_body", posed(5)).value(), at_rest);
  EXPECT_EQ(value("intersecting_pairs_at_rest", clear).value(), 0);  // none of them in the region
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
  const auto measure = [&](const char* name) {
    return table.of_sequence(name, scene, frames).value();
  };
  EXPECT_NEAR(measure("velocity_change_max"), pops(frames).value() / (30 * 30), 1e-12);
  EXPECT_GT(measure("pop_max"), 0.1);
  frames.erase(frames.begin() + 1);
  EXPECT_FALSE(pops(frames).has_value());  // unequal steps
  EXPECT_GT(measure("velocity_change_max"), 0);
  scene.parameter_unit_label = "s";
  EXPECT_FALSE(table.of_sequence("pop_max", scene, frames).has_value());
}

TEST_F(BentTube, WithoutARegionTheWholeBodyIsMeasured) {
  scene.regions.clear();
  const Frame deep = posed(5);
  EXPECT_GT(value("overlap_excess", deep).value(), 0);
  EXPECT_GT(value("intersecting_pairs", deep).value(), 10);
  EXPECT_EQ(value("overlap_excess", deep), value("overlap_excess_body", deep));
  EXPECT_GT(value("roughness_p95", deep).value(), 0);
  for (const char* name :
       {"volume_change_union", "overlap_excess_sum", "overlap_cut_area", "roughness_p95_outer",
        "lumps_max_outer", "volume_change", "section_shrink", "outer_bulge", "area_ratio_p05",
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
