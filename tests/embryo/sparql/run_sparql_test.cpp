#include "experiments/embryo/sparql/run_sparql.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "experiments/embryo/sparql/answers.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::embryo {
namespace {

using geoprior::test::expect_error;
using ::testing::HasSubstr;

const std::string kTwoTriples =
    "<urn:a> <urn:p> \"1.50\"^^<http://www.w3.org/2001/XMLSchema#decimal> .\n"
    "<urn:a> <urn:q> _:node7 .\n";

std::string answer_of(const std::string& query, const SparqlOptions& options = {}) {
  return run_sparql(kTwoTriples, std::array{SparqlQuery{query, "my.rq"}}, options).front();
}

TEST(Sparql, AnswersSeveralQueriesInTheWordsOfTheGraph) {
  const std::array<SparqlQuery, 3> queries{
      {{"SELECT ?o WHERE { ?s ?p ?o } ORDER BY ?p", "1.rq"},
       {"ASK { <urn:a> <urn:p> 1.50 }", "2.rq"},
       {"CONSTRUCT { ?o <urn:of> ?s } WHERE { ?s <urn:q> ?o }", "3.rq"}}};
  EXPECT_THAT(run_sparql(kTwoTriples, queries, {}),
              ::testing::ElementsAre("o\n1.50\n_:node7\n", "boolean\ntrue\n",
                                     "subject,predicate,object\n_:node7,urn:of,urn:a\n"));
}

TEST(Sparql, NamesThePlaceOfASyntaxError) {
  expect_error([] { (void)answer_of("SELECT *\nWHERE { ?s ?p ?o ?x }"); },
               {"my.rq:2:", "syntax error", "SPARQL 1.1"});
}

TEST(Sparql, NamesThePackageThatIsAbsent) {
  const char* before = std::getenv("GEOPRIOR_PYTHON");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("GEOPRIOR_PYTHON", "/nowhere/python3", 1);
  expect_error([] { (void)answer_of("ASK {}"); }, {"no Python with rdflib", "python3-rdflib"});
  if (before != nullptr)
    ::setenv("GEOPRIOR_PYTHON", kept.c_str(), 1);
  else
    ::unsetenv("GEOPRIOR_PYTHON");
}

TEST(LongSparql, RefusesWhateverLeavesTheGraph) {
  for (const auto& [query, reason] : std::vector<std::pair<std::string, std::string>>{
           {"SELECT * { SERVICE <http://localhost/> { ?s ?p ?o } }", "SERVICE"},
           {"ASK { OPTIONAL { SERVICE SILENT <http://localhost/> { ?s ?p ?o } } }", "SERVICE"},
           {"SELECT * { FILTER EXISTS { SERVICE <http://localhost/> { ?s ?p ?o } } }", "SERVICE"},
           {"SELECT * { { SELECT * { SERVICE <http://localhost/> { ?s ?p ?o } } } }", "SERVICE"},
           {"SELECT * FROM <file:///etc/passwd> { ?s ?p ?o }", "FROM"},
           {"ASK FROM NAMED <file:///etc/passwd> { GRAPH ?g { ?s ?p ?o } }", "FROM"},
           {"LOAD <file:///etc/passwd>", "update"},
           {"DELETE WHERE { ?s ?p ?o }", "update"},
           {"DESCRIBE <urn:a>", "DESCRIBE"}}) {
    SCOPED_TRACE(query);
    expect_error([&, text = query] { (void)answer_of(text); }, {"my.rq", reason});
  }
}

TEST(LongSparql, EndsAtItsTimeLimit) {
  std::string product = "SELECT (COUNT(*) AS ?n) {";
  for (int i = 0; i < 40; ++i)
    product +=
        " ?s" + std::to_string(i) + " ?p" + std::to_string(i) + " ?o" + std::to_string(i) + " .";
  expect_error([&] { (void)answer_of(product + " }", {.timeout_s = 2}); },
               {"my.rq", "takes longer than 2 s", "timeout_s"});
}

TEST(LongSparql, EndsAtItsMemoryLimit) {
  // A text that doubles thirty times.
  std::string doubling = "SELECT ?x30 { BIND (\"0123456789\" AS ?x0)";
  for (int i = 0; i < 30; ++i) {
    const std::string x = "?x" + std::to_string(i);
    doubling += " BIND (CONCAT(" + x + ", " + x + ") AS ?x" + std::to_string(i + 1) + ")";
  }
  expect_error([&] { (void)answer_of(doubling + " }", {.memory_mb = 300}); },
               {"my.rq", "takes more than 300 MB", "memory_mb"});
}

TEST(LongSparql, GivesResultsJson) {
  const std::string json =
      answer_of("SELECT ?o { ?s <urn:p> ?o }", {.format = SparqlOptions::Format::json});
  EXPECT_THAT(json, HasSubstr("\"vars\""));
  EXPECT_THAT(json, HasSubstr("\"value\": \"1.50\""));
  EXPECT_THAT(json, HasSubstr("http://www.w3.org/2001/XMLSchema#decimal"));
}

TEST(LongSparql, NamesWhatTheEngineRefuses) {
  expect_error([] { (void)answer_of("SELECT * { ?s no:prefix ?o }"); }, {"my.rq", "no"});
  expect_error([] { (void)answer_of("SELECT * { GRAPH <urn:g> { ?s ?p ?o } }"); }, {"my.rq"});
  std::string deep = "ASK " + std::string(2000, '{') + std::string(2000, '}');
  expect_error([&] { (void)answer_of(deep); }, {"my.rq", "too deeply"});
}

TEST(SparqlAnswers, AreReadFromCsv) {
  const auto rows = sorted_csv_rows("a,b\nz,\"x, \"\"y\"\"\nline\"\n,2\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"", "2"}));
  EXPECT_EQ(rows[1], (std::vector<std::string>{"z", "x, \"y\"\nline"}));
}

TEST(SparqlAnswers, AreToTheQuestionThatIsPutIn) {
  const ViewerQuestion question{.day = 39.5, .structure = "Aorta", .system = "Body"};
  EXPECT_EQ(with_question("BIND (44.0 AS ?day)", question), "BIND (39.5 AS ?day)");
  EXPECT_EQ(with_question("BIND (44.0 AS ?day)", {.day = 58}), "BIND (58.0 AS ?day)");
  EXPECT_EQ(with_question("VALUES ?structure { e:A } VALUES ?system { e:B }", question),
            "VALUES ?structure { e:Aorta } VALUES ?system { e:Body }");
  EXPECT_EQ(with_question("ASK {}", question), "ASK {}");
}

}  // namespace
}  // namespace geoprior::embryo
