#include <array>

#include "baselines/embryo/direct_table.h"
#include "baselines/embryo/plain_union.h"
#include "core/error.h"
#include "experiments/embryo/frames/day_frame.h"
#include "experiments/embryo/poses/methods.h"
#include "models/embryo/surface/mesh.h"
#include "solvers/embryo/ontology/read_ontology.h"

namespace geoprior::embryo {
namespace {

double under_way(const DayState& state) {
  double count = 0;
  for (const ProcessState& process : state.processes)
    if (process.active && process.progress > 0 && process.progress < 1) ++count;
  return count;
}

/// A day's state by `state(day)`, its surfaces by `mesh(state)`, as a pose method of the topic.
template <class State, class Mesh>
class DayMethod final : public PoseMethod {
 public:
  DayMethod(const EmbryoScene& scene, State state, Mesh mesh)
      : scene_(scene), state_of_(std::move(state)), mesh_of_(std::move(mesh)) {}

  void solve(double parameter, RunContext& context) override {
    {
      const Phase phase(context, "state");
      state_ = state_of_(parameter);
    }
    const Phase phase(context, "mesh");
    meshes_ = mesh_of_(wanted(scene_, state_));
  }
  [[nodiscard]] Frame frame() const override {
    Frame frame = day_frame(scene_, state_, meshes_);
    frame.diagnostics["active_processes"] = under_way(state_);
    return frame;
  }

 private:
  const EmbryoScene& scene_;
  State state_of_;
  Mesh mesh_of_;
  DayState state_;
  std::vector<StructureMesh> meshes_;
};

template <class State, class Mesh>
std::unique_ptr<PoseMethod> day_method(const EmbryoScene& scene, State state, Mesh mesh) {
  return std::make_unique<DayMethod<State, Mesh>>(scene, std::move(state), std::move(mesh));
}

void describe_triangles(OptionVisitor& v, int& triangles) {
  v.value("triangles", triangles,
          {.doc = "least number of triangles of a structure's surface", .min = 200, .max = 200000});
}

const Effects& effects_for(const EmbryoScene& scene, const OntologyOptions& options) {
  if (options.healthy) return scene.healthy_effects;
  return options.rules ? scene.effects : scene.named_effects;
}

}  // namespace

void describe(OptionVisitor& v, OntologyOptions& options) {
  constexpr std::array<std::string_view, 2> kInterpolations{"monotone", "linear"};
  v.value(
      "rules", options.rules,
      {.doc = "whether consequences follow by the rules; without them a disease changes what it "
              "names, and no more"});
  v.value("healthy", options.healthy,
          {.doc = "whether the scene's disease is left out: the reference of what it changes"});
  describe_choice(
      v, "interpolation", options.interpolation, kInterpolations,
      {.doc = "how values go from key frame to key frame: monotone cubics of continuous "
              "velocity, or straight lines"});
  v.value("stage_shift", options.stage_shift,
          {.doc = "stages by which the key frames and processes of the parameter set are late: the "
                  "null of what a set says of the literature",
           .min = -2,
           .max = 2});
  describe_triangles(v, options.triangles);
}

std::unique_ptr<PoseMethod> make_ontology_method(const EmbryoScene& scene,
                                                 const OntologyOptions& options, RunContext&) {
  SurfaceOptions surface;
  surface.triangles = options.triangles;
  const Ontology ontology =
      options.stage_shift == 0
          ? scene.ontology
          : make_ontology(scene.graph, {scene.options.parameter_set, options.stage_shift},
                          scene.files.triples.front().where);
  return day_method(
      scene,
      [development = Development(ontology, effects_for(scene, options), {options.interpolation})](
          double day) { return development.at(day); },
      [surface](const DayState& state) { return day_meshes(state, surface); });
}

void describe(OptionVisitor& v, UnionOptions& options) { describe_triangles(v, options.triangles); }

std::unique_ptr<PoseMethod> make_union_method(const EmbryoScene& scene, const UnionOptions& options,
                                              RunContext&) {
  SurfaceOptions surface;
  surface.triangles = options.triangles;
  return day_method(
      scene,
      [development = Development(scene.ontology, scene.effects, {})](double day) {
        return development.at(day);
      },
      [surface](const DayState& state) { return plain_union(state, surface); });
}

void describe(OptionVisitor& /*v*/, TableOptions& /*options*/) {}

std::unique_ptr<PoseMethod> make_table_method(const EmbryoScene& scene, const TableOptions&,
                                              RunContext&) {
  const auto disease = scene.options.disease ? table_disease(*scene.options.disease)
                                             : std::optional(TableDisease::none);
  if (!disease)
    throw Error("the table has no function for the disease '" + *scene.options.disease + "'",
                "scene.disease", "those that somebody has written one for");
  DirectTable table(*disease);
  if (table.structures() != scene.structure_names)
    throw Error("the table was typed in for another ontology", "scene.ontology", "urinary.ttl");
  return day_method(
      scene, [table = std::move(table)](double day) { return table.at(day); },
      [](const DayState& state) { return day_meshes(state); });
}

}  // namespace geoprior::embryo
