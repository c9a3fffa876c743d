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
  int samples = 80;      ///< N per bone, caps not counted
  double fold = 0;       ///< reject samples with (p - nearest point of the bone) . n below fold r
  double trim_head = 0;  ///< drop samples within this fraction of the bone from its head
  double trim_tail = 0;  ///< and from its tail, where another bone begins
  CapKind caps = CapKind::point;  ///< what closes the field beyond joints (caps.h)
  double cap_scale =
      0.9;  ///< distance of the cap from the joint on the axis, over that of the nearest sample
};
void describe(OptionVisitor& v, SamplingOptions& options);

/// How vertices come to their iso-values: all together, as one smooth correction
/// (smooth/projection.h), the same with contact that begins where the pose before left it, or each
/// along its own gradient, as published (projection.h).
enum class ProjectionKind { smooth, tracking, marching };

/// The smooth correction. Lengths are shares of the local radius: the distance of the skin from its
/// bone.
struct SmoothOptions {
  double section = 0.5;  ///< share of what fields ask for that is followed
  double cutoff = 2.2;   ///< wavelength whose amplitude is halved
  double contact_cutoff = 1.2;
  double anchor = 0.15;  ///< mu, over the weight of what fields ask
  double contact_anchor = 0.02;
  double contact_gap = 0.06;  ///< by how much a vertex is deeper in its own field than in another
  double contact_weight = 3;  ///< of what contact asks, over the weight of what sections ask
  double contact_band = 0.1;  ///< before contact, within which skin that was moved is held
  double contact_reach = 1;   ///< within which skin that faces a vertex is looked for
  double dead_zone = 0.01;    ///< what asks for less is not followed
  double largest = 0.5;       ///< correction that a field may ask for
  double trunk_ratio = 1.0;   ///< length over thickness up to which a bone's field is no limb's
  double limb_ratio = 1.4;    ///< and from which it is
  double agree_low = 0.3;     ///< cosine of gradient and skinned normal: below it nothing is known
  double agree_high = 0.8;
  double facing_low = -0.5;  ///< cosine at which a contact begins to hold
  double facing_high = 0;
  double crowd = 0.5;  ///< of a field below contact: within it nothing is asked of the section
  int preparation_passes = 5;
  int evaluations = 2;  ///< of the fields
  int contact_evaluations = 5;
  double tracking_step_deg = 10;  ///< largest turn of a joint between two poses that are followed
  int iterations = 6;             ///< of the linear solver after its coarse level
};
void describe(OptionVisitor& v, SmoothOptions& options);

/// Every choice that the two published sources of implicit skinning differ in, or leave open.
struct ImplicitOptions {
  BlendKind blend = BlendKind::gradient_controlled;
  OpeningPreset opening = OpeningPreset::elbow_soft;
  double ricci_exponent = 8;
  std::vector<JointBlend> joint_blends;
  bool limb_contact = true;  ///< contact operator between limbs that no joint connects

  double contact_gap =
      0.02;  ///< by how much a vertex' own field exceeds the other limb's in contact

  PartitionRule partition = PartitionRule::closest_bone;
  SamplingOptions sampling;
  SupportKind support = SupportKind::quintic;
  double radius_scale = 1;  ///< support radius r over the largest distance of skin from bone
  int grid = 32;            ///< nodes of the field cache: grid^3 a bone; 0 evaluates exactly

  ProjectionKind projection = ProjectionKind::marching;
  SmoothOptions smooth;

  Schedule schedule = Schedule::paper;
  double step = 0.35;           ///< Delta L of eq. 3.2
  double max_step = 0.25;       ///< longest step, in r
  double stop_angle_deg = 55;   ///< between consecutive gradients: contact
  bool bisect_at_stop = true;   ///< move stopped vertices onto f1 = f2
  bool stop_on_growth = false;  ///< stop where the error grows
  bool leave_far_side = true;   ///< vertices that start beyond a medial axis first walk back
  double tolerance = 1e-3;      ///< |F - iso| at which a vertex is done
  int max_iterations = 40;

  bool relaxation = true;
  int diffusion_passes = 3;  ///< spreading of the contact mark beta
  int smoothing_passes = 5;  ///< Laplacian passes weighted by beta
};
void describe(OptionVisitor& v, ImplicitOptions& options);

}  // namespace geoprior::skinning
