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

/// What the rows of the skinning metric table (metrics.cpp) read: quantities of one frame of one
/// scene, absent where they have no meaning.
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
Measured measured(const Scene& scene, const Frame& frame);

/// Values that several metrics of a frame share, and those of the rest pose.
struct Shared {
  Memo<bool> closed;
  Memo<OverlapStudy> overlap;
  Memo<int> pairs;
  Memo<SectionSummary> sections;
  Memo<DistortionSummary> distortion;
};

/// Overlap above rest (raw) with its noise floor; absent for an open mesh.
std::optional<OverlapStudy> overlap_excess(Shared& shared, const Measured& m);
/// The excess, 0 where it does not exceed the floor.
Value clipped(const std::optional<OverlapStudy>& study);
/// 0 up to the floor, else over the reference's excess or the floor, whichever is larger.
Value overlap_excess_ratio(Shared& shared, const Measured& m, const Measured& reference);

Value pairs_excess(Shared& shared, const Measured& m);
std::optional<SectionSummary> sections_of(Shared& shared, const Measured& m);
std::optional<DistortionSummary> distortion_of(Shared& shared, const Measured& m);
Value volume_change(const Measured& m);
Value volume_change_global(Shared& shared, const Measured& m);
/// Absent unless the frame's pose is the rest pose.
Value rest_identity(const Measured& m);
/// Absent unless the region is a tube made by formula, with one joint.
std::optional<RingRatio> mid_ring(const Measured& m);
VertexDistance reference_distance(const Measured& m, const Measured& reference);
/// Absent for fewer than three frames, unequal steps or no region.
Value second_difference(const Scene& scene, const FrameSequence& frames);

}  // namespace geoprior::skinning
