#include "baselines/skinning/centers_of_rotation/centers_of_rotation.h"
#include "baselines/skinning/delta_mush.h"
#include "baselines/skinning/direct_delta_mush/direct_delta_mush.h"
#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "baselines/skinning/linear_blend/linear_blend.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "experiments/skinning/scene/scene.h"
#include "experiments/skinning/topic.h"
#include "solvers/skinning/implicit.h"
#include "solvers/skinning/implicit_options.h"

namespace geoprior::skinning {
namespace {

/// Linear and dual quaternion blending have nothing to choose.
struct NoOptions {};
void describe(OptionVisitor& /*v*/, NoOptions& /*options*/) {}

Part surface_part(const SkinningScene& scene, const Eigen::MatrixX3d& posed) {
  Part part;
  part.points = posed;
  part.triangles = scene.rig.mesh.F;
  NamedArray displacement;
  displacement.name = "displacement";
  displacement.unit = "m";
  displacement.values = (posed - scene.rig.mesh.V).rowwise().norm();
  part.arrays.push_back(std::move(displacement));
  return part;
}

/// The skin with the vertices and triangles of the input file, split at seams and without caps:
/// what goes back to the program it came from.
Part input_part(const SkinningScene& scene, const Eigen::MatrixX3d& posed) {
  Part part;
  part.points.resize(scene.input_mesh.V.rows(), 3);
  for (Eigen::Index v = 0; v < part.points.rows(); ++v) {
    part.points.row(v) = posed.row(scene.welded_of_input[v]);
  }
  part.triangles = scene.input_mesh.F;
  return part;
}

/// The bones in their posed places.
Part bones_part(const SkinningScene& scene, const Pose& pose) {
  Part part;
  part.kind = Part::Kind::lines;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t j = 0; j < pose.size(); ++j) {
    const Joint& joint = scene.rig.skeleton.joints[j];
    if (!joint.tail) continue;
    const int first = static_cast<int>(points.size());
    points.emplace_back(pose[j] * joint.head);
    points.emplace_back(pose[j] * *joint.tail);
    part.lines.push_back({first, first + 1});
  }
  part.points.resize(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) part.points.row(i) = points[i].transpose();
  return part;
}

/// Fields need an inside: names the character's file where the method knows only a mesh.
void require_solid(const SkinningScene& scene, const std::string& who) {
  const std::string where =
      scene.input_files.empty() ? "mesh" : scene.input_files.front().string() + ", welded vertices";
  try {
    require_closed_manifold(scene.rig.mesh, who, where);
  } catch (const Error& error) {
    throw NotApplicable(error.what());
  }
}

/// Wraps a class with `deform(pose, posed)` or `deform(pose, posed, context)`. The scene must
/// outlive the method, as the runner sees to.
template <class Deformer>
class SkinningMethod final : public PoseMethod {
 public:
  template <class... Arguments>
  explicit SkinningMethod(const SkinningScene& scene, Arguments&&... arguments)
      : scene_(scene), deformer_(scene.rig, std::forward<Arguments>(arguments)...) {}

  void solve(double parameter, RunContext& context) override {
    parameter_ = parameter;
    const Pose& pose = scene_.pose_at(parameter);
    if constexpr (requires { deformer_.deform(pose, posed_, context); }) {
      deformer_.deform(pose, posed_, context);
    } else {
      deformer_.deform(pose, posed_);
    }
  }

  [[nodiscard]] bool path_dependent() const override {
    if constexpr (requires { deformer_.path_dependent(); }) return deformer_.path_dependent();
    return false;
  }

  void restart() override {
    if constexpr (requires { deformer_.restart(); }) deformer_.restart();
  }

