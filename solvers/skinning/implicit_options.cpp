#include "solvers/skinning/implicit_options.h"

#include <array>
#include <string_view>

namespace geoprior::skinning {
namespace {

constexpr std::array<std::string_view, 5> kBlendNames{"union", "ricci", "gradient-controlled",
                                                      "bulge-in-contact", "contact"};
constexpr std::array<std::string_view, 7> kOpeningNames{
    "smooth-finger", "elbow", "elbow-soft", "finger", "bulge", "flat-max", "flat-blend"};
constexpr std::array<std::string_view, 3> kCapNames{"none", "point", "dome"};
constexpr std::array<std::string_view, 2> kPartitionNames{"highest-weight", "closest-bone"};
constexpr std::array<std::string_view, 3> kSupportNames{"quintic", "cubic", "logistic"};
constexpr std::array<std::string_view, 3> kProjectionNames{"smooth", "tracking", "marching"};
constexpr std::array<std::string_view, 4> kBaseNames{"limbs-and-trunk", "dual-quaternion",
                                                     "centers-of-rotation", "direct-delta-mush"};
constexpr std::array<std::string_view, 2> kScheduleNames{"paper", "released-code"};

void describe_fields(OptionVisitor& v, ImplicitOptions& o) {
  describe_choice(v, "blend", o.blend, kBlendNames,
                  {.doc = "operator between the fields of the two bones of a joint"});
  describe_choice(v, "opening", o.opening, kOpeningNames,
                  {.doc = "opening angle theta of the blend over the angle between gradients"});
  v.value(
      "ricci_exponent", o.ricci_exponent,
      {.doc = "n of the Ricci operator; a large one is nearly the union", .min = 1, .max = 100});
  describe_list(v, "joint_blends", o.joint_blends,
                {.doc = "joints whose operator differs from the others"});
  v.value("limb_contact", o.limb_contact,
          {.doc = "contact operator between limbs that no joint connects; off: their maximum"});
  v.value("contact_gap", o.contact_gap,
          {.doc = "excess of a vertex' own field over the other limb's in contact (marching)",
           .min = 0,
           .max = 0.1});
  describe_choice(v, "partition", o.partition, kPartitionNames,
                  {.doc = "rule by which a vertex belongs to a bone"});
  describe_group(v, "sampling", o.sampling,
                 {.doc = "samples to which each bone's field is fitted"});
  describe_choice(v, "support", o.support, kSupportNames,
                  {.doc = "field value over the distance d / r"});
  v.value("radius_scale", o.radius_scale,
          {.doc = "support radius r over the largest distance of skin from its bone",
           .min = 0.1,
           .max = 10});
  v.value("grid", o.grid,
          {.doc = "field cache of grid^3 nodes a bone; 0 evaluates exactly (slow reference)",
           .min = 0,
           .max = 256});
}

void describe_solve(OptionVisitor& v, ImplicitOptions& o) {
  describe_choice(v, "base", o.base, kBaseNames,
                  {.doc = "the skin that is corrected: dual quaternions on limbs and centers of "
                          "rotation on the trunk, or one method everywhere; absent: the first, "
                          "dual quaternions for the marching"});
  describe_choice(
      v, "projection", o.projection, kProjectionNames,
      {.doc = "one smooth correction, the same with contact that is tracked from pose to pose, or "
              "every vertex along its own gradient"});
  describe_group(v, "smooth", o.smooth, {.doc = "the smooth correction, tracked or not"});
  describe_choice(v, "schedule", o.schedule, kScheduleNames,
                  {.doc = "order of the passes: the paper's, or the authors' released code's"});
  v.value("step", o.step,
          {.doc = "Delta L of eq. 3.2: share of the Newton step that is taken",
           .min = 1e-3,
           .max = 1.5});
  v.value("max_step", o.max_step,
          {.doc = "longest step of a vertex, in support radii r", .min = 1e-3, .max = 10});
  v.value("stop_angle_deg", o.stop_angle_deg,
          {.doc = "angle between consecutive gradients beyond which a vertex is in contact",
           .unit = "deg",
           .min = 1,
           .max = 180});
  v.value("bisect_at_stop", o.bisect_at_stop,
          {.doc = "moves stopped vertices onto f1 = f2 instead of back to the last step"});
  v.value("stop_on_growth", o.stop_on_growth, {.doc = "stops a vertex whose field error grows"});
  v.value(
      "leave_far_side", o.leave_far_side,
      {.doc = "vertices that the field pushes against their skinned normal walk along it first"});
  v.value("tolerance", o.tolerance,
          {.doc = "|F - iso| at which a vertex is done", .min = 1e-6, .max = 0.1});
  v.value("max_iterations", o.max_iterations,
          {.doc = "projection passes at most; 0: nothing is projected (a null control)",
           .min = 0,
           .max = 1000});
  v.value("relaxation", o.relaxation, {.doc = "tangential relaxation after each projection pass"});
  v.value("diffusion_passes", o.diffusion_passes,
          {.doc = "passes that spread the contact mark beta", .min = 0, .max = 100});
  v.value("smoothing_passes", o.smoothing_passes,
          {.doc = "Laplacian passes at contacts, weighted by beta", .min = 0, .max = 100});
}

/// What holds sections and contacts alike, and how both are solved for.
void describe_correction(OptionVisitor& v, SmoothOptions& o) {
  v.value("spread", o.spread,
          {.doc = "width over which the weights are spread before they move the skin, in local "
                  "radii; 0: as they are",
           .min = 0,
           .max = 5});
  v.value("volume", o.volume,
          {.doc = "swells the skin about each joint by the volume that it has lost there"});
  v.value("section", o.section,
          {.doc = "share of what the fields of limbs ask for that is followed; 0: contact alone",
           .min = 0,
           .max = 1});
  v.value("cutoff", o.cutoff,
          {.doc = "wavelength of a section's correction of which half the amplitude is left, in "
                  "local radii",
           .min = 0.05,
           .max = 10});
  v.value("anchor", o.anchor,
          {.doc = "pull of a section's correction to zero, over the weight of a field's demand",
           .min = 1e-6,
           .max = 1});
  v.value("evaluations", o.evaluations,
          {.doc = "evaluations of the fields for sections; 0: sections stay as the base has them",
           .min = 0,
           .max = 100});
  v.value("tracking_step_deg", o.tracking_step_deg,
          {.doc = "largest turn of a joint between two poses that is tracked in one step",
           .unit = "deg",
           .min = 0.1,
           .max = 180});
  v.value(
      "iterations", o.iterations,
      {.doc = "most steps of the linear solver after its coarse level", .min = 1, .max = 10000});
}

void describe_contact(OptionVisitor& v, SmoothOptions& o) {
  v.value("contact_cutoff", o.contact_cutoff,
          {.doc = "wavelength of the displacement in contact of which half the amplitude is left, "
                  "in local radii",
           .min = 0.05,
           .max = 10});
  v.value("contact_anchor", o.contact_anchor,
          {.doc = "pull of the displacement in contact to zero, over the weight of a demand",
           .min = 1e-6,
           .max = 10});
  v.value("contact_gap", o.contact_gap,
          {.doc = "how much deeper a vertex stays in its own field than in another's, in local "
                  "radii",
           .min = 0,
           .max = 1});
  v.value("contact_weight", o.contact_weight,
          {.doc = "weight of what contact asks over that of a section's demand",
           .min = 1e-3,
           .max = 1000});
  v.value("contact_band", o.contact_band,
          {.doc = "depth about contact over which its force grows from nothing, in local radii",
           .min = 0,
           .max = 1});
  v.value("contact_reach", o.contact_reach,
          {.doc = "distance within which a vertex looks for skin that faces it, in local radii",
           .min = 0,
           .max = 10});
  v.value("contact_evaluations", o.contact_evaluations,
          {.doc = "evaluations of the fields in contact; 0: contact is not resolved (a null "
                  "control)",
           .min = 0,
           .max = 100});
}

}  // namespace

void describe(OptionVisitor& v, JointBlend& o) {
  v.value("joint", o.joint, {.doc = "name of the joint (the child bone's)", .required = true});
  describe_choice(v, "blend", o.blend, kBlendNames,
                  {.doc = "operator of this joint; absent: that of the others"});
  describe_choice(v, "opening", o.opening, kOpeningNames,
                  {.doc = "opening curve of this joint; absent: that of the others"});
}

void describe(OptionVisitor& v, SamplingOptions& o) {
  v.value("samples", o.samples,
          {.doc = "N of eq. 3.1: samples of a bone, caps not counted", .min = 4, .max = 400});
  v.value("fold", o.fold,
          {.doc = "least (p - nearest point of the bone) . n of a sample, in support radii r",
           .min = -1,
           .max = 1});
  v.value("trim_head", o.trim_head,
          {.doc = "share of the bone without samples at its head, if that is a joint",
           .min = -1,
           .max = 0.5});
  v.value("trim_tail", o.trim_tail,
          {.doc = "share of the bone without samples at its tail, if another bone begins there",
           .min = -1,
           .max = 0.5});
  describe_choice(v, "caps", o.caps, kCapNames,
                  {.doc = "what closes a field beyond a joint: one sample on the axis, or a dome"});
  v.value("cap_scale", o.cap_scale,
          {.doc = "distance of a cap from its joint over that of the nearest sample",
           .min = 0.1,
           .max = 5});
}

void describe(OptionVisitor& v, SmoothOptions& o) {
  describe_correction(v, o);
  describe_contact(v, o);
}

void describe(OptionVisitor& v, ImplicitOptions& o) {
  describe_fields(v, o);
  describe_solve(v, o);
}

}  // namespace geoprior::skinning
