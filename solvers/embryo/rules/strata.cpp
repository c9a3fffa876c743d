#include "solvers/embryo/rules/strata.h"

#include <algorithm>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

/// The head of `rule` depends on `predicate`; `negative` where it must be complete before.
struct Dependence {
  int predicate, rule;
  bool negative;
};

using Dependences = std::vector<std::vector<Dependence>>;

Dependences dependences_of(const RuleProgram& program) {
  Dependences of_head(program.predicates.size());
  for (int r = 0; r < std::ssize(program.rules); ++r) {
    const Rule& rule = program.rules[r];
    for (const RuleLiteral& literal : rule.body) {
      of_head[rule.head.predicate].push_back(
          {literal.atom.predicate, r, literal.kind == RuleLiteral::Kind::fails});
      if (literal.kind == RuleLiteral::Kind::for_all)
        of_head[rule.head.predicate].push_back({literal.condition.predicate, r, true});
    }
  }
  return of_head;
}

/// Tarjan's algorithm without recursion: components in an order in which each comes after all that
/// it depends on.
class Components {
 public:
  explicit Components(const Dependences& edges)
      : edges_(edges),
        component(edges.size(), -1),
        number_(edges.size(), -1),
        lowest_(edges.size()) {
    for (int p = 0; p < std::ssize(edges); ++p)
      if (number_[p] < 0) visit(p);
  }

 private:
  struct Visit {
    int predicate;
    std::size_t next;
  };

  void enter(int predicate) {
    number_[predicate] = lowest_[predicate] = met_++;
    open_.push_back(predicate);
    path_.push_back({predicate, 0});
  }

  void visit(int root) {
    enter(root);
    while (!path_.empty()) {
      Visit& top = path_.back();
      if (top.next < edges_[top.predicate].size()) {
        const int to = edges_[top.predicate][top.next++].predicate;
        if (number_[to] < 0)
          enter(to);
        else if (component[to] < 0)
          lowest_[top.predicate] = std::min(lowest_[top.predicate], number_[to]);
        continue;
      }
      leave(top.predicate);
    }
  }

  void leave(int predicate) {
    if (lowest_[predicate] == number_[predicate]) {
      int member;
      do {
        member = open_.back();
        open_.pop_back();
        component[member] = count;
      } while (member != predicate);
      ++count;
    }
    path_.pop_back();
    if (path_.empty()) return;
    const int above = path_.back().predicate;
    lowest_[above] = std::min(lowest_[above], lowest_[predicate]);
  }

  const Dependences& edges_;

 public:
  std::vector<int> component;
  int count = 0;

 private:
  std::vector<int> number_, lowest_, open_;
  std::vector<Visit> path_;
  int met_ = 0;
};

/// "absent -> not inactive -> absent": a shortest way within the component that begins with
/// `first`.
std::string cycle_text(const RuleProgram& program, const Dependences& edges,
                       const std::vector<int>& component, int head, const Dependence& first) {
  std::vector<Dependence> reached_by(edges.size(), {-1, -1, false});
  std::vector<int> queue{first.predicate};
  std::vector<bool> seen(edges.size());
  seen[first.predicate] = true;
  for (std::size_t i = 0; i < queue.size() && queue[i] != head; ++i) {
    for (const Dependence& edge : edges[queue[i]]) {
      if (component[edge.predicate] != component[head] || seen[edge.predicate]) continue;
      seen[edge.predicate] = true;
      reached_by[edge.predicate] = {queue[i], edge.rule, edge.negative};
      queue.push_back(edge.predicate);
    }
  }
  const auto name = [&](int predicate, bool negative) {
    return (negative ? "not " : "") + program.predicates[predicate].name;
  };
  std::string way;
  for (int at = head; at != first.predicate; at = reached_by[at].predicate)
    way = " -> " + name(at, reached_by[at].negative) + way;
  return name(head, false) + " -> " + name(first.predicate, true) + way;
}

void require_stratified(const RuleProgram& program, const Dependences& edges,
                        const std::vector<int>& component) {
  for (int head = 0; head < std::ssize(edges); ++head) {
    for (const Dependence& edge : edges[head]) {
      if (!edge.negative || component[edge.predicate] != component[head]) continue;
      throw Error("cycle through negation: " + cycle_text(program, edges, component, head, edge),
                  program.where + ":" + std::to_string(program.rules[edge.rule].line),
                  "'not' and 'for all' of predicates that do not depend on the rule's own");
    }
  }
}

}  // namespace

void order_into_strata(RuleProgram& program) {
  const Dependences edges = dependences_of(program);
  const Components found(edges);
  require_stratified(program, edges, found.component);
  program.strata.assign(found.count, {});
  for (int r = 0; r < std::ssize(program.rules); ++r)
    program.strata[found.component[program.rules[r].head.predicate]].push_back(r);
  std::erase_if(program.strata, [](const std::vector<int>& stratum) { return stratum.empty(); });
}

}  // namespace geoprior::embryo
