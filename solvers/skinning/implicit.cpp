#include "solvers/skinning/implicit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "baselines/skinning/shared/rigid_joints.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/limits.h"
#include "core/parallel.h"
#include "solvers/skinning/base/base_skin.h"
#include "solvers/skinning/base/spread_weights.h"
#include "solvers/skinning/field/composition.h"
#include "solvers/skinning/projection/contact_smoothing.h"
#include "solvers/skinning/projection/pose_path.h"
#include "solvers/skinning/projection/projection.h"
#include "solvers/skinning/projection/relaxation.h"
#include "solvers/skinning/projection/skin_state.h"
#include "solvers/skinning/smooth/limbs.h"
#include "solvers/skinning/smooth/projection.h"

namespace geoprior::skinning {
namespace {

// Passes of the authors' released code.
constexpr int kReleasedFitSteps = 2;
constexpr int kReleasedRelaxations = 7;

constexpr std::size_t kVerticesPerTask = 4096;

/// Where dual quaternions are the base: of any bone longer than thick. Bones of the trunk are not.
constexpr LimbRatios kLimbsOfBase{0.7F, 1.1F};

std::vector<JointOperator> joint_operators(const BonePartition& partition, const Skeleton& skeleton,
                                           const ImplicitOptions& options) {
  std::vector<JointOperator> operators;
  for (const JointBlend& own : options.joint_blends) (void)skeleton.index_of(own.joint);
  for (const FieldBone& bone : partition.bones) {
    const std::string& name = skeleton.joints[bone.joint].name;
    BlendKind blend = options.blend;
    OpeningPreset opening = options.opening;
    for (const JointBlend& own : options.joint_blends) {
      if (own.joint != name) continue;
      blend = own.blend.value_or(blend);
      opening = own.opening.value_or(opening);
    }
    operators.emplace_back(blend, opening, options.ricci_exponent);
  }
  return operators;
}

/// Caches of all bones are made together.
void require_caches(std::size_t bones, int grid) {
  const double nodes = static_cast<double>(bones) * std::pow(grid, 3);
  require_memory(nodes * sizeof(Float4), nodes,
                 "nodes of the fields of " + std::to_string(bones) + " bones", "options.grid");
}

std::vector<BoneField> fit_fields(const RiggedMesh& rig, const BonePartition& partition,
                                  const ImplicitOptions& options, const RunContext& context) {
  const Eigen::MatrixX3d normals = vertex_normals(rig.mesh);
  std::vector<BoneField> fields(partition.bones.size());
  require_caches(fields.size(), options.grid);
  parallel_blocks(fields.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      BoneField& field = fields[b];
      field.bone = partition.bones[b];
      const std::size_t joint = field.bone.joint;
      const std::string& name = rig.skeleton.joints[joint].name;
      field.samples = sample_bone(rig.mesh, normals, partition, static_cast<int>(b),
                                  options.sampling, context.random("samples of " + name));
      field.hrbf = Hrbf(field.samples.points, field.samples.normals, field.bone.radius);
      field.box = field_box(field.bone, rig.mesh.V);
      if (options.grid > 0) {
        field.cache =
            std::make_unique<FieldCache>(field.hrbf, field.box, std::max(2, options.grid));
      }
    }
  });
  return fields;
}

void require_fields(const BonePartition& partition) {
  if (partition.bones.empty()) {
    throw NotApplicable("no joint moves enough vertices for a field", "implicit skinning",
                        "at least " + std::to_string(kMinBoneVertices) + " vertices a joint");
  }
  if (std::ssize(partition.bones) > kMaxFieldBones) {
    throw NotApplicable(std::to_string(partition.bones.size()) + " joints have skin of their own",
                        "implicit skinning", "at most " + std::to_string(kMaxFieldBones));
  }
}

/// Whether skin blends over a part of its limb; as published each vertex marches from where its own
/// weights bring it.
bool spreads(const ImplicitOptions& options) {
  return options.projection != ProjectionKind::marching && options.smooth.spread > 0;
}

