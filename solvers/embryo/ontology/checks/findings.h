#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "solvers/embryo/ontology/typed_graph.h"
#include "solvers/embryo/ontology/violation.h"

namespace geoprior::embryo {

/// What the checks have found, and what they look at.
class Findings {
 public:
  explicit Findings(const TypedGraph& graph) : graph_(graph) {}

  /// The violation is that of the line of the property, or of the node.
  /// @param kind  one of `violation_kinds`
  void add(std::string_view kind, Term node, const std::string& message,
           std::string_view property = {}) {
    add_at(kind, node, message, graph_.line(node, property));
  }
  void add_at(std::string_view kind, Term node, const std::string& message, int line) {
    found_.push_back({std::string(kind), graph_.name_of(node), message, line});
  }
  [[nodiscard]] int size() const { return static_cast<int>(found_.size()); }
  [[nodiscard]] std::vector<Violation> take() { return std::move(found_); }

  [[nodiscard]] const TypedGraph& graph() const { return graph_; }
  /// 'name', as messages call a node.
  [[nodiscard]] std::string quoted(Term node) const {
    // Appended: GCC 12 takes a literal before a string for an overflow (GCC bug 105651).
    std::string out(1, '\'');
    out += graph_.name_of(node);
    out += '\'';
    return out;
  }

 private:
  const TypedGraph& graph_;
  std::vector<Violation> found_;
};

/// Orders of the first and the last stage of a structure.
struct Lifetime {
  int first = 0, last = 0;
  /// Of a whole that is divided: the last stage of its products, whose shape it still gives.
  int last_shape = 0;
  [[nodiscard]] bool has(int order) const { return first <= order && order <= last_shape; }
};

/// A key whose structure, stage and geometry are well-formed.
struct FoundKey {
  Term node, structure, geometry;
  int order;
  std::optional<Term> parameter_set;
};

/// "an Ovoid", "a Duct".
inline std::string with_article(std::string_view name) {
  const bool is_vowel = std::string_view("AEIOU").find(name.front()) != std::string_view::npos;
  return (is_vowel ? "an " : "a ") + std::string(name);
}

/// When things are: what several checks read.
struct Chronology {
  std::map<Term, int> order_of_stage;
  std::map<Term, Lifetime> lifetimes;          ///< those with a first and a last stage in order
  std::map<Term, std::vector<FoundKey>> keys;  ///< of a structure, by order
  std::map<Term, bool> has_broken_key;         ///< of structures
  bool has_homeless_key = false;               ///< one without a structure
  std::vector<std::optional<Term>> sets;       ///< parameter sets; one absent where there are none

  /// Of keys that are common to all sets or of this one.
  [[nodiscard]] std::vector<FoundKey> keys_of(Term structure, const std::optional<Term>& set) const;
};

Chronology chronology_of(const TypedGraph& graph);

/// Cycles of a relation, each once, from its first node in the order of terms.
std::vector<std::vector<Term>> cycles_of(std::map<Term, std::vector<Term>> successors);

// The checks. Those behind the first take what is malformed for absent.

void check_statements(Findings& findings);  ///< each statement against the vocabulary
void check_stages(Findings& findings);
void check_structures(const Chronology& chronology, Findings& findings);
void check_keys(const Chronology& chronology, Findings& findings);
void check_placement(const Chronology& chronology, Findings& findings);
void check_processes(const Chronology& chronology, Findings& findings);
void check_diseases(Findings& findings);
void check_measurements(Findings& findings);

}  // namespace geoprior::embryo
