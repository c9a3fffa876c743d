// What docs/methods/embryo.md quotes of the ontology and of the table in C++, counted anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "experiments/embryo/scene/scene.h"
#include "solvers/embryo/queries/queries.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/home.h"

namespace geoprior::embryo {
namespace {

std::string page_block(const std::string& name) {
  const std::string page = read_text_file(geoprior_home() / "docs/methods/embryo.md");
  const std::string begin = "<!-- counted: " + name + " -->\n", end = "<!-- end of count -->";
  const std::size_t from = page.find(begin);
  if (from == std::string::npos) return "there is no block " + begin;
  return page.substr(from + begin.size(), page.find(end, from) - from - begin.size());
}

std::shared_ptr<EmbryoScene> our_scene() {
  return load_embryo_scene({}, geoprior_home() / "experiments/embryo");
}

std::string literal_of(const Graph& graph, Term subject, std::string_view property) {
  const auto p = graph.dictionary().find_iri(std::string(kRdfs) + std::string(property));
  const auto found = p ? graph.object(subject, *p) : std::nullopt;
  return found ? graph.dictionary().text(*found) : "";
}

TEST(EmbryoPage, NumbersOfEachSourceAreThoseOfTheOntology) {
  const auto scene = our_scene();
  const ViewerQueries queries(scene->graph);
  std::map<Term, std::pair<int, std::set<std::string>>> counts;
  for (const SourcedNumber& one : queries.numbers()) {
    if (one.source < 0) continue;
    auto& [count, properties] = counts[one.source];
    ++count;
    properties.insert(scene->graph.dictionary().local_name(one.property));
  }
  std::vector<std::string> rows;
  for (const auto& [source, counted] : counts) {
    std::string row = "| " + literal_of(scene->graph, source, "label") + " | " +
                      std::to_string(counted.first) + " |";
    for (const std::string& property : counted.second)
      row += (property == *counted.second.begin() ? " `" : ", `") + property + "`";
    rows.push_back(row + " |\n");
  }
  std::sort(rows.begin(), rows.end());
  std::string text = "| source | numbers | properties |\n|---|---:|---|\n";
  for (const std::string& row : rows) text += row;
  EXPECT_EQ(page_block("sources"), text);
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

TEST(EmbryoPage, MeasurementsAreThoseOfTheOntology) {
  const auto scene = our_scene();
  std::string text =
      "| quantity | of | at | range | unit | source | input of |\n|---|---|---|---|---|---|---|\n";
  for (const Measurement& one : scene->ontology.measurements) {
    const Stage& stage = scene->ontology.stages[one.stage];
    const double scale = one.unit == "m" ? 1e3 : one.unit == "rad" ? 180 / 3.14159265358979 : 1;
    const std::string unit = one.unit == "m" ? "mm" : one.unit == "rad" ? "deg" : "1";
    std::string inputs;
    for (const std::string& set : one.input_of) inputs += (inputs.empty() ? "" : ", ") + set;
    text += "| " + one.quantity + " | " +
            (one.structure ? scene->ontology.structures[*one.structure].name : "") + " | " +
            stage.name + " | " + number(one.low * scale) + " to " + number(one.high * scale) +
            " | " + unit + " | " + one.source + " | " + inputs + " |\n";
  }
  EXPECT_EQ(page_block("measurements"), text);
}

/// Lines of code between a marker of a disease and its end, without blank ones and comments.
int lines_of(const std::string& source, const std::string& disease) {
  const std::string begin = "// disease: " + disease + "\n";
  const std::size_t from = source.find(begin);
  if (from == std::string::npos) return -1;
  int count = 0;
  for (std::size_t at = from + begin.size(); at < source.size();) {
    const std::size_t end = source.find('\n', at);
    std::string line = source.substr(at, end - at);
    at = end + 1;
    line.erase(0, line.find_first_not_of(' '));
    if (line.starts_with("// end")) break;
    if (!line.empty() && !line.starts_with("//")) ++count;
  }
  return count;
}

TEST(EmbryoPage, EffortIsCountedInTriplesAndInLines) {
  const auto scene = our_scene();
  const std::string source = read_text_file(geoprior_home() / "baselines/embryo/direct_table.cpp");
  const std::array<std::array<const char*, 2>, 3> kDiseases{
      {{"RenalAgenesisLeft", "renal-agenesis-left"},
       {"HorseshoeKidney", "horseshoe-kidney"},
       {"PersistentCloaca", "persistent-cloaca"}}};
  std::string text =
      "| disease | triples of the ontology | lines of the table in C++ |\n|---|---:|---:|\n";
  for (const auto& [name, marker] : kDiseases) {
    const auto term = scene->graph.dictionary().find_local(name);
    ASSERT_TRUE(term);
    const int lines = lines_of(source, marker);
    ASSERT_GT(lines, 0) << marker;
    text += "| " + std::string(name) + " | " +
            std::to_string(scene->graph.of_subject(*term).size()) + " | " + std::to_string(lines) +
            " |\n";
  }
  EXPECT_EQ(page_block("effort"), text);
}

}  // namespace
}  // namespace geoprior::embryo