/// Tracking loses its way in the tighter folds that narrower weights make of a curled finger: there
/// short limbs spread as others do.
RiggedMesh spread_rig(const RiggedMesh& rig, const BonePartition& partition,
                      const ImplicitOptions& options) {
  const bool tracks = options.projection == ProjectionKind::tracking;
  const auto short_limbs = tracks ? ShortLimbs::as_others : ShortLimbs::less;
  return {rig.mesh, rig.skeleton,
          spread_weights(rig, spread_lengths(rig, partition, short_limbs), options.smooth.spread)};
}

BaseKind base_of(const ImplicitOptions& options) {
  const bool marches = options.projection == ProjectionKind::marching;
  return options.base.value_or(marches ? BaseKind::dual_quaternion : BaseKind::limbs_and_trunk);
}

/// The base, with what it has to know of limbs.
BaseSkin base_skin(const RiggedMesh& rig, const BonePartition& partition, const SkinState& state,
                   BaseKind kind) {
  if (kind != BaseKind::limbs_and_trunk) return {rig, kind, {}};
  const std::vector<float> of_slot = limb_shares(rig, partition, state, kLimbsOfBase);
  Eigen::VectorXd share(rig.mesh.vertex_count());
  for (std::size_t s = 0; s < state.size(); ++s)
    share(state.vertex[s]) = static_cast<double>(of_slot[s]);
  return {rig, kind, share};
}

Float4 row_of(const Eigen::MatrixX3d& V, int v) {
  return Float4{static_cast<float>(V(v, 0)), static_cast<float>(V(v, 1)),
                static_cast<float>(V(v, 2)), 0.0F};
}

}  // namespace

struct ImplicitSkinning::Impl {
  /// @param skin  the rig with the weights that move it
  Impl(const RiggedMesh& rig, const RiggedMesh& skin, BonePartition bones,
       const ImplicitOptions& chosen, const RunContext& context)
      : options(chosen),
        joint_count(rig.skeleton.size()),
        graph(one_rings(rig.mesh.F, rig.mesh.vertex_count())),
        partition(std::move(bones)),
        field(fit_fields(rig, partition, options, context),
              joint_operators(partition, rig.skeleton, options), options.support,
              partition.bone_of_vertex, graph, options.limb_contact),
        projection(field, options),
        state(skin, graph, partition.bone_of_vertex),
        base(base_skin(skin, partition, state, base_of(options))) {
    rotation.resize(3 * static_cast<std::size_t>(joint_count));
    field.set_pose(rest_pose(joint_count));
    projection.record_rest(state);
    if (options.projection != ProjectionKind::marching) {
      smooth_projection.emplace(skin, partition, field, options, state);
      smooth_projection->record_rest(state);
    }
    if (options.projection == ProjectionKind::tracking) {
      smooth_projection->follow();
      path.emplace(rig.skeleton);
    }
    prepare_relaxation(state);
  }

  void follow(const Pose& pose, Eigen::MatrixX3d& posed);
  void start(const Pose& pose, Eigen::MatrixX3d& posed);
  void turn_normals();
  void correct(const Pose& pose);
  void fit(RunContext& context);
  void smooth(int diffusion, int passes);
  void finish(Eigen::MatrixX3d& posed);

  ImplicitOptions options;
  int joint_count;
  VertexGraph graph;
  BonePartition partition;
  FieldComposition field;
  Projection projection;
  SkinState state;
  BaseSkin base;
  std::optional<SmoothProjection> smooth_projection;
  std::optional<PosePath> path;    // of poses that are tracked
  std::vector<Float4> quaternion;  // of the joints
  std::vector<Float4> rotation;    // columns of the joints' rotations
  int iterations = 0;
};

void ImplicitSkinning::Impl::start(const Pose& pose, Eigen::MatrixX3d& posed) {
  base.deform(pose, posed);
  field.set_pose(pose);
  iterations = 0;
  std::fill(state.beta.begin(), state.beta.end(), 0.0F);
  std::fill(state.contact_bone.begin(), state.contact_bone.end(), -1);
  std::fill(state.evaluations.begin(), state.evaluations.end(), 0);
  for (std::size_t s = 0; s < state.size(); ++s) {
    state.start[s] = row_of(posed, state.vertex[s]);
  }
  state.position = state.start;
  turn_normals();
}

