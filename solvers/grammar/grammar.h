#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "solvers/grammar/engine/derivation.h"

namespace geoprior::grammar {

/// How a deformation grammar is used.
struct GrammarOptions {
  enum class Mode {
    from_start,  ///< each step of a gesture is derived from the state at its start
    incremental  ///< from the step before
  };
  Mode mode = Mode::from_start;
  bool ascend = true;                ///< false: what is edited bounds the locality itself
  bool keep_edits = true;            ///< false: nothing is tagged
  std::vector<std::string> without;  ///< names of rules that are left out; * stands for any letters
};
void describe(OptionVisitor& v, GrammarOptions& options);

/// The rules that such options leave.
RuleSet rules_for(const RuleSet& all, const GrammarOptions& options);

/// An object and the rules by which it interprets what a user asks for: edits on elements, which
/// stay, and gestures, of which each step may be derived from the state at the gesture's start.
///
/// What it does: derive (engine/derivation.h), keep the edits by tags, take back. What it cannot
/// do: choose rules, or a hierarchy; find the nearest state that keeps all constraints (a rule
/// looks at an element and its children, not at all of the object).
/// Source: thesis 2.2.4; Vimont et al. 2017.
class DeformationGrammar {
 public:
  DeformationGrammar(Hierarchy rest, const RuleSet& rules, const GrammarOptions& options);
  // The transaction refers to the state.
  DeformationGrammar(const DeformationGrammar&) = delete;
  DeformationGrammar& operator=(const DeformationGrammar&) = delete;

  /// An edit that stays. Ends a gesture at its present state.
  /// @param tag  left on the edited element, so that nothing above it undoes the edit
  /// @throws Error  as `derive`; the state is as it was
  DerivationReport edit(const Edit& wish, const std::optional<Tag>& tag, bool trace = false);
  /// A step of a gesture: `from_start` maps the state at the gesture's start, `from_last` that of
  /// the step before; the mode says which is used. A step that is the identity is the start again,
  /// bit for bit, in the mode `from_start`.
  DerivationReport gesture(int element, const std::shared_ptr<const SpatialMap>& from_start,
                           const std::shared_ptr<const SpatialMap>& from_last, bool trace = false);
  /// Takes the last edit or step back, bit for bit.
  void undo();

  [[nodiscard]] const Hierarchy& state() const { return state_; }
  /// The same, to be put back as it was saved.
  [[nodiscard]] Hierarchy& state() { return state_; }
  /// Of the last edit or step.
  [[nodiscard]] const Transaction& transaction() const { return transaction_; }

 private:
  Hierarchy state_;
  RuleSet rules_;
  GrammarOptions options_;
  Transaction transaction_;
  bool in_gesture_ = false;
};

}  // namespace geoprior::grammar
