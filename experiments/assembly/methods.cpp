#include <type_traits>

#include "baselines/assembly/brute_force.h"
#include "baselines/assembly/growth.h"
#include "baselines/assembly/random_replacement.h"
#include "baselines/assembly/single_exchange.h"
#include "baselines/assembly/wave_collapse.h"
#include "core/error.h"
#include "experiments/assembly/processes/process.h"
#include "experiments/assembly/scene/scene.h"
#include "experiments/assembly/topic.h"
#include "models/assembly/search/search.h"
#include "solvers/assembly/exact.h"

namespace geoprior::assembly {
namespace {

/// A finder's options and those of the search that it serves.
template <class Finder>
struct Searching {
  Finder find;
  SearchOptions search;
};
template <class Finder>
void describe(OptionVisitor& v, Searching<Finder>& options) {
  describe(v, options.find);
  describe(v, options.search);
  if constexpr (std::is_same_v<Finder, ExactOptions>)
    v.value(
        "prefilter", options.search.prefilter,
        {.doc = "whether replacements that would break a rule, or change nothing, are found out "
                "before the assembly is built"});
}

/// The row of a finder. `make(donors, options, keep_alike, context)` returns it, `symmetries` says
/// of its options whether it minds symmetries.
template <class Finder, class Make, class Symmetries>
MethodEntry finder_entry(std::string name, bool is_baseline, std::string summary,
                         std::string source, Make make, Symmetries symmetries) {
  using Options = Searching<Finder>;
  return method_entry<AssemblyScene, Options>(
      std::move(name), is_baseline, std::move(summary), std::move(source),
      [make, symmetries](const AssemblyScene& scene, const Options& options, RunContext&) {
        return replacement_process(
            scene.input,
            [make, find = options.find](const DonorSet& donors, bool keep_alike,
                                        RunContext& context) {
              return make(donors, find, keep_alike, context);
            },
            symmetries(options.find), options.search);
      });
}

constexpr auto kMatchSymmetries = [](const auto& options) { return options.match.symmetries; };
constexpr auto kOwnSymmetries = [](const auto& options) { return options.symmetries; };

}  // namespace

std::vector<MethodEntry> methods() {
  return {
      finder_entry<ExactOptions>(
          "exact", false, "all replaceable substructures, from the cuts of the graph",
          "thesis 2.2.3; Liu et al. 2015",
          [](const DonorSet& donors, const ExactOptions& options, bool keep_alike, RunContext&) {
            return make_exact_finder(donors, options, keep_alike);
          },
          kMatchSymmetries),
      finder_entry<BruteForceOptions>(
          "brute-force", true, "all connected sets of parts, part by part: the oracle, 40 parts",
          "exhaustive search",
          [](const DonorSet& donors, const BruteForceOptions& options, bool, RunContext&) {
            return make_brute_force(donors, options);
          },
          kMatchSymmetries),
      finder_entry<GrowthOptions>(
          "growth", true, "two substructures grow at once from pairs of like connections",
          "thesis 2.2.3",
          [](const DonorSet& donors, const GrowthOptions& options, bool, RunContext&) {
            return make_growth(donors, options);
          },
          kMatchSymmetries),
      finder_entry<RandomReplacementOptions>(
          "random-replacement", true, "random connected parts, replaced where they happen to match",
          "rejection sampling",
          [](const DonorSet& donors, const RandomReplacementOptions& options, bool,
             RunContext& context) {
            return make_random_replacement(donors, options, context.random("replacements"));
          },
          kMatchSymmetries),
      finder_entry<SingleExchangeOptions>(
          "single-exchange", true, "one part is exchanged for another", "Kreavoy et al. 2007",
          [](const DonorSet& donors, const SingleExchangeOptions& options, bool, RunContext&) {
            return make_single_exchange(donors, options);
          },
          kOwnSymmetries),
      method_entry<AssemblyScene, WaveCollapseOptions>(
          "wave-collapse", true, "parts are put to open ports by what was seen there",
          "Gumin 2016, on ports",
          [](const AssemblyScene& scene, const WaveCollapseOptions& options, RunContext&) {
            if (scene.input.survey)
              throw Error("lists no substructures", "wave-collapse", "a scene without `survey`");
            return make_wave_collapse(scene.input, options);
          }),
  };
}

std::vector<DiagnosticEntry> diagnostics() {
  constexpr Tolerance kCounts{0, 0};
  DiagnosticTable table;
  table.unmeasured("of the search: only what it keeps is recorded",
                   {{"depth", "1", "replacements one after the other, from an input"},
                    {"candidates", "1", "replacements that were looked at so far", true, kCounts},
                    {"closing", "1", "of these, those whose seams meet", true, kCounts},
                    {"valid", "1", "of these, distinct ones that keep all rules"},
                    {"duplicates", "1", "assemblies that were made before"},
                    {"states", "1", "assemblies whose replacements were looked at"}});
  table.unmeasured(
      "of assemblies that were thrown away: of those that were kept each rule has its metric",
      {{"broken_bill", "1", "assemblies of more parts than are to be had"},
       {"broken_counts", "1", "assemblies with too few or many entries or exits"},
       {"broken_connected", "1", "assemblies that do not hang together"},
       {"broken_closure", "1", "assemblies with a joint beyond the tolerance"},
       {"broken_ground", "1", "assemblies with a part that should stand on the floor and does not"},
       {"broken_box", "1", "assemblies that leave the box"},
       {"broken_way", "1", "assemblies with a ball's way that rises or does not end in an exit"},
       {"broken_collision", "1", "assemblies with parts that meet"}});
  return table.rows();
}

}  // namespace geoprior::assembly