void ImplicitSkinning::Impl::follow(const Pose& pose, Eigen::MatrixX3d& posed) {
  require_finite_pose(pose, joint_count, "implicit skinning");
  const double largest_turn = options.smooth.tracking_step_deg * std::numbers::pi / 180;
  const int steps = path->go_to(pose, largest_turn);
  for (int step = 1; step < steps; ++step) {
    start(path->at(step), posed);
    correct(path->at(step));
  }
}

void ImplicitSkinning::Impl::turn_normals() {
  for (std::size_t j = 0; j < field.rotations().size(); ++j) {
    const Eigen::Matrix3f turn = field.rotations()[j].cast<float>();
    for (int k = 0; k < 3; ++k) {
      rotation[3 * j + k] = Float4{turn(0, k), turn(1, k), turn(2, k), 0.0F};
    }
  }
  parallel_blocks(state.size(), kVerticesPerTask, [this](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Float4 n = state.rest_normal[s];
      Float4 sum{};
      for (int i = state.influence_offset[s]; i < state.influence_offset[s + 1]; ++i) {
        const Float4* r = &rotation[3 * static_cast<std::size_t>(state.influence_joint[i])];
        sum += splat(state.influence_weight[i]) *
               (r[0] * splat(n[0]) + r[1] * splat(n[1]) + r[2] * splat(n[2]));
      }
      state.outward[s] = sum;
    }
  });
}

void ImplicitSkinning::Impl::correct(const Pose& pose) {
  quaternion.clear();
  for (const Eigen::Matrix3d& turn : field.rotations()) {
    const Eigen::Vector4f q = Eigen::Quaterniond(turn).coeffs().cast<float>();
    quaternion.push_back(Float4{q(0), q(1), q(2), q(3)});
  }
  iterations = smooth_projection->solve(state, pose, quaternion);
}

void ImplicitSkinning::Impl::fit(RunContext& context) {
  const bool released = options.schedule == Schedule::released_code;
  const int steps = released ? kReleasedFitSteps : 1;
  const int relaxations = !options.relaxation ? 0 : released ? kReleasedRelaxations : 1;
  const RelaxationLaw law = released ? RelaxationLaw::released_code : RelaxationLaw::paper;
  state.activate();
  for (int i = 0; i < options.max_iterations && !state.live_blocks.empty(); ++i) {
    ++iterations;
    {
      const Phase phase(context, "projection");
      for (int k = 0; k < steps; ++k) projection.step(state);
    }
    const Phase phase(context, "relaxation");
    for (int k = 0; k < relaxations; ++k) relax(state, law);
  }
}

void ImplicitSkinning::Impl::smooth(int diffusion, int passes) {
  const bool any_contact =
      std::any_of(state.beta.begin(), state.beta.end(), [](float beta) { return beta > 0; });
  if (!any_contact) return;
  diffuse_contact(state, diffusion);
  smooth_contact(state, passes);
}

void ImplicitSkinning::Impl::finish(Eigen::MatrixX3d& posed) {
  for (std::size_t s = 0; s < state.size(); ++s) {
    const Float4 moved = state.position[s] - state.start[s];
    for (int k = 0; k < 3; ++k) posed(state.vertex[s], k) += static_cast<double>(moved[k]);
  }
}

ImplicitSkinning::ImplicitSkinning(const RiggedMesh& rig, const ImplicitOptions& options,
                                   RunContext& context) {
  require_closed_manifold(rig.mesh, "implicit skinning", "mesh");
  validate(rig.skeleton);
  validate(rig.weights, rig.mesh.vertex_count(), rig.skeleton.size());
  BonePartition partition = partition_bones(rig, options.partition, options.radius_scale);
  require_fields(partition);
  if (!spreads(options)) {
    impl_ = std::make_unique<Impl>(rig, rig, std::move(partition), options, context);
    return;
  }
  const RiggedMesh skin = spread_rig(rig, partition, options);
  impl_ = std::make_unique<Impl>(rig, skin, std::move(partition), options, context);
}

ImplicitSkinning::~ImplicitSkinning() = default;
ImplicitSkinning::ImplicitSkinning(ImplicitSkinning&&) noexcept = default;
ImplicitSkinning& ImplicitSkinning::operator=(ImplicitSkinning&&) noexcept = default;

