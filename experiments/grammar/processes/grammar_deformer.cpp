#include <array>
#include <utility>

#include "core/error.h"
#include "experiments/grammar/processes/derivation_drawing.h"
#include "experiments/grammar/processes/methods.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

/// Numbers that a script may read by name: the control points of the gesture's lattice.
std::map<std::string, std::vector<double>> script_constants(const GrammarScene& scene) {
  std::map<std::string, std::vector<double>> out;
  if (!scene.gesture.lattice) return out;
  const Lattice& lattice = *scene.gesture.lattice;
  const auto list = [](const Eigen::Vector3d& x) { return std::vector<double>{x[0], x[1], x[2]}; };
  out["lattice_low"] = list(lattice.low);
  out["lattice_high"] = list(lattice.high);
  out["lattice_points"] = {1. * lattice.points[0], 1. * lattice.points[1], 1. * lattice.points[2]};
  for (const Eigen::Vector3d& shift : lattice.shifts)
    out["lattice_shifts"].insert(out["lattice_shifts"].end(), shift.begin(), shift.end());
  return out;
}

class RuleDeformer final : public Deformer {
 public:
  RuleDeformer(const GrammarScene& scene, const GrammarMethodOptions& options, RunContext& context)
      : scene_(scene),
        options_(options),
        grammar_(scene.rest, scene_rules(scene, options.rules, options.limits, context.seed()),
                 options.grammar) {}

  void edit(const SceneEdit& edit) override {
    report_ = grammar_.edit(edit.wish, edit.tag, options_.trace);
  }
  void deform(std::size_t step, const std::shared_ptr<const SpatialMap>& from_start) override {
    const bool anew = options_.grammar.mode == GrammarOptions::Mode::from_start;
    const auto from_last = anew ? from_start : scene_.asked_since(step);
    report_ = grammar_.gesture(scene_.gesture_element, from_start, from_last, options_.trace);
  }
  [[nodiscard]] const Hierarchy& shown() const override { return grammar_.state(); }

  [[nodiscard]] std::map<std::string, double> diagnostics() const override {
    const auto asked = static_cast<double>(grammar_.transaction().touched().size());
    return {{"rewrites", report_.rewrites},
            {"rewrites_per_element", asked > 0 ? report_.rewrites / asked : 0},
            {"asked", asked},
            {"changed", static_cast<double>(grammar_.transaction().changed().size())},
            {"spawned", report_.spawned},
            {"removed", report_.removed},
            {"followed", report_.followed},
            {"stopped", report_.stopped}};
  }
  void add_parts(Frame& frame) const override { add_touched(grammar_.transaction(), frame); }
  [[nodiscard]] std::vector<Artifact> artifacts(int frame) const override {
    if (!options_.trace) return {};
    return derivation_files(grammar_.state(), report_, frame);
  }
  void save(StateWriter& out) const override;
  void load(StateReader& in) override;

 private:
  [[nodiscard]] bool remembers_steps() const {
    return options_.grammar.mode == GrammarOptions::Mode::incremental;
  }

  const GrammarScene& scene_;
  GrammarMethodOptions options_;
  DeformationGrammar grammar_;
  DerivationReport report_;
};

void RuleDeformer::save(StateWriter& out) const {
  if (!remembers_steps()) return;
  const Hierarchy& h = grammar_.state();
  out.number(h.size());
  for (int e = 0; e < h.size(); ++e) {
    out.number(h.type_number(e));
    out.number(h.parent(e));
    out.number(h.present(e));
    const Pose pose = h.pose(e);
    out.matrix(pose.position);
    out.matrix(pose.turn.coeffs());
    const auto values = h.parameters(e);
    out.items(std::vector<double>(values.begin(), values.end()));
    const auto points = h.points(e);
    out.items(std::vector<Eigen::Vector3d>(points.begin(), points.end()));
  }
}

void RuleDeformer::load(StateReader& in) {
  if (!remembers_steps()) return;
  Hierarchy& h = grammar_.state();
  const auto size = in.number<int>();
  for (int e = 0; e < size; ++e) {
    const auto type = in.number<int>();
    const auto parent = in.number<int>();
    const auto present = in.number<bool>();
    Pose pose;
    Eigen::Vector4d turn;
    in.matrix(pose.position);
    in.matrix(turn);
    pose.turn.coeffs() = turn;
    std::vector<double> values;
    std::vector<Eigen::Vector3d> points;
    in.items(values);
    in.items(points);
    if (e >= h.size()) {
      h.add(type, parent, pose, values, points);
    } else {
      h.set_pose(e, pose);
      for (std::size_t p = 0; p < values.size(); ++p)
        h.set_parameter(e, static_cast<int>(p), values[p]);
      std::copy(points.begin(), points.end(), h.points(e).begin());
    }
    h.set_present(e, present);
  }
}

}  // namespace

void describe(OptionVisitor& v, GrammarMethodOptions& options) {
  constexpr std::array<std::string_view, 3> kRules{"native", "script", "both"};
  describe(v, options.grammar);
  describe_choice(v, "rules", options.rules, kRules,
                  {.doc = "rules that are used: those in C++, those of the scene's script, or the "
                          "script's and where it has none those in C++"});
  describe_group(v, "limits", options.limits, {.doc = "what a script may take"});
  v.value("trace", options.trace,
          {.doc = "whether the derivation of each step is recorded, as a tree"});
}

RuleSet scene_rules(const GrammarScene& scene, GrammarMethodOptions::Rules rules,
                    const LuaLimits& limits, std::uint64_t seed) {
  RuleSet out;
  if (rules != GrammarMethodOptions::Rules::native) {
    if (scene.script.empty())
      throw Error("a script is to be used, and the scene names none", "scene.rules",
                  "a file of rules (.lua)");
    out.add(lua_rules(scene.script, scene.script_file, limits, seed, script_constants(scene)));
  }
  if (rules != GrammarMethodOptions::Rules::script) out.add(object_rules());
  return out;
}

std::unique_ptr<Deformer> grammar_deformer(const GrammarScene& scene,
                                           const GrammarMethodOptions& options,
                                           RunContext& context) {
  return std::make_unique<RuleDeformer>(scene, options, context);
}

}  // namespace geoprior::grammar
