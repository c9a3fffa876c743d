#include "experiments/grammar/processes/methods.h"

#include "experiments/grammar/topic.h"

namespace geoprior::grammar {
namespace {

/// Of methods that have none.
struct NoGrammarOptions {};
void describe(OptionVisitor&, NoGrammarOptions&) {}

/// The row of a method. `make(scene, options, context)` returns its Deformer.
template <class Options, class Make>
MethodEntry deformer_entry(std::string name, bool is_baseline, std::string summary,
                           std::string source, Make make) {
  return method_entry<GrammarScene, Options>(
      std::move(name), is_baseline, std::move(summary), std::move(source),
      [make](const GrammarScene& scene, const Options& options, RunContext&) {
        return deforming_process(scene, [make, &scene, options](RunContext& context) {
          return make(scene, options, context);
        });
      });
}

using S = GrammarScene;

}  // namespace

std::vector<MethodEntry> methods() {
  using None = NoGrammarOptions;
  return {
      deformer_entry<GrammarMethodOptions>(
          "grammar", false, "rules interpret the deformation, element by element",
          "thesis 2.2.4; Vimont et al. 2017",
          [](const S& scene, const GrammarMethodOptions& options, RunContext& context) {
            return grammar_deformer(scene, options, context);
          }),
      deformer_entry<None>(
          "nothing", true, "the object stays as it is", "the identity",
          [](const S& scene, const None&, RunContext&) { return nothing_deformer(scene); }),
      deformer_entry<None>(
          "free-form", true, "every vertex by the map", "Sederberg and Parry 1986",
          [](const S& scene, const None&, RunContext&) { return free_form_deformer(scene); }),
      deformer_entry<None>(
          "instance-frames", true, "every element rigidly, by the map at its position",
          "polar decomposition of the map's derivative",
          [](const S& scene, const None&, RunContext&) { return frames_deformer(scene); }),
      deformer_entry<RigidAsPossibleOptions>(
          "rigid-as-possible", true,
          "every element as rigid as possible, between points by the map",
          "Sorkine and Alexa 2007; CGAL",
          [](const S& scene, const RigidAsPossibleOptions& options, RunContext&) {
            return rigid_deformer(scene, options);
          }),
      deformer_entry<None>(
          "optimum", true, "all of the object at once: nearest to the map under the constraints",
          "non-linear least squares (Ceres)",
          [](const S& scene, const None&, RunContext&) { return optimum_deformer(scene); }),
      deformer_entry<None>(
          "direct", true,
          "older deformers by the code of other topics: what rules are held against",
          "Magnenat-Thalmann et al. 1988; Sederberg and Parry 1986; thesis 2.2.2",
          [](const S& scene, const None&, RunContext&) { return direct_deformer(scene); }),
      deformer_entry<None>(
          "regeneration", true, "the procedure again, with the sizes that fit the map best",
          "procedural modelling",
          [](const S& scene, const None&, RunContext&) { return regenerating_deformer(scene); }),
  };
}

std::vector<DiagnosticEntry> diagnostics() {
  constexpr Tolerance kCounts{0, 0};
  DiagnosticTable table;
  table.unmeasured(
      "work of a derivation, of which the object keeps only what it leaves",
      {{"rewrites", "1", "rules applied, one an element and phase", true, kCounts},
       {"rewrites_per_element", "1", "rewrites over the elements that were asked: at most 2"},
       {"asked", "1", "elements that were asked"},
       {"followed", "1", "elements that a tag let only follow what they hang on"},
       {"stopped", "1", "elements that a tag kept where they were"}});
  table.measured(
      "touched_share",
      {"changed", "1", "elements that were there and are not what they were, bit for bit"});
  table.measured("new_elements", {"spawned", "1", "elements that were added, or shown again"});
  table.measured("lost_elements", {"removed", "1", "elements that were taken away"});
  table.unmeasured(
      "work of the optimiser, of which the object keeps only the end",
      {{"iterations", "1", "iterations of the optimiser", true, {2, 0.2}},
       {"gradient", "1", "largest component of the projected gradient where it ended"},
       {"start", "1",
        "0: the better optimum began with the grammar's state, 1: with the rest state"}});
  return table.rows();
}

}  // namespace geoprior::grammar
