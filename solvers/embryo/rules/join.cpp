#include "solvers/embryo/rules/join.h"

#include <algorithm>
#include <map>

namespace geoprior::embryo {
namespace {

using Does = JoinPlace::Does;

class JoinMaker {
 public:
  JoinMaker(const RuleProgram& program, const Rule& rule, const ProgramTerms& terms, Facts& facts)
      : program_(program),
        rule_(rule),
        terms_(terms),
        facts_(facts),
        bound_(rule.variables.size()) {
    join_.line = rule.line;
  }

  Join join(int fresh, const std::vector<bool>& is_of_stratum) {
    std::vector<int> waiting;
    for (int l = 0; l < std::ssize(rule_.body); ++l) waiting.push_back(l);
    if (fresh >= 0) begin_with(fresh, waiting);
    for (;;) {
      take_decidable(waiting);
      const auto next = most_bound(waiting);
      if (next == waiting.end()) break;
      // Of two literals with fresh facts both, the pass for the later one joins the pair.
      const bool is_earlier_pass = fresh >= 0 && *next > fresh &&
                                   rule_.body[fresh].kind == RuleLiteral::Kind::holds &&
                                   is_of_stratum[rule_.body[*next].atom.predicate];
      add_each(rule_.body[*next].atom,
               is_earlier_pass ? JoinStep::Range::before : JoinStep::Range::all);
      waiting.erase(next);
    }
    join_.head = terms_.relations[rule_.head.predicate];
    join_.head_places = places(rule_.head);
    join_.variables = static_cast<int>(bound_.size());
    return std::move(join_);
  }

 private:
  [[nodiscard]] int arity(const Atom& atom) const {
    return program_.predicates[atom.predicate].arity;
  }

  /// The fresh facts come first. Those of `atom for all condition` name the instances of the
  /// condition to ask again: its own variables get other numbers there, for the literal itself is
  /// judged anew.
  void begin_with(int fresh, std::vector<int>& waiting) {
    const RuleLiteral& literal = rule_.body[fresh];
    if (literal.kind == RuleLiteral::Kind::holds) {
      add_each(literal.atom, JoinStep::Range::fresh);
      std::erase(waiting, fresh);
      return;
    }
    std::map<int, int> renamed;
    const std::vector<bool> outside = bound_outside();
    const auto copy = [&](Atom atom) {
      for (RuleTerm& term : atom.places) {
        if (term.kind != RuleTerm::Kind::variable || outside[term.index]) continue;
        const auto [at, is_new] = renamed.try_emplace(term.index, static_cast<int>(bound_.size()));
        if (is_new) bound_.push_back(false);
        term.index = at->second;
      }
      return atom;
    };
    add_each(copy(literal.atom), JoinStep::Range::fresh);
    add_each(copy(literal.condition), JoinStep::Range::all);
  }

  /// Variables that a literal that holds has.
  [[nodiscard]] std::vector<bool> bound_outside() const {
    std::vector<bool> outside(rule_.variables.size());
    for (const RuleLiteral& literal : rule_.body) {
      if (literal.kind != RuleLiteral::Kind::holds) continue;
      for (int place = 0; place < arity(literal.atom); ++place)
        if (literal.atom.places[place].kind == RuleTerm::Kind::variable)
          outside[literal.atom.places[place].index] = true;
    }
    return outside;
  }

  void take_decidable(std::vector<int>& waiting) {
    const std::vector<bool> outside = bound_outside();
    std::erase_if(waiting, [&](int l) {
      const RuleLiteral& literal = rule_.body[l];
      if (literal.kind == RuleLiteral::Kind::holds) return false;
      if (!is_ready(literal.atom, outside)) return false;
      if (literal.kind == RuleLiteral::Kind::fails) {
        add_none(literal.atom);
        return true;
      }
      if (!is_ready(literal.condition, outside)) return false;
      add_for_all(literal);
      return true;
    });
  }

