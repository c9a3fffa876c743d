#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "solvers/embryo/ontology/consistency.h"
#include "solvers/embryo/ontology/read_ontology.h"
#include "solvers/embryo/triples/read.h"

namespace geoprior::embryo::test {

/// A mistake: behind `after`, what begins with `what` and ends with `until` becomes `by`.
struct Plant {
  std::string kind;
  std::string after, what, by;
  std::string until = {};  ///< empty: `what` is all
};

inline std::string planted(std::string text, const Plant& plant) {
  const std::size_t after = text.find(plant.after);
  const std::size_t place = after == std::string::npos ? after : text.find(plant.what, after);
  std::size_t end = place == std::string::npos ? place : place + plant.what.size();
  if (!plant.until.empty() && end != std::string::npos)
    end = text.find(plant.until, end) + plant.until.size();
  if (end == std::string::npos) {
    ADD_FAILURE() << "nothing to plant '" << plant.by << "' at";
    return text;
  }
  return text.replace(place, end - place, plant.by);
}

inline std::vector<Violation> violations_in(const std::string& text) {
  return violations(read_graph(text, RdfFormat::turtle, "planted.ttl"));
}

/// @throws Error  of what is refused
inline Ontology read_ontology(const std::string& text, const OntologySelection& selection = {},
                              Mistakes mistakes = Mistakes::refused) {
  const Graph graph = read_graph(text, RdfFormat::turtle, "small.ttl");
  require_model(graph, violations(graph), mistakes);
  return make_ontology(graph, selection, "small.ttl");
}

inline std::string described(const std::vector<Violation>& found) {
  std::string text;
  for (const Violation& violation : found) {
    text += violation.kind + " in line " + std::to_string(violation.line) + ": " +
            violation.message + "\n";
  }
  return text;
}

/// The mistake is found, on a line, and nothing else.
inline void expect_found_alone(const std::string& text, const Plant& plant) {
  const std::vector<Violation> found = violations_in(planted(text, plant));
  EXPECT_EQ(found.size(), 1u) << plant.kind << ", " << plant.by << "\n" << described(found);
  if (found.empty()) return;
  EXPECT_EQ(found[0].kind, plant.kind) << plant.by << "\n" << described(found);
  EXPECT_FALSE(found[0].subject.empty());
  EXPECT_GT(found[0].line, 0) << described(found);
}

}  // namespace geoprior::embryo::test
