#include "solvers/grammar/grammar.h"

#include <algorithm>
#include <array>
#include <utility>

namespace geoprior::grammar {

void describe(OptionVisitor& v, GrammarOptions& options) {
  constexpr std::array<std::string_view, 2> kModes{"from-start", "incremental"};
  describe_choice(
      v, "mode", options.mode, kModes,
      {.doc = "what the steps of a gesture are derived from: the state at its start, or "
              "that of the step before"});
  v.value("ascend", options.ascend,
          {.doc = "whether an edit is passed up to the element that bounds its locality; without, "
                  "it is passed down only"});
  v.value("keep_edits", options.keep_edits,
          {.doc = "whether edits are tagged, so that nothing above the element undoes them"});
  v.value("without", options.without,
          {.doc = "names of rules that are left out, * for any letters: the default rule, a rigid "
                  "motion, stands in"});
}

RuleSet rules_for(const RuleSet& all, const GrammarOptions& options) {
  if (options.ascend && options.without.empty()) return all;
  RuleSet left = all;
  left.remove_if([&](const Rule& rule) {
    return (!options.ascend && rule.guard.phase == Phase::up) ||
           std::any_of(options.without.begin(), options.without.end(),
                       [&](const std::string& pattern) { return matches(pattern, rule.name); });
  });
  if (!options.ascend) left.bound_locality("*");
  return left;
}

DeformationGrammar::DeformationGrammar(Hierarchy rest, const RuleSet& rules,
                                       const GrammarOptions& options)
    : state_(std::move(rest)),
      rules_(rules_for(rules, options)),
      options_(options),
      transaction_(state_) {}

DerivationReport DeformationGrammar::edit(const Edit& wish, const std::optional<Tag>& tag,
                                          bool trace) {
  in_gesture_ = false;
  DerivationReport report = derive(state_, transaction_, rules_, wish, trace);
  if (tag && options_.keep_edits) state_.set_tag(wish.element, *tag);
  return report;
}

DerivationReport DeformationGrammar::gesture(int element,
                                             const std::shared_ptr<const SpatialMap>& from_start,
                                             const std::shared_ptr<const SpatialMap>& from_last,
                                             bool trace) {
  const bool anew = options_.mode == GrammarOptions::Mode::from_start;
  if (anew && in_gesture_) transaction_.roll_back();
  in_gesture_ = true;
  return derive(state_, transaction_, rules_, {element, Delta::free(anew ? from_start : from_last)},
                trace);
}

void DeformationGrammar::undo() {
  transaction_.roll_back();
  in_gesture_ = false;
}

}  // namespace geoprior::grammar
