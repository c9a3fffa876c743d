#include "solvers/embryo/triples/graph.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/random.h"

namespace geoprior::embryo {
namespace {

TEST(Dictionary, GivesEqualTermsOneNumber) {
  Dictionary terms;
  const Term iri = terms.iri("urn:a");
  EXPECT_EQ(terms.iri("urn:a"), iri);
  EXPECT_NE(terms.blank("urn:a"), iri);
  EXPECT_NE(terms.literal("urn:a"), iri);
  EXPECT_EQ(terms.size(), 3);
  EXPECT_EQ(terms.find_iri("urn:a"), iri);
  EXPECT_EQ(terms.find_iri("urn:b"), std::nullopt);
}

TEST(Dictionary, TellsLiteralsApartByDatatypeAndLanguage) {
  Dictionary terms;
  const std::string integer = std::string(kXsd) + "integer";
  const std::set<Term> numbers = {terms.literal("1"), terms.literal("1", integer),
                                  terms.literal("1", {}, "de"), terms.literal("1", {}, "en")};
  EXPECT_EQ(numbers.size(), 4u);
  EXPECT_EQ(terms.literal("1", std::string(kXsd) + "string"), terms.literal("1"));
  EXPECT_EQ(terms.literal("1", {}, "DE"), terms.literal("1", {}, "de"));
  EXPECT_EQ(terms.datatype(terms.literal("1", integer)), integer);
  EXPECT_EQ(terms.language(terms.literal("1", {}, "de")), "de");
}

TEST(Dictionary, KeepsManyTermsApart) {
  Dictionary terms;
  for (int i = 0; i < 20000; ++i) EXPECT_EQ(terms.iri("urn:x" + std::to_string(i)), i);
  const Dictionary copy = terms;
  terms.iri("urn:more");
  for (int i = 0; i < 20000; ++i) EXPECT_EQ(copy.find_iri("urn:x" + std::to_string(i)), i);
  EXPECT_FALSE(copy.find_iri("urn:more"));
}

TEST(Dictionary, CutsLocalNamesBehindTheNamespace) {
  Dictionary terms;
  EXPECT_EQ(terms.local_name(terms.iri(std::string(kNamespace) + "Kidney")), "Kidney");
  EXPECT_EQ(terms.local_name(terms.iri("http://a.org/b/c")), "c");
  EXPECT_EQ(terms.local_name(terms.blank("b1")), "_:b1");
  EXPECT_TRUE(terms.is_ours(*terms.find_local("Kidney")));
}

/// Triples over a few terms, so that many are equal.
Graph graph_of_random_triples(int triples, int terms, std::vector<Triple>& added) {
  Graph graph;
  for (int i = 0; i < terms; ++i) graph.dictionary().iri("urn:" + std::to_string(i));
  RandomStream random(7, "graph");
  for (int i = 0; i < triples; ++i) {
    const auto draw = [&] { return static_cast<Term>(random.uniform() * terms); };
    added.push_back({draw(), draw() % 5, draw(), i + 1});
    graph.add(added.back());
  }
  graph.sort();
  return graph;
}

TEST(Graph, AnswersAsAWalkOverAllTriplesDoes) {
  std::vector<Triple> added;
  const Graph graph = graph_of_random_triples(600, 20, added);
  std::set<std::vector<Term>> all;
  for (const Triple& t : added) all.insert({t.subject, t.predicate, t.object});
  EXPECT_EQ(graph.size(), static_cast<int>(all.size()));
  for (Term a = 0; a < 20; ++a) {
    for (Term p = 0; p < 20; ++p) {
      std::set<Term> objects, subjects;
      for (const auto& t : all) {
        if (t[0] == a && t[1] == p) objects.insert(t[2]);
        if (t[2] == a && t[1] == p) subjects.insert(t[0]);
      }
      const TermRange found_objects = graph.objects(a, p), found_subjects = graph.subjects(p, a);
      EXPECT_EQ(std::vector<Term>(found_objects.begin(), found_objects.end()),
                std::vector<Term>(objects.begin(), objects.end()));
      EXPECT_EQ(std::vector<Term>(found_subjects.begin(), found_subjects.end()),
                std::vector<Term>(subjects.begin(), subjects.end()));
    }
  }
}

TEST(Graph, KeepsTheFirstLineOfARepeatedTriple) {
  Graph graph;
  const Term a = graph.dictionary().iri("urn:a"), p = graph.dictionary().iri("urn:p");
  graph.add(a, p, a, 9);
  graph.add(a, p, a, 4);
  graph.add(a, p, a, 0);
  graph.sort();
  ASSERT_EQ(graph.size(), 1);
  EXPECT_EQ(graph.line_of(a, p), 4);
  EXPECT_EQ(graph.line_of(p, p), 0);
}

TEST(Graph, GivesItsTriplesBySubjectOrByPredicate) {
  std::vector<Triple> added;
  const Graph graph = graph_of_random_triples(300, 12, added);
  const auto all = graph.triples();
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const Triple& a, const Triple& b) {
    return std::tie(a.subject, a.predicate, a.object) < std::tie(b.subject, b.predicate, b.object);
  }));
  int count = 0;
  for (Term p = 0; p < 12; ++p) {
    for (const Triple& t : graph.with_predicate(p)) count += t.predicate == p ? 1 : 1000;
  }
  EXPECT_EQ(count, graph.size());
}

TEST(Graph, RefusesQueriesBetweenAddAndSort) {
  Graph graph;
  const Term a = graph.dictionary().iri("urn:a");
  graph.add(a, a, a);
  EXPECT_THROW((void)graph.objects(a, a), Error);
  graph.sort();
  EXPECT_TRUE(graph.contains(a, a, a));
  EXPECT_THROW(graph.add(a, a, 1), Error);
}

TEST(Graph, AnswersForTermsThatWereAddedAfterTheSort) {
  Graph graph;
  const Term a = graph.dictionary().iri("urn:a");
  graph.add(a, a, a);
  graph.sort();
  const Term later = graph.dictionary().iri("urn:later");
  EXPECT_TRUE(graph.objects(later, a).empty());
  EXPECT_TRUE(graph.subjects(later, a).empty());
}

}  // namespace
}  // namespace geoprior::embryo
