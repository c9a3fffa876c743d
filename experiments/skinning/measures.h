#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "experiments/skinning/scene.h"
#include "metrics/cross_section.h"
#include "metrics/distance.h"
#include "metrics/distortion.h"
#include "metrics/mid_ring.h"
#include "metrics/overlap_volume.h"
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

/// What groups of metrics and frames share: overlap_excess is the numerator of its ratio to the
/// reference's, the overlap of a reference frame the denominator of every variant that is compared
/// with it, and the rest pose that of all frames. Each takes longer than all other measures.
struct Shared {
  Memo<bool> closed;
  Memo<OverlapStudy> overlap;
  Memo<int> pairs_at_rest;
};

/// Absent without a region.
Value volume_change(const Measured& m);
/// Absent for an open mesh.
Value volume_change_global(Shared& shared, const Measured& m);

/// Overlap above rest (raw) with its noise floor; absent for an open mesh.
std::optional<OverlapStudy> overlap_excess(Shared& shared, const Measured& m);
/// The excess, 0 where it does not exceed the floor.
double clipped(const OverlapStudy& study);
/// 0 up to the floor, else over the reference's excess or the floor, whichever is larger.
Value overlap_excess_ratio(Shared& shared, const Measured& m, const Measured& reference);
/// Intersecting pairs above rest.
double pairs_excess(Shared& shared, const Measured& m);

/// Absent without a region, as the next.
std::optional<SectionSummary> section_summary(const Measured& m);
std::optional<DistortionSummary> region_distortion(const Measured& m);
/// Absent unless the frame's pose is the rest pose.
Value rest_identity(const Measured& m);
/// Absent unless the region is a tube made by formula, with one joint.
std::optional<RingRatio> mid_ring(const Measured& m);
VertexDistance reference_distance(const Measured& m, const Measured& reference);
/// Absent for fewer than three frames, unequal steps or no region.
Value second_difference(const SkinningScene& scene, const FrameSequence& frames);

}  // namespace geoprior::skinning