  [[nodiscard]] Frame frame() const override {
    Frame frame;
    frame.parameter = parameter_;
    frame.parts["surface"] = surface_part(scene_, posed_);
    if (scene_.input_mesh.vertex_count() != scene_.rig.mesh.vertex_count() ||
        scene_.cap_triangles > 0) {
      frame.parts["input"] = input_part(scene_, posed_);
    }
    frame.parts["bones"] = bones_part(scene_, scene_.pose_at(parameter_));
    if constexpr (requires { deformer_.diagnostics(); }) {
      frame.diagnostics = deformer_.diagnostics();
    }
    return frame;
  }

 private:
  const SkinningScene& scene_;
  Deformer deformer_;
  Eigen::MatrixX3d posed_;
  double parameter_ = 0;
};

}  // namespace

std::vector<MethodEntry> methods() {
  using S = SkinningScene;
  return {
      method_entry<S, NoOptions>("linear-blend", true, "weighted mean of the bones' transforms",
                                 "Magnenat-Thalmann et al. 1988",
                                 [](const S& scene, const NoOptions&, RunContext&) {
                                   return std::make_unique<SkinningMethod<LinearBlend>>(scene);
                                 }),
      method_entry<S, NoOptions>(
          "dual-quaternion", true, "normalised weighted mean of unit dual quaternions",
          "Kavan et al. 2007",
          [](const S& scene, const NoOptions&, RunContext&) {
            return std::make_unique<SkinningMethod<DualQuaternionBlend>>(scene);
          }),
      method_entry<S, CentersOfRotationOptions>(
          "centers-of-rotation", true,
          "blended rotation about the place of the skin with similar weights",
          "Le and Hodgins 2016",
          [](const S& scene, const CentersOfRotationOptions& options, RunContext&) {
            return std::make_unique<SkinningMethod<CentersOfRotation>>(scene, options);
          }),
      method_entry<S, DeltaMushOptions>(
          "delta-mush", true, "smoothed linear blend with the rest pose's detail put back",
          "Mancewicz et al. 2014",
          [](const S& scene, const DeltaMushOptions& options, RunContext&) {
            return std::make_unique<SkinningMethod<DeltaMush>>(scene, options);
          }),
      method_entry<S, DirectDeltaMushOptions>(
          "direct-delta-mush", true,
          "rigid motion that fits the smoothed skin around each vertex, from precomputed matrices",
          "Le and Lewis 2019",
          [](const S& scene, const DirectDeltaMushOptions& options, RunContext&) {
            return std::make_unique<SkinningMethod<DirectDeltaMush>>(scene, options);
          }),
      method_entry<S, ImplicitOptions>(
          "implicit", false,
          "blended joints, then contact, sections and volume from fields of the bones",
          "thesis 3.1; Vaillant et al. 2013",
          [](const S& scene, const ImplicitOptions& options, RunContext& context) {
            require_solid(scene, "implicit skinning");
            return std::make_unique<SkinningMethod<ImplicitSkinning>>(scene, options, context);
          }),
  };
}

std::vector<DiagnosticEntry> diagnostics() {
  // Counts are exact on one machine; another compiler's round-off moves some of them.
  constexpr Tolerance kWork{0.1, 0.05};
  DiagnosticTable table;
  table.unmeasured(
      "work of the method, which leaves no trace in its vertices",
      {{"evaluations_per_vertex", "1", "bone fields sampled, over the vertices", true, kWork},
       {"iterations", "1", "steps of the projection", true, kWork},
       {"stopped_fraction", "1", "share of the vertices that stopped in contact"},
       {"unfinished_fraction", "1", "share of the vertices that ran out of iterations"}});
  table.unmeasured(
      "of fields that are the method's own: others have none",
      {{"field_error_rms", "1",
        "root mean square of |field - target| over the vertices that neither stopped in contact "
        "nor were smoothed"},
       {"field_error_max", "1", "largest such |field - target|"},
       {"contact_gap_max", "1",
        "largest difference of two bones' fields at a vertex stopped in contact, after "
        "smoothing"}});
  return table.rows();
}

}  // namespace geoprior::skinning
