#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"

namespace geoprior::skinning {

/// How the fields of two bones that share a joint are combined (operators.h has the equations).
enum class BlendKind { union_max, ricci, gradient_controlled, bulge_in_contact, contact };

/// Opening angle of a blend as a function of the angle between the two gradients (operators.h).
enum class OpeningPreset {
  smooth_finger,
  elbow,
  elbow_soft,
  finger,
  bulge,
  flat_max,
  flat_blend,
};

/// What closes a bone's field beyond a joint: nothing, one sample on the axis, or a dome that
/// continues the skin.
enum class CapKind { none, point, dome };

/// Which bone a vertex belongs to.
enum class PartitionRule { highest_weight, closest_bone };

/// Field value as a function of s = distance / r (compact_support.h).
enum class SupportKind { quintic, cubic, logistic };

/// Order of the passes of one solve: that of the paper, or that of the code its authors released.
enum class Schedule { paper, released_code };

/// Operator of one joint, where it differs from the others. What it leaves out is as for them.
struct JointBlend {
  std::string joint;
  std::optional<BlendKind> blend;
  std::optional<OpeningPreset> opening;
};
void describe(OptionVisitor& v, JointBlend& options);

/// Samples from which the field of each bone is fitted (thesis 3.1, N and p_k, n_k of eq. 3.1).
struct SamplingOptions {
  int samples = 80;  ///< N
  double fold = 0;
  double trim_head = 0;
  double trim_tail = 0;
  CapKind caps = CapKind::point;
  double cap_scale = 0.9;
};
void describe(OptionVisitor& v, SamplingOptions& options);

/// How vertices come to their iso-values: all together, as one smooth correction
/// (smooth/projection.h), the same with contact that begins where the pose before left it, or each
/// along its own gradient, as published (projection.h).
enum class ProjectionKind { smooth, tracking, marching };

/// What is corrected (base/base_skin.h).
enum class BaseKind { limbs_and_trunk, dual_quaternion, centers_of_rotation, direct_delta_mush };

/// The smooth correction. Lengths are shares of the local radius: the distance of the skin from its
/// bone.
struct SmoothOptions {
  double spread = 0.6;
  bool volume = true;
  double section = 1;
  double cutoff = 2.2;
  double contact_cutoff = 1.2;
  double anchor = 0.15;  ///< mu
  double contact_anchor = 0.02;
  double contact_gap = 0.06;
  double contact_weight = 3;
  double contact_band = 0.1;
  double contact_reach = 1;
  int evaluations = 2;
  int contact_evaluations = 5;
  double tracking_step_deg = 10;
  int iterations = 6;
};
void describe(OptionVisitor& v, SmoothOptions& options);

/// Every choice that the two published sources of implicit skinning differ in, or leave open.
struct ImplicitOptions {
  BlendKind blend = BlendKind::gradient_controlled;
  OpeningPreset opening = OpeningPreset::elbow_soft;
  double ricci_exponent = 8;
  std::vector<JointBlend> joint_blends;
  bool limb_contact = true;
  double contact_gap = 0.02;

  PartitionRule partition = PartitionRule::closest_bone;
  SamplingOptions sampling;
  SupportKind support = SupportKind::quintic;
  double radius_scale = 1;
  int grid = 32;

  std::optional<BaseKind> base;
  ProjectionKind projection = ProjectionKind::smooth;
  SmoothOptions smooth;

  Schedule schedule = Schedule::paper;
  double step = 0.35;  ///< Delta L of eq. 3.2
  double max_step = 0.25;
  double stop_angle_deg = 55;
  bool bisect_at_stop = true;
  bool stop_on_growth = false;
  bool leave_far_side = true;
  double tolerance = 1e-3;
  int max_iterations = 40;
  bool relaxation = true;
  int diffusion_passes = 3;
  int smoothing_passes = 5;
};
void describe(OptionVisitor& v, ImplicitOptions& options);

}  // namespace geoprior::skinning
