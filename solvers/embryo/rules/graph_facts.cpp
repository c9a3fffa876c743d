#include "solvers/embryo/rules/graph_facts.h"

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

constexpr std::string_view kType = "type", kSubClass = "subClassOf";

/// Classes of the vocabulary below another one: a file need not say so.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kClasses = {
    {{"Point", "GeometricalComponent"},
     {"Line", "GeometricalComponent"},
     {"Plane", "GeometricalComponent"},
     {"Ovoid", "GeometricalComponent"},
     {"Cylinder", "GeometricalComponent"},
     {"Duct", "GeometricalComponent"},
     {"Growth", "Process"},
     {"Migration", "Process"},
     {"Rotation", "Process"},
     {"Interaction", "Process"},
     {"Division", "Process"},
     {"Fixation", "Process"}}};

std::string ours(std::string_view local) { return std::string(kNamespace) + std::string(local); }
// Appended: GCC 12 takes a sum of short texts for an overflow (GCC bug 105651).
std::string iri_of(std::string_view prefix, std::string_view name) {
  std::string out(prefix);
  out += name;
  return out;
}

std::string rdf_type() { return iri_of(kRdf, "type"); }
std::string rdfs_sub_class() { return iri_of(kRdfs, "subClassOf"); }

/// By term: whether it is of parameter sets, but not of the chosen one.
std::vector<bool> things_of_other_sets(const Graph& graph, const std::string& chosen) {
  const Dictionary& terms = graph.dictionary();
  std::vector<bool> other(terms.size());
  const auto in_set = terms.find_local("inSet");
  if (!in_set) return other;
  const auto set = terms.find_local(chosen);
  for (const Triple& triple : graph.with_predicate(*in_set))
    other[triple.subject] = !set || !graph.contains(triple.subject, *in_set, *set);
  return other;
}

/// Name of the facts that a predicate gives; empty: none.
std::string fact_name(const Dictionary& terms, Term predicate) {
  if (terms.is_ours(predicate)) return terms.local_name(predicate);
  if (terms.text(predicate) == rdf_type()) return std::string(kType);
  return terms.text(predicate) == rdfs_sub_class() ? std::string(kSubClass) : std::string();
}

bool is_true(const Dictionary& terms, Term term) {
  const std::string& text = terms.text(term);
  return (text == "true" || text == "1") && terms.datatype(term) == std::string(kXsd) + "boolean";
}

void add_stated_facts(const Graph& graph, const std::string& parameter_set, Facts& facts) {
  const Dictionary& terms = graph.dictionary();
  const std::vector<bool> of_other_set = things_of_other_sets(graph, parameter_set);
  constexpr int kUnknown = -1, kNone = -2;
  struct Numbers {
    int of_two = kUnknown, of_one = kUnknown;
  };
  std::vector<Numbers> numbers(terms.size());
  for (const Triple& triple : graph.triples()) {
    const bool is_literal = terms.kind(triple.object) == Dictionary::Kind::literal;
    int& number = is_literal ? numbers[triple.predicate].of_one : numbers[triple.predicate].of_two;
    if (number == kNone || of_other_set[triple.subject] || of_other_set[triple.object]) continue;
    if (is_literal && !is_true(terms, triple.object)) continue;
    if (number == kUnknown) {
      const std::string name = fact_name(terms, triple.predicate);
      number = name.empty() ? kNone : facts.predicate(name, is_literal ? 1 : 2);
      if (number == kNone) continue;
    }
    facts.relation(number).add({triple.subject, is_literal ? -1 : triple.object});
  }
}

/// Temporal entities by their order.
std::vector<Term> ordered_stages(const Graph& graph) {
  const Dictionary& terms = graph.dictionary();
  const auto type = terms.find_iri(rdf_type()), stage = terms.find_local("TemporalEntity"),
             order = terms.find_local("order");
  if (!type || !stage || !order) return {};
  std::vector<std::pair<int, Term>> found;
  for (const Term term : graph.subjects(*type, *stage)) {
    const auto given = graph.object(term, *order);
    if (!given) continue;
    const std::string& text = terms.text(*given);
    int number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    found.emplace_back(number, term);
  }
  std::sort(found.begin(), found.end());
  std::vector<Term> stages;
  for (const auto& [number, term] : found) stages.push_back(term);
  return stages;
}

Term disease_term(const Graph& graph, const std::string& name) {
  const Dictionary& terms = graph.dictionary();
  const auto type = terms.find_iri(rdf_type()), disease = terms.find_local("Disease"),
             term = terms.find_local(name);
  if (type && disease && term && graph.contains(*term, *type, *disease)) return *term;
  std::string known;
  if (type && disease)
    for (const Term one : graph.subjects(*type, *disease))
      known += (known.empty() ? "" : ", ") + terms.local_name(one);
  throw Error("no disease '" + name + "'", "the ontology", known.empty() ? "none" : known);
}

/// A predicate that names facts, as a term of the graph: the inverse of `fact_name`.
Term predicate_term(Dictionary& terms, const std::string& name) {
  if (name == kType) return terms.iri(rdf_type());
  return terms.iri(name == kSubClass ? rdfs_sub_class() : ours(name));
}

/// "absent" names the class Absent.
Term class_term(Dictionary& terms, std::string name) {
  if (name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return terms.iri(ours(name));
}

}  // namespace

Facts base_facts(const Graph& graph, const FactSelection& selection) {
  auto terms = std::make_shared<Dictionary>(graph.dictionary());
  std::vector<Fact> classes;
  for (const auto& [below, above] : kClasses)
    classes.push_back({terms->iri(ours(below)), terms->iri(ours(above))});
  Facts facts(std::move(terms));
  for (const Fact& pair : classes) facts.add(kSubClass, pair[0], pair[1]);
  add_stated_facts(graph, selection.parameter_set, facts);
  const std::vector<Term> stages = ordered_stages(graph);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    facts.add("stage", stages[i]);
    if (i > 0) facts.add("next", stages[i - 1], stages[i]);
  }
  if (selection.disease) facts.add("selected", disease_term(graph, *selection.disease));
  return facts;
}

Graph saturated_graph(const Graph& graph, const Facts& facts) {
  Graph all = graph;
  Dictionary& terms = all.dictionary();
  // What is new in the dictionary of the facts are IRIs, in the order of their numbers.
  for (Term term = terms.size(); term < facts.dictionary().size(); ++term)
    terms.iri(facts.dictionary().text(term));
  for (int p = 0; p < facts.predicates(); ++p) {
    const Relation& relation = facts.relation(p);
    if (relation.arity() == 2) {
      const Term predicate = predicate_term(terms, facts.name(p));
      for (const Fact& fact : relation.tuples()) all.add(fact[0], predicate, fact[1]);
    } else {
      const Term type = terms.iri(rdf_type()), of_class = class_term(terms, facts.name(p));
      for (const Fact& fact : relation.tuples()) all.add(fact[0], type, of_class);
    }
  }
  all.sort();
  return all;
}

}  // namespace geoprior::embryo
