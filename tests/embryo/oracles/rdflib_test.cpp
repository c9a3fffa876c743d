// The viewer's queries against an engine that shares nothing with them: rdflib on the same graph.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "experiments/embryo/sparql/answers.h"
#include "experiments/embryo/sparql/run_sparql.h"
#include "solvers/embryo/queries/rows.h"
#include "tests/embryo/rules/ontology_files.h"

namespace geoprior::embryo {
namespace {

std::vector<SparqlQuery> viewer_queries(const ViewerQuestion& question) {
  std::vector<SparqlQuery> queries;
  for (int q = 1; q <= kViewerQueries; ++q) {
    const std::string file = "experiments/embryo/queries/q" + std::to_string(q) + ".rq";
    queries.push_back({with_question(test::bytes_of(file), question), file});
  }
  return queries;
}

void expect_rows_of_rdflib(const Graph& graph, const ViewerQuestion& question) {
  const ViewerQueries queries(graph);
  const auto answers = run_sparql(to_ntriples(graph), viewer_queries(question), {.timeout_s = 600});
  for (int q = 1; q <= kViewerQueries; ++q)
    EXPECT_EQ(query_rows(queries, q, question), sorted_csv_rows(answers[q - 1])) << "query " << q;
}

/// Healthy and under one disease, each in another parameter set; with GEOPRIOR_LONG, under all.
TEST(LongQueries, HaveTheRowsOfRdflibUnderEveryDisease) {
  const Graph graph = test::urinary_graph();
  const std::vector<ViewerQuestion> questions = {
      {.day = 44, .structure = "LeftMetanephros", .system = "UrinarySystem"},
      {.day = 31, .structure = "Bladder", .system = "Body"},
      {.day = 84, .structure = "LeftRenalPelvis", .system = "UrinarySystem"}};
  auto diseases = test::cases_of(graph);
  EXPECT_EQ(diseases.size(), 10u);
  if (std::getenv("GEOPRIOR_LONG") == nullptr) diseases.resize(2);
  std::size_t turn = 0;
  for (const auto& disease : diseases) {
    SCOPED_TRACE(disease.value_or("healthy"));
    const std::string set = turn % 2 == 0 ? "Ascent" : "Elongation";
    expect_rows_of_rdflib(saturated_graph(graph, test::developed(graph, disease, set)),
                          questions[turn % questions.size()]);
    ++turn;
  }
}

// What Q7 looks for, and a list in a list's place, which ours has not.
TEST(LongQueries, HaveTheRowsOfRdflibOfAnIncompleteOntology) {
  const Graph graph = test::small_graph(
      "e:S1 a e:TemporalEntity ; e:order 1 ; e:startDay 1.0 ; e:endDay 2.5 .\n"
      "e:A a e:EmbryologicalEntity . e:B a e:EmbryologicalEntity ; e:existsFrom e:S1 ; e:partOf "
      "e:C .\n"
      "e:C a e:EmbryologicalEntity . e:K e:of e:B ; e:during e:S1 ; e:geometry [ a e:Point ; "
      "e:position "
      "(0 0 0.0 1e-3) ; e:via ( ) ; e:frame e:A ] .");
  expect_rows_of_rdflib(saturated_graph(graph, test::developed(graph)),
                        {.day = 2.5, .structure = "B", .system = "C"});
}

}  // namespace
}  // namespace geoprior::embryo
