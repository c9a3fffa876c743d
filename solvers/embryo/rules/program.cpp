#include "solvers/embryo/rules/program.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/error.h"
#include "solvers/embryo/rules/strata.h"
#include "solvers/embryo/triples/dictionary.h"

namespace geoprior::embryo {
namespace {

constexpr std::size_t kMostBytes = 1u << 20;

bool is_small(char c) { return c >= 'a' && c <= 'z'; }
bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_name(char c) {
  return is_small(c) || is_capital(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

struct Token {
  enum class Kind { name, variable, constant, any, mark, end };
  Kind kind = Kind::end;
  std::string_view text;  ///< of a constant: its local name
  int line = 1;
};

std::string shown(const Token& token) {
  if (token.kind == Token::Kind::end) return "the end of the text";
  return "'" + std::string(token.text) + "'";
}

/// Cuts a text of rules into its words and marks.
class RuleWords {
 public:
  RuleWords(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  Token next() {
    skip_blanks();
    if (at_ == text_.size()) return {Token::Kind::end, {}, line_};
    const char c = text_[at_];
    if (text_.substr(at_, 2) == "e:") return constant();
    if (is_small(c)) return word(Token::Kind::name);
    if (is_capital(c)) return word(Token::Kind::variable);
    if (c == '_' && (at_ + 1 == text_.size() || !is_name(text_[at_ + 1])))
      return taken(Token::Kind::any, 1);
    if (text_.substr(at_, 2) == ":-") return taken(Token::Kind::mark, 2);
    if (std::string_view("(),.").find(c) != std::string_view::npos)
      return taken(Token::Kind::mark, 1);
    const bool is_printable = c > ' ' && c < 127;
    throw Error(
        is_printable ? "unexpected '" + std::string(1, c) + "'"
                     : "unexpected byte " + std::to_string(static_cast<unsigned char>(c)),
        where_ + ":" + std::to_string(line_),
        "predicate(Variable, e:Constant, _), ':-', 'not', 'for all', ',', '.', '% comment'");
  }

 private:
  void skip_blanks() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '%') at_ = std::min(text_.find('\n', at_), text_.size() - 1);
      if (text_[at_] == '\n') ++line_;
      if (c != '%' && c != ' ' && c != '\t' && c != '\r' && c != '\n') return;
    }
  }
  Token taken(Token::Kind kind, std::size_t length) {
    at_ += length;
    return {kind, text_.substr(at_ - length, length), line_};
  }
  Token word(Token::Kind kind) {
    std::size_t length = 1;
    while (at_ + length < text_.size() && is_name(text_[at_ + length])) ++length;
    return taken(kind, length);
  }
  Token constant() {
    at_ += 2;
    Token token = word(Token::Kind::constant);
    if (!is_small(token.text[0]) && !is_capital(token.text[0]))
      throw Error("'e:' without a name", where_ + ":" + std::to_string(line_), "e:CS13");
    return token;
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0;
  int line_ = 1;
};

class RuleParser {
 public:
  RuleParser(std::string_view text, const std::string& where) : words_(text, where) {
    program_.where = where;
    step();
  }

  RuleProgram program() {
    while (token_.kind != Token::Kind::end) {
      if (std::ssize(program_.rules) == kMostRules)
        fail("more than " + std::to_string(kMostRules) + " rules", "fewer");
      program_.rules.push_back(rule());
    }
    return std::move(program_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& allowed) const {
    throw Error(problem, program_.where + ":" + std::to_string(token_.line), allowed);
  }
  void step() { token_ = words_.next(); }
  [[nodiscard]] bool is(std::string_view text) const {
    return token_.kind != Token::Kind::constant && token_.text == text;
  }
  void expect(std::string_view mark) {
    if (!is(mark)) fail("unexpected " + shown(token_), "'" + std::string(mark) + "'");
    step();
  }

  Rule rule() {
    Rule rule;
    rule.line = token_.line;
    rule.head = atom(rule);
    if (is(":-")) {
      do {
        step();
        rule.body.push_back(literal(rule));
        if (std::ssize(rule.body) > kMostLiterals)
          fail("a rule of more than " + std::to_string(kMostLiterals) + " literals", "fewer");
      } while (is(","));
    }
    if (!is(".")) fail("unexpected " + shown(token_), rule.body.empty() ? "':-', '.'" : "',', '.'");
    require_safe(rule);
    step();
    return rule;
  }

  RuleLiteral literal(Rule& rule) {
    RuleLiteral literal;
    if (is("not")) {
      step();
      literal.kind = RuleLiteral::Kind::fails;
      literal.atom = atom(rule);
      return literal;
    }
    literal.atom = atom(rule);
    if (!is("for")) return literal;
    step();
    expect("all");
    literal.kind = RuleLiteral::Kind::for_all;
    literal.condition = atom(rule);
    return literal;
  }

  Atom atom(Rule& rule) {
    if (token_.kind != Token::Kind::name || is("not") || is("for") || is("all"))
      fail("unexpected " + shown(token_), "a predicate: a name that begins with a small letter");
    const Token name = token_;
    step();
    expect("(");
    Atom atom;
    atom.places[0] = place(rule);
    int arity = 1;
    if (is(",")) {
      step();
      atom.places[1] = place(rule);
      arity = 2;
    }
    if (is(",")) fail("predicate '" + std::string(name.text) + "' of three places", "one or two");
    expect(")");
    atom.predicate = predicate(name, arity);
    return atom;
  }

  RuleTerm place(Rule& rule) {
    const Token given = token_;
    step();
    if (given.kind == Token::Kind::any) return {};
    if (given.kind == Token::Kind::variable)
      return {RuleTerm::Kind::variable, number_of(rule.variables, std::string(given.text))};
    if (given.kind == Token::Kind::constant)
      return {RuleTerm::Kind::constant,
              number_of(program_.constants, std::string(kNamespace) + std::string(given.text))};
    token_ = given;
    fail("unexpected " + shown(given), "a Variable, a constant as e:CS13, or _");
  }

  int predicate(const Token& name, int arity) {
    auto& all = program_.predicates;
    for (int p = 0; p < std::ssize(all); ++p) {
      if (all[p].name != name.text) continue;
      if (all[p].arity == arity) return p;
      throw Error("predicate '" + all[p].name + "' with " + std::to_string(arity) +
                      " and, in line " + std::to_string(all[p].line) + ", with " +
                      std::to_string(all[p].arity) + " places",
                  program_.where + ":" + std::to_string(name.line), "one number of places");
    }
    all.push_back({std::string(name.text), arity, name.line});
    return static_cast<int>(all.size()) - 1;
  }

  static int number_of(std::vector<std::string>& texts, std::string text) {
    const auto found = std::find(texts.begin(), texts.end(), text);
    const int number = static_cast<int>(found - texts.begin());
    if (found == texts.end()) texts.push_back(std::move(text));
    return number;
  }

  /// Variables of the head and of `not` stand in a literal that holds; those of `atom for all
  /// condition` there or, if nowhere else, in the condition.
  void require_safe(const Rule& rule) const {
    std::vector<bool> bound(rule.variables.size());
    for (const RuleLiteral& literal : rule.body)
      if (literal.kind == RuleLiteral::Kind::holds) mark(literal.atom, bound);
    for (const RuleTerm& term : used(rule.head))
      if (term.kind == RuleTerm::Kind::any)
        fail("'_' in the head of a rule", "variables, constants");
    require_bound(rule, rule.head, bound);
    for (const RuleLiteral& literal : rule.body) {
      std::vector<bool> here = bound;
      if (literal.kind == RuleLiteral::Kind::for_all) mark(literal.condition, here);
      require_bound(rule, literal.atom, here);
      if (literal.kind == RuleLiteral::Kind::for_all) require_local(rule, literal, bound);
    }
  }

  /// A variable that only conditions bind means something else in each: it stands in one literal.
  void require_local(const Rule& rule, const RuleLiteral& literal,
                     const std::vector<bool>& bound) const {
    for (const RuleTerm& term : used(literal.condition)) {
      if (term.kind != RuleTerm::Kind::variable || bound[term.index]) continue;
      for (const RuleLiteral& other : rule.body) {
        if (&other == &literal || other.kind != RuleLiteral::Kind::for_all) continue;
        for (const RuleTerm& also : used(other.condition))
          if (also == term)
            fail("variable '" + rule.variables[term.index] + "' in two 'for all'",
                 "a name for each");
      }
    }
  }

  void require_bound(const Rule& rule, const Atom& atom, const std::vector<bool>& bound) const {
    for (const RuleTerm& term : used(atom))
      if (term.kind == RuleTerm::Kind::variable && !bound[term.index])
        throw Error("unsafe variable '" + rule.variables[term.index] + "' of '" +
                        program_.predicates[atom.predicate].name + "'",
                    program_.where + ":" + std::to_string(rule.line),
                    "variables that stand in a literal of the body without 'not'");
  }

  [[nodiscard]] std::vector<RuleTerm> used(const Atom& atom) const {
    return {atom.places.begin(), atom.places.begin() + program_.predicates[atom.predicate].arity};
  }

  void mark(const Atom& atom, std::vector<bool>& bound) const {
    for (const RuleTerm& term : used(atom))
      if (term.kind == RuleTerm::Kind::variable) bound[term.index] = true;
  }

  RuleWords words_;
  RuleProgram program_;
  Token token_;
};

}  // namespace

RuleProgram parse_rules(std::string_view text, const std::string& where) {
  if (text.size() > kMostBytes)
    throw Error("rules of " + std::to_string(text.size()) + " bytes", where,
                "at most " + std::to_string(kMostBytes));
  RuleProgram program = RuleParser(text, where).program();
  order_into_strata(program);
  return program;
}

}  // namespace geoprior::embryo