void ImplicitSkinning::deform(const Pose& pose, Eigen::MatrixX3d& posed, RunContext& context) {
  Impl& impl = *impl_;
  if (impl.path) {
    const Phase phase(context, "tracking");
    impl.follow(pose, posed);
  }
  {
    const Phase phase(context, "start");
    impl.start(pose, posed);
  }
  if (impl.smooth_projection) {
    const Phase phase(context, "projection");
    impl.correct(pose);
    impl.finish(posed);
    return;
  }
  impl.fit(context);
  const bool released = impl.options.schedule == Schedule::released_code;
  {
    const Phase phase(context, "smoothing");
    impl.smooth(impl.options.diffusion_passes, impl.options.smoothing_passes);
  }
  if (released) {
    impl.fit(context);
    const Phase phase(context, "smoothing");
    impl.smooth(impl.options.diffusion_passes, impl.options.smoothing_passes);
  }
  impl.finish(posed);
}

bool ImplicitSkinning::path_dependent() const { return impl_->path.has_value(); }

void ImplicitSkinning::restart() {
  if (!impl_->path) return;
  impl_->path->restart();
  impl_->smooth_projection->forget();
}

std::map<std::string, double> ImplicitSkinning::diagnostics() const {
  const Impl& impl = *impl_;
  const SkinState& state = impl.state;
  double evaluations = 0, squares = 0, largest = 0, gap = 0;
  std::size_t free = 0, stopped = 0, unfinished = 0;
  for (const std::int64_t e : state.evaluations) evaluations += static_cast<double>(e);
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (state.owner[s] < 0) continue;
    const FieldAt at = impl.projection.field_of(state, s, state.position[s]);
    if (state.stop[s] == VertexStop::contact) {
      ++stopped;
      const int other = state.contact_bone[s], last = state.last_bone[s];
      if (other >= 0 && last >= 0 && other != last) {
        const double difference = impl.field.difference(state.position[s], last, other);
        gap = std::max(gap, std::abs(difference));
      }
    }
    if (state.stop[s] == VertexStop::active) ++unfinished;
    if (state.beta[s] > 0 || state.stop[s] == VertexStop::no_field) continue;
    const double error = at.value - impl.projection.target_of(state, s, at).value;
    ++free;
    squares += error * error;
    largest = std::max(largest, std::abs(error));
  }
  const auto n = static_cast<double>(state.size());
  return {{"evaluations_per_vertex", evaluations / n},
          {"iterations", impl.iterations},
          {"field_error_rms", free > 0 ? std::sqrt(squares / static_cast<double>(free)) : 0},
          {"field_error_max", largest},
          {"stopped_fraction", static_cast<double>(stopped) / n},
          {"unfinished_fraction", static_cast<double>(unfinished) / n},
          {"contact_gap_max", gap}};
}

Eigen::VectorXd ImplicitSkinning::field_error(const Eigen::MatrixX3d& positions) const {
  const SkinState& state = impl_->state;
  Eigen::VectorXd error = Eigen::VectorXd::Zero(positions.rows());
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (state.owner[s] < 0) continue;
    const int v = state.vertex[s];
    const FieldAt at = impl_->projection.field_of(state, s, row_of(positions, v));
    error(v) = static_cast<double>(at.value) - static_cast<double>(state.iso[s]);
  }
  return error;
}

ImplicitSkinning::Samples ImplicitSkinning::samples() const {
  Samples all;
  Eigen::Index rows = 0;
  for (const BoneField& f : impl_->field.fields()) rows += f.samples.points.rows();
  all.points.resize(rows, 3);
  all.normals.resize(rows, 3);
  Eigen::Index row = 0;
  for (const BoneField& f : impl_->field.fields()) {
    const Eigen::Index n = f.samples.points.rows();
    all.points.middleRows(row, n) = f.samples.points;
    all.normals.middleRows(row, n) = f.samples.normals;
    for (Eigen::Index i = 0; i < n; ++i) {
      all.joint.push_back(f.bone.joint);
      all.is_cap.push_back(i >= n - f.samples.cap_count);
    }
    row += n;
  }
  return all;
}

std::size_t ImplicitSkinning::cache_bytes() const {
  std::size_t bytes = 0;
  for (const BoneField& f : impl_->field.fields()) bytes += f.cache ? f.cache->bytes() : 0;
  return bytes;
}

}  // namespace geoprior::skinning
