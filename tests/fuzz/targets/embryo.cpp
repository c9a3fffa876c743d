#include <stdexcept>
#include <string>

#include "models/embryo/ontology/ontology.h"
#include "solvers/embryo/ontology/consistency.h"
#include "solvers/embryo/ontology/read_ontology.h"
#include "solvers/embryo/triples/read.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {

namespace {

/// What is read is checked, read as an ontology where it is one, and written: the same triples must
/// come back.
void fuzz_graph(std::string_view text, embryo::RdfFormat format) {
  allow_error([&] {
    const embryo::Graph graph = embryo::read_graph(text, format, "fuzz");
    allow_error([&] {
      embryo::require_model(graph, embryo::violations(graph), embryo::Mistakes::counted);
      embryo::make_ontology(graph, {.parameter_set = "Slow", .stage_shift = 1}, "fuzz");
    });
    const std::string written = embryo::to_ntriples(graph);
    int again = -1;
    allow_error(
        [&] { again = embryo::read_graph(written, embryo::RdfFormat::ntriples, "fuzz").size(); });
    if (again != graph.size())
      throw std::logic_error(std::to_string(graph.size()) + " triples, written and read again " +
                             std::to_string(again) + ":\n" + written);
  });
}

}  // namespace

void fuzz_turtle(const std::uint8_t* data, std::size_t size) {
  fuzz_graph(text_of(data, size), embryo::RdfFormat::turtle);
}

void fuzz_ntriples(const std::uint8_t* data, std::size_t size) {
  fuzz_graph(text_of(data, size), embryo::RdfFormat::ntriples);
}

void fuzz_rdfxml(const std::uint8_t* data, std::size_t size) {
  fuzz_graph(text_of(data, size), embryo::RdfFormat::rdfxml);
}

}  // namespace geoprior::test
