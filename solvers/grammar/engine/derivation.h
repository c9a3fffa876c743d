#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "solvers/grammar/engine/rule.h"

namespace geoprior::grammar {

/// A wish of the user: a deformation of an element.
struct Edit {
  int element = 0;
  Delta delta;
};

/// One application of a rule, in the tree that a derivation is.
struct TraceNode {
  int parent = -1;  ///< the application that asked for it; -1: the user's
  std::string rule;
  int first = 0;  ///< the first element of the batch
  int count = 0;  ///< elements of the batch
  DeltaKind kind = DeltaKind::identity;
  Origin origin = Origin::user;
  Phase phase = Phase::up;
};

/// What a derivation did.
struct DerivationReport {
  int rewrites = 0;              ///< rules applied, one an element
  int spawned = 0;               ///< elements added, or present again
  int removed = 0;               ///< elements taken away
  int stopped = 0;               ///< elements that a tag kept from being asked
  int followed = 0;              ///< elements that a tag let only follow
  int turned_at = 0;             ///< the element that bounded the locality
  std::vector<TraceNode> trace;  ///< empty unless asked for
};

/// Interprets an edit by rules: up from the edited element to the one that bounds the locality,
/// then down from there (thesis 2.2.4, figure 2.25).
///
/// It ends by construction: an element is asked once a phase, so there are at most two rewrites an
/// element; a rule that asks one twice is an error. On any error the hierarchy is as it was, bit
/// for bit. What is touched, new or taken away is in `transaction`, which is restarted before.
///
/// Elements with a tag are asked from above only to follow: rigidly with their parent, or not at
/// all. The tag of the edited element itself, and those above it, do not count.
///
/// Cost: in proportion to the elements that are asked.
/// @throws Error  naming rule, its file and line, and the element: what a rule throws, a value that
///                is not finite, a second symbol in one phase, a write beyond the batch
DerivationReport derive(Hierarchy& hierarchy, Transaction& transaction, const RuleSet& rules,
                        const Edit& edit, bool trace = false);

/// The trace as an indented text, one application a line.
std::string trace_text(const Hierarchy& hierarchy, const DerivationReport& report);

}  // namespace geoprior::grammar
