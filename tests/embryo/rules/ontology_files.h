#pragma once

#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "solvers/embryo/rules/closure.h"
#include "solvers/embryo/triples/read.h"

namespace geoprior::embryo::test {

inline std::string bytes_of(const std::string& file) {
  std::ifstream in(GEOPRIOR_SOURCE_DIR "/" + file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Triples in Turtle behind the prefixes of our files.
inline Graph small_graph(const std::string& turtle) {
  return read_graph(
      "@prefix e: <urn:geoprior:embryo#> .\n"
      "@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n" +
          turtle,
      RdfFormat::turtle, "small.ttl");
}

inline Graph urinary_graph() {
  return read_graph(bytes_of("experiments/embryo/urinary.ttl"), RdfFormat::turtle, "urinary.ttl");
}

inline RuleProgram development_rules() {
  return parse_rules(bytes_of("experiments/embryo/development.rules"), "development.rules");
}

inline Facts developed(const Graph& graph, const std::optional<std::string>& disease = {},
                       const std::string& parameter_set = "Ascent") {
  return saturate(development_rules(), base_facts(graph, {disease, parameter_set}));
}

/// The healthy case, and every disease of a graph.
inline std::vector<std::optional<std::string>> cases_of(const Graph& graph) {
  std::vector<std::optional<std::string>> cases{std::nullopt};
  const Dictionary& terms = graph.dictionary();
  const auto type = terms.find_iri(std::string(kRdf) + "type"),
             disease = terms.find_local("Disease");
  for (const Term term : graph.subjects(*type, *disease))
    cases.emplace_back(terms.local_name(term));
  return cases;
}

}  // namespace geoprior::embryo::test