  /// Whether all that is bound outside is bound by now.
  [[nodiscard]] bool is_ready(const Atom& atom, const std::vector<bool>& outside) const {
    for (int place = 0; place < arity(atom); ++place) {
      const RuleTerm& term = atom.places[place];
      if (term.kind == RuleTerm::Kind::variable && outside[term.index] && !bound_[term.index])
        return false;
    }
    return true;
  }

  std::vector<int>::iterator most_bound(std::vector<int>& waiting) const {
    auto best = waiting.end();
    int best_score = -1;
    for (auto at = waiting.begin(); at != waiting.end(); ++at) {
      if (rule_.body[*at].kind != RuleLiteral::Kind::holds) continue;
      const Atom& atom = rule_.body[*at].atom;
      int known = 0;
      for (int place = 0; place < arity(atom); ++place) known += is_known(atom.places[place]);
      // A whole tuple before a walk over an index, that before a walk over all.
      const int score = known == arity(atom) ? 2 : known;
      if (score > best_score) {
        best = at;
        best_score = score;
      }
    }
    return best;
  }

  [[nodiscard]] bool is_known(const RuleTerm& term) const {
    return term.kind == RuleTerm::Kind::constant ||
           (term.kind == RuleTerm::Kind::variable && bound_[term.index]);
  }

  /// Binds the variables that are not yet.
  std::array<JoinPlace, 2> places(const Atom& atom) {
    std::array<JoinPlace, 2> out;
    for (int place = 0; place < arity(atom); ++place) {
      const RuleTerm& term = atom.places[place];
      if (term.kind == RuleTerm::Kind::constant)
        out[place] = {Does::compare_constant, terms_.constants[term.index]};
      if (term.kind != RuleTerm::Kind::variable) continue;
      out[place] = {bound_[term.index] ? Does::compare_variable : Does::bind, term.index};
      bound_[term.index] = true;
    }
    return out;
  }

  /// The place to look a tuple up by, with its index made; before `places` binds its variables.
  int look_up(const Atom& atom, int relation) {
    const bool first = is_known(atom.places[0]);
    if (arity(atom) == 1) return first ? 2 : -1;
    const bool second = is_known(atom.places[1]);
    if (first && second) return 2;
    if (!first && !second) return -1;
    facts_.relation(relation).index(first ? 0 : 1);
    return first ? 0 : 1;
  }

  JoinStep step(JoinStep::Kind kind, const Atom& atom) {
    JoinStep step;
    step.kind = kind;
    step.relation = terms_.relations[atom.predicate];
    step.look_up = look_up(atom, step.relation);
    step.places = places(atom);
    return step;
  }

  void add_each(const Atom& atom, JoinStep::Range range) {
    JoinStep added = step(JoinStep::Kind::each, atom);
    added.range = range;
    // Fresh tuples are a stretch at the end: walked rather than looked up.
    if (range == JoinStep::Range::fresh) added.look_up = -1;
    join_.steps.push_back(added);
  }

  void add_none(const Atom& atom) { join_.steps.push_back(step(JoinStep::Kind::none, atom)); }

  void add_for_all(const RuleLiteral& literal) {
    const std::vector<bool> before = bound_;
    JoinStep added = step(JoinStep::Kind::for_all, literal.condition);
    added.inner = terms_.relations[literal.atom.predicate];
    added.inner_look_up = look_up(literal.atom, added.inner);
    added.inner_places = places(literal.atom);
    bound_ = before;
    join_.steps.push_back(added);
  }

  const RuleProgram& program_;
  const Rule& rule_;
  const ProgramTerms& terms_;
  Facts& facts_;
  std::vector<bool> bound_;
  Join join_;
};

}  // namespace

Join make_join(const RuleProgram& program, const Rule& rule, int fresh,
               const std::vector<bool>& is_of_stratum, const ProgramTerms& terms, Facts& facts) {
  return JoinMaker(program, rule, terms, facts).join(fresh, is_of_stratum);
}

}  // namespace geoprior::embryo
