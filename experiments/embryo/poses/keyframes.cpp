#include "baselines/embryo/keyframes/keyframes.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "experiments/embryo/frames/day_frame.h"
#include "experiments/embryo/poses/methods.h"

namespace geoprior::embryo {
namespace {

/// The states of the healthy body at the middles of the stages: all that a key-framed model is made
/// of.
std::vector<DayState> healthy_middles(const EmbryoScene& scene) {
  const Development development(scene.ontology, scene.healthy_effects, {});
  std::vector<DayState> middles;
  for (const Stage& stage : scene.ontology.stages)
    middles.push_back(wanted(scene, development.at(stage.middle())));
  return middles;
}

Shape between(const Shape& a, const Shape& b, double u) {
  Shape out = a;
  out.center += u * (b.center - a.center);
  out.radii += u * (b.radii - a.radii);
  out.egg += u * (b.egg - a.egg);
  out.axes = Eigen::Quaterniond(a.axes).slerp(u, Eigen::Quaterniond(b.axes)).toRotationMatrix();
  out.radius += u * (b.radius - a.radius);
  out.end_radius += u * (b.end_radius - a.end_radius);
  out.branchings += u * (b.branchings - a.branchings);
  for (std::size_t i = 0; i < out.points.size() && i < b.points.size(); ++i)
    out.points[i] += u * (b.points[i] - a.points[i]);
  return out;
}

/// Key-framed meshes, and the parameters of their shapes on straight lines between the same days.
class KeyframesMethod final : public PoseMethod {
 public:
  explicit KeyframesMethod(const EmbryoScene& scene)
      : scene_(scene),
        middles_(healthy_middles(scene)),
        keyframes_(middles_, scene.ontology.stages),
        hidden_(scene.named_structures()) {}

  void solve(double parameter, RunContext& context) override {
    const Phase phase(context, "mesh");
    meshes_.clear();
    for (KeyframedMesh& one : keyframes_.at(parameter, hidden_)) {
      StructureMesh& mesh = meshes_.emplace_back();
      mesh.structures = {one.structure};
      mesh.structure_of_triangle.assign(one.mesh.F.rows(), one.structure);
      mesh.mesh = std::move(one.mesh);
    }
    state_ = state_at(parameter);
  }
  [[nodiscard]] Frame frame() const override { return day_frame(scene_, state_, meshes_); }

 private:
  [[nodiscard]] DayState state_at(double day) const {
    const auto above =
        std::upper_bound(middles_.begin(), middles_.end(), day,
                         [](double d, const DayState& state) { return d < state.day; });
    const DayState& a = above == middles_.begin() ? middles_.front() : *(above - 1);
    const DayState& b = above == middles_.end() ? middles_.back() : *above;
    const double u = b.day > a.day ? std::clamp((day - a.day) / (b.day - a.day), 0.0, 1.0) : 0;
    DayState out;
    out.day = day;
    out.crown_rump_length = a.crown_rump_length + u * (b.crown_rump_length - a.crown_rump_length);
    for (const StructureState& one : a.structures) {
      if (hidden_[one.structure]) continue;
      const StructureState* next = find_state(b, one.structure);
      out.structures.push_back(
          {one.structure, next == nullptr ? one.shape : between(one.shape, next->shape, u)});
    }
    return out;
  }

  const EmbryoScene& scene_;
  std::vector<DayState> middles_;
  Keyframes keyframes_;
  std::vector<bool> hidden_;
  std::vector<StructureMesh> meshes_;
  DayState state_;
};

}  // namespace

void describe(OptionVisitor& /*v*/, KeyframesMethodOptions& /*options*/) {}

std::unique_ptr<PoseMethod> make_keyframes_method(const EmbryoScene& scene,
                                                  const KeyframesMethodOptions&, RunContext&) {
  return std::make_unique<KeyframesMethod>(scene);
}

}  // namespace geoprior::embryo
