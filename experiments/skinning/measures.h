#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/frame.h"
#include "experiments/skinning/scene/scene.h"
#include "metrics/contact/harm.h"
#include "metrics/isometry/distortion.h"
#include "metrics/shape/cross_section.h"
#include "metrics/shape/distance.h"
#include "metrics/shape/mid_ring.h"
#include "metrics/shape/roughness.h"
#include "metrics/shape/smoothness.h"
#include "metrics/volume/overlap_volume.h"
#include "testbed/memo.h"

namespace geoprior::skinning {

/// What the groups of the skinning metric table (metrics.cpp) measure: quantities of one frame of
/// one scene, absent where they have no meaning.
using Value = std::optional<double>;

/// One frame of one scene, as every metric sees it.
struct Measured {
  const SkinningScene& scene;
  const Eigen::MatrixX3d& posed;
  const Pose& pose;

  [[nodiscard]] const TriMesh& mesh() const { return scene.rig.mesh; }
  /// The region that metrics report; null for a motion without joints of its own (a clip).
  [[nodiscard]] const JointRegion* region() const {
    return scene.regions.empty() ? nullptr : &scene.regions.front();
  }
};

/// @throws Error  when the frame has no part "surface" with as many vertices as the scene's mesh
Measured measured(const SkinningScene& scene, const Frame& frame);

using TrianglePairList = std::vector<std::array<int, 2>>;

/// Dual quaternions' skin in a pose, and where nothing asks for another.
struct PlainPose {
  Eigen::MatrixX3d posed;
  std::vector<int> unasked;  ///< vertices
};

/// What groups of metrics, frames and variants share: the rest pose is that of all frames, what is
/// made of a scene's rig that of all its frames, dual quaternions' pose that of every variant, the
/// overlap of a reference frame the denominator of all that are compared with it. Each takes longer
/// than all other measures.
struct Shared {
  Memo<bool> closed;
  Memo<OverlapStudy> overlap;
  Memo<double> union_volume;
  Memo<std::shared_ptr<const TrianglePairList>, 8> pairs;
  Memo<std::shared_ptr<const Roughness>, 4> roughness;
  Memo<std::shared_ptr<const BoneRings>, 4> rings;
  Memo<std::shared_ptr<const PlainPose>, 64> plain;
};

/// What the whole closed surface gains, over the volume that the joints' regions have at rest: the
/// region alone, closed by fans, would count skin that slides over its border. That is what an open
/// mesh leaves, of its first region. Absent without a region.
Value volume_change(Shared& shared, const Measured& m);
/// Absent for an open mesh.
Value volume_change_global(Shared& shared, const Measured& m);

/// Change of the volume of what is inside, however often, over that of the regions and over that of
/// the whole body. Absent without a region (the first), or for an open mesh.
Value volume_change_union(Shared& shared, const Measured& m);
Value volume_change_union_body(Shared& shared, const Measured& m);

/// What overlaps in a pose beyond what did at rest, and both: of parts that lie in one another at
/// rest (clothes, eyes) the difference alone would hide what a pose takes apart.
struct OverlapPair {
  OverlapStudy above;  ///< with the noise floors of both; below zero where rest overlaps more
  double posed = 0;    ///< m^3
  double at_rest = 0;  ///< m^3
};
/// About the region's joints (of the whole body without a region); absent for an open mesh.
std::optional<OverlapPair> overlap_excess(Shared& shared, const Measured& m);
/// The same of the whole body.
std::optional<OverlapPair> overlap_excess_body(Shared& shared, const Measured& m);
/// Each 0 up to the floor, else over the reference's excess or the floor, whichever is larger.
struct OverlapRatios {
  double box = 0;   ///< about the region's joints; of the whole body without a region
  double body = 0;  ///< of the whole body
};
/// Absent for an open mesh.
std::optional<OverlapRatios> overlap_excess_ratios(Shared& shared, const Measured& m,
                                                   const Measured& reference);

/// Overlaps of all regions of the motion.
struct RegionOverlaps {
  double largest = 0;   ///< excess of the region that overlaps most (m^3)
  double sum = 0;       ///< over the regions; where their boxes overlap it counts twice (m^3)
  double outside = 0;   ///< what the whole body has more than that; 0 up to the noise floors (m^3)
  double cut_area = 0;  ///< of the faces of a region's box that overlap goes through, largest (m^2)
};
/// Absent without a region or for an open mesh.
std::optional<RegionOverlaps> overlap_of_regions(Shared& shared, const Measured& m);

/// Intersecting pairs of triangles, posed and at rest.
struct Pairs {
  int region = 0;  ///< one of the two in the first region; anywhere without one
  int region_at_rest = 0;
  int body = 0;
  int body_at_rest = 0;
};
Pairs pairs(Shared& shared, const Measured& m);

/// Folds and lumps over the regions of the motion (the whole body without one) and over their outer
/// halves (absent where no hinge bends about a single axis).
struct RoughnessMeasures {
  RoughnessSummary all;
  std::optional<RoughnessSummary> outer;
};
std::optional<RoughnessMeasures> roughness(Shared& shared, const Measured& m);

/// Against dual quaternions in the same pose; absent where they ask for something everywhere.
std::optional<Harm> harm_of(Shared& shared, const Measured& m);

/// Absent without a region, as the next.
std::optional<SectionSummary> section_summary(const Measured& m);
std::optional<DistortionSummary> region_distortion(const Measured& m);
/// Absent unless the frame's pose is the rest pose.
Value rest_identity(const Measured& m);
/// Absent unless the region is a tube made by formula, with one joint.
std::optional<RingRatio> mid_ring(const Measured& m);
VertexDistance reference_distance(const Measured& m, const Measured& reference);
/// Pops over a sweep, in the frame of each vertex' joint.
struct Pops {
  Value second_difference;  ///< of the first region; absent for unequal steps or no region
  /// Of the whole body; absent for fewer than four frames, or a parameter that is no angle.
  std::optional<MotionSmoothness> motion;
  /// Absent when no pose comes twice.
  std::optional<double> pose_return;
};
Pops pops(Shared& shared, const SkinningScene& scene, const FrameSequence& frames);

}  // namespace geoprior::skinning
