// The closure against answer-set programming: gringo and clasp on development.lp, which was written
// by hand and reads the triples of the ontology.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "experiments/embryo/sparql/scratch_folder.h"
#include "testbed/view/child_process.h"
#include "tests/embryo/rules/ontology_files.h"

namespace geoprior::embryo {
namespace {

using AtomTexts = std::map<std::string, std::set<std::string>>;

/// Our predicates and those of the answer-set program that mean the same.
const std::map<std::string, std::string> kSameMeaning = {
    {"below", "subClassOf"}, {"is_a", "instance"},      {"inside", "partOf"},
    {"from_it", "ancestor"}, {"off", "inactive"},       {"lacking", "absent"},
    {"on", "active"},        {"there", "exists"},       {"whole", "persists"},
    {"half", "halfOf"},      {"held_by", "anchoredOn"}, {"loose", "freeEnd"}};

/// "e:Name", "rdf:type", "_:label" or the text of another term, without quotation marks.
std::string asp_name(const Dictionary& terms, Term term) {
  if (terms.kind(term) == Dictionary::Kind::blank) return "_:" + terms.text(term);
  std::string text = terms.text(term);
  for (const auto& [prefix, iri] : std::map<std::string, std::string_view>{
           {"e:", kNamespace}, {"rdf:", kRdf}, {"rdfs:", kRdfs}})
    if (terms.kind(term) == Dictionary::Kind::iri && text.starts_with(iri))
      text = prefix + text.substr(iri.size());
  std::string plain;
  for (const char c : text) plain += c == '"' || c == '\\' || c == '\n' ? '?' : c;
  return plain;
}

std::string asp_facts(const Graph& graph, const std::optional<std::string>& disease,
                      const std::string& parameter_set) {
  const Dictionary& terms = graph.dictionary();
  std::ostringstream out;
  for (const Triple& t : graph.triples()) {
    const std::string subject = asp_name(terms, t.subject), property = asp_name(terms, t.predicate),
                      object = asp_name(terms, t.object);
    out << "t(\"" << subject << "\",\"" << property << "\",\"" << object << "\").\n";
    if (property == "e:order") out << "order(\"" << subject << "\"," << object << ").\n";
  }
  out << "chosen(\"e:" << parameter_set << "\").\n";
  if (disease) out << "disease(\"e:" << *disease << "\").\n";
  return out.str();
}

/// The atoms of the one answer set: the line behind "Answer: 1".
AtomTexts atoms_of(const std::string& output) {
  AtomTexts atoms;
  const std::size_t answer = output.find("Answer: 1\n");
  if (answer == std::string::npos) return atoms;
  std::istringstream line(output.substr(answer + 10, output.find('\n', answer + 10) - answer - 10));
  for (std::string atom; line >> atom;) {
    const std::size_t open = atom.find('(');
    atoms[atom.substr(0, open)].insert(atom.substr(open + 1, atom.size() - open - 2));
  }
  return atoms;
}

AtomTexts solve(const std::string& facts) {
  const ScratchFolder scratch;
  const std::string file = (scratch.path() / "facts.lp").string(),
                    out = (scratch.path() / "answer").string();
  std::ofstream(file) << facts;
  const ChildResult result =
      run_child({"/bin/sh", "-c", "gringo \"$0\" \"$1\" | clasp 2 > \"$2\"",
                 GEOPRIOR_SOURCE_DIR "/tests/embryo/oracles/development.lp", file, out});
  std::ostringstream text;
  text << std::ifstream(out).rdbuf();
  // 30: satisfiable, and all of at most two answer sets were found.
  EXPECT_EQ(result.exit_code, 30) << result.errors;
  EXPECT_EQ(text.str().find("Answer: 2"), std::string::npos);
  return atoms_of(text.str());
}

AtomTexts closure_atoms(const Facts& facts) {
  AtomTexts atoms;
  for (const auto& [theirs, ours] : kSameMeaning) {
    for (const Fact& fact : facts.tuples(ours)) {
      std::string text = "\"" + asp_name(facts.dictionary(), fact[0]) + "\"";
      if (fact[1] >= 0) text += ",\"" + asp_name(facts.dictionary(), fact[1]) + "\"";
      atoms[theirs].insert(text);
    }
  }
  for (const Fact& fact : facts.tuples("upto"))  // S up to T: T is not before S
    atoms["not_before"].insert("\"" + asp_name(facts.dictionary(), fact[1]) + "\",\"" +
                               asp_name(facts.dictionary(), fact[0]) + "\"");
  return atoms;
}

void expect_closure_of_gringo(const Graph& graph, const std::optional<std::string>& disease,
                              const std::string& parameter_set) {
  SCOPED_TRACE(disease.value_or("healthy") + ", " + parameter_set);
  const AtomTexts theirs = solve(asp_facts(graph, disease, parameter_set));
  const AtomTexts ours = closure_atoms(test::developed(graph, disease, parameter_set));
  for (const auto& [name, atoms] : ours) {
    const auto found = theirs.find(name);
    EXPECT_EQ(atoms, found == theirs.end() ? std::set<std::string>() : found->second) << name;
  }
  for (const auto& [name, atoms] : theirs) EXPECT_TRUE(ours.contains(name)) << name;
}

TEST(LongClosure, IsThatOfGringoAndClaspUnderEveryDisease) {
  if (!find_program("gringo") || !find_program("clasp"))
    GTEST_SKIP() << "apt-get install gringo clasp";
  const Graph graph = test::urinary_graph();
  int cases = 0;
  for (const auto& disease : test::cases_of(graph)) {
    expect_closure_of_gringo(graph, disease, "Ascent");
    ++cases;
  }
  EXPECT_EQ(cases, 10);
  expect_closure_of_gringo(graph, "PelvicKidneyLeft", "Elongation");
}

// What our ontology has not: several makers, several progenitors, a deep chain of requirements.
TEST(LongClosure, IsThatOfGringoAndClaspOnTangledProcesses) {
  if (!find_program("gringo") || !find_program("clasp"))
    GTEST_SKIP() << "apt-get install gringo clasp";
  const Graph graph = test::small_graph(
      "e:S1 a e:TemporalEntity ; e:order 1 . e:S2 a e:TemporalEntity ; e:order 2 .\n"
      "e:A e:existsFrom e:S1 ; e:existsUntil e:S2 . e:B e:existsFrom e:S1 ; e:existsUntil e:S1 .\n"
      "e:P a e:Growth ; e:produces e:A , e:B . e:Q a e:Growth ; e:produces e:B ; e:requires e:R .\n"
      "e:R a e:Migration ; e:actsOn e:A , e:C . e:C e:developsFrom e:A . e:E e:developsFrom e:A , "
      "e:B .\n"
      "e:E e:partOf e:F . e:F e:partOf e:G . e:G e:partOf e:H . e:H e:partOf e:I .\n"
      "e:X a e:Division ; e:actsOn e:A , e:B ; e:requires e:P . e:Y a e:Interaction ; e:fuses e:A "
      ", e:B .\n"
      "e:K e:of e:E ; e:geometry [ a e:Duct ; e:startsOn e:A ; e:endPoint (0 0 0) ] .\n"
      "e:Sub rdfs:subClassOf e:Growth . e:U a e:Sub . e:D a e:Disease ; e:disables e:P .");
  for (const auto& disease : test::cases_of(graph))
    expect_closure_of_gringo(graph, disease, "None");
}

}  // namespace
}  // namespace geoprior::embryo
