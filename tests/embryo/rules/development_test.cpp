// experiments/embryo/development.rules on ontologies of a few lines, whose consequences are counted
// by hand.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "solvers/embryo/rules/closure.h"
#include "tests/embryo/rules/ontology_files.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::embryo {
namespace {

using geoprior::test::expect_error;
using test::developed;
using test::small_graph;
using Names = std::set<std::string>;

Names names_in(const Facts& facts, const std::string& predicate) {
  Names names;
  for (const Fact& fact : facts.tuples(predicate)) {
    const std::string first = facts.dictionary().local_name(fact[0]);
    names.insert(fact[1] < 0 ? first : first + "-" + facts.dictionary().local_name(fact[1]));
  }
  return names;
}

Names stages_of(const Facts& facts, const std::string& structure) {
  Names stages;
  for (const std::string& pair : names_in(facts, "exists"))
    if (pair.starts_with(structure + "-")) stages.insert(pair.substr(structure.size() + 1));
  return stages;
}

const std::string kStages =
    "e:S3 a e:TemporalEntity ; e:order 3 . e:S1 a e:TemporalEntity ; e:order 1 .\n"
    "e:S2 a e:TemporalEntity ; e:order 2 . e:S10 a e:TemporalEntity ; e:order 10 .\n";

TEST(DevelopmentRules, OrderStagesByNumber) {
  const Facts all = developed(small_graph(kStages));
  EXPECT_EQ(names_in(all, "next"), (Names{"S1-S2", "S2-S3", "S3-S10"}));
  EXPECT_EQ(all.tuples("upto").size(), 10u);
}

TEST(DevelopmentRules, FollowHierarchies) {
  const Facts all = developed(
      small_graph("e:A e:partOf e:B . e:B e:partOf e:C . e:C e:partOf e:D . e:D e:partOf e:E .\n"
                  "e:X rdfs:subClassOf e:A . e:P a e:Migration . e:F e:developsFrom e:G . e:G "
                  "e:developsFrom e:H ."));
  EXPECT_EQ(all.tuples("partOf").size(), 10u + 4u);
  EXPECT_TRUE(names_in(all, "partOf").contains("X-E"));
  EXPECT_TRUE(names_in(all, "hasPart").contains("E-A"));
  EXPECT_EQ(names_in(all, "ancestor"), (Names{"F-G", "F-H", "G-H"}));
  EXPECT_EQ(names_in(all, "instance"), (Names{"P-Migration", "P-Process"}));
}

TEST(DevelopmentRules, LetAProcessFailWithWhatItRequires) {
  const Graph graph = small_graph(
      "e:P a e:Growth . e:Q a e:Growth ; e:requires e:P . e:R a e:Rotation ; e:requires e:Q .\n"
      "e:S a e:Growth . e:Z a e:Growth ; e:dormant true . e:Y a e:Growth ; e:dormant false .\n"
      "e:D a e:Disease ; e:disables e:P . e:W a e:Disease ; e:enables e:Z .");
  EXPECT_EQ(names_in(developed(graph), "inactive"), Names{"Z"});
  EXPECT_EQ(names_in(developed(graph, "D"), "inactive"), (Names{"P", "Q", "R", "Z"}));
  EXPECT_EQ(names_in(developed(graph, "D"), "active"), (Names{"S", "Y"}));
  EXPECT_TRUE(names_in(developed(graph, "W"), "inactive").empty());
}

TEST(DevelopmentRules, LetAStructureLackOnlyWithoutAllThatWouldMakeIt) {
  const Graph graph = small_graph(
      "e:P a e:Growth ; e:produces e:A , e:B . e:Q a e:Growth ; e:produces e:B .\n"
      "e:C e:developsFrom e:A , e:B . e:E e:developsFrom e:A . e:F e:partOf e:E .\n"
      "e:M a e:Migration ; e:actsOn e:A , e:B . e:N a e:Migration ; e:actsOn e:A , e:E .\n"
      "e:I a e:Interaction ; e:inducer e:B ; e:target e:F .\n"
      "e:D a e:Disease ; e:disables e:P . e:W a e:Disease ; e:disables e:P , e:Q .");
  EXPECT_TRUE(names_in(developed(graph), "absent").empty());
  EXPECT_EQ(names_in(developed(graph, "D"), "absent"), (Names{"A", "E", "F"}));
  EXPECT_EQ(names_in(developed(graph, "D"), "inactive"), (Names{"P", "N", "I"}));
  EXPECT_EQ(names_in(developed(graph, "W"), "absent"), (Names{"A", "B", "C", "E", "F"}));
  EXPECT_EQ(names_in(developed(graph, "W"), "inactive"), (Names{"P", "Q", "M", "N", "I"}));
}

TEST(DevelopmentRules, LetADuctLackWithItsAnchorUnlessAnEndIsFree) {
  const Graph graph = small_graph(
      "e:P a e:Growth ; e:produces e:Kidney . e:D a e:Disease ; e:disables e:P .\n"
      "e:K1 e:of e:Artery ; e:geometry [ a e:Duct ; e:startsOn e:Aorta ; e:endsOn e:Kidney ] .\n"
      "e:K2 e:of e:Stump ; e:geometry [ a e:Duct ; e:startsOn e:Kidney ; e:endPoint (0 0 1) ] .\n"
      "e:K3 e:of e:Vein ; e:geometry [ a e:Duct ; e:startsOn e:Aorta ; e:endsOn e:Cava ] .");
  EXPECT_EQ(names_in(developed(graph, "D"), "absent"), (Names{"Kidney", "Artery"}));
}

TEST(DevelopmentRules, GiveStagesFromTheFirstToTheLast) {
  const Facts all = developed(
      small_graph(kStages + "e:A e:existsFrom e:S2 ; e:existsUntil e:S3 ; e:partOf e:Whole .\n"
                            "e:B e:existsFrom e:S10 ; e:existsUntil e:S10 ; e:partOf e:Whole ."));
  EXPECT_EQ(stages_of(all, "A"), (Names{"S2", "S3"}));
  EXPECT_EQ(stages_of(all, "Whole"), (Names{"S2", "S3", "S10"}));
}

TEST(DevelopmentRules, LetWhatWasNotDividedStay) {
  const Graph graph =
      small_graph(kStages +
                  "e:Cloaca e:existsFrom e:S1 ; e:existsUntil e:S2 .\n"
                  "e:Sinus e:existsFrom e:S3 ; e:existsUntil e:S10 . e:Canal e:existsFrom e:S3 ; "
                  "e:existsUntil e:S10 .\n"
                  "e:Split a e:Division ; e:actsOn e:Cloaca ; e:produces e:Sinus , e:Canal .\n"
                  "e:Other a e:Division ; e:actsOn e:Cloaca ; e:dormant true .\n"
                  "e:D a e:Disease ; e:disables e:Split .");
  const Facts healthy = developed(graph), sick = developed(graph, "D");
  EXPECT_EQ(stages_of(healthy, "Cloaca"), (Names{"S1", "S2"}));
  EXPECT_EQ(stages_of(healthy, "Sinus"), (Names{"S3", "S10"}));
  EXPECT_EQ(names_in(healthy, "halfOf"), (Names{"Sinus-Cloaca", "Canal-Cloaca"}));
  EXPECT_EQ(stages_of(sick, "Cloaca"), (Names{"S1", "S2", "S3", "S10"}));
  EXPECT_TRUE(stages_of(sick, "Sinus").empty());
}

TEST(DevelopmentRules, SeeOneParameterSetAndWhatIsCommon) {
  const Graph graph = small_graph(
      "e:P a e:Growth ; e:inSet e:One . e:Q a e:Growth ; e:inSet e:Two . e:R a e:Growth ; "
      "e:requires e:Q . e:D a e:Disease ; e:disables e:Q .");
  EXPECT_EQ(names_in(developed(graph, "D", "One"), "active"), (Names{"P", "R"}));
  EXPECT_EQ(names_in(developed(graph, "D", "Two"), "inactive"), (Names{"Q", "R"}));
  EXPECT_EQ(names_in(developed(graph, {}, ""), "active"), Names{"R"});
}

TEST(DevelopmentRules, RefuseAnUnknownDisease) {
  expect_error([] { (void)developed(small_graph("e:D a e:Disease ."), "Nope"); },
               {"no disease 'Nope'", "allowed: D"});
}

TEST(DevelopmentRules, GiveTheirFactsBackAsTriples) {
  const Graph graph = small_graph(
      "e:A e:partOf e:B . e:B e:partOf e:C . e:P a e:Growth ; e:produces "
      "e:A . e:D a e:Disease ; e:disables e:P .");
  const Graph all = saturated_graph(graph, developed(graph, "D"));
  const Dictionary& terms = all.dictionary();
  const Term a = *terms.find_local("A"), c = *terms.find_local("C");
  EXPECT_TRUE(all.contains(a, *terms.find_local("partOf"), c));
  EXPECT_TRUE(
      all.contains(a, *terms.find_iri(std::string(kRdf) + "type"), *terms.find_local("Absent")));
  EXPECT_EQ(all.line_of(a, *terms.find_local("partOf")), 3);  // of the file, under its two prefixes
  for (const Triple& triple : graph.triples())
    EXPECT_TRUE(all.contains(triple.subject, triple.predicate, triple.object));
}

// The cascades of the model's notes: a disease names one or two processes, the rest follows.
TEST(DevelopmentRules, FindTheCascadesOfTheUrinarySystem) {
  const Graph graph = test::urinary_graph();
  const Facts healthy = developed(graph);
  const Names lacking = names_in(healthy, "absent");
  const auto more = [&](const std::string& disease) {
    Names names = names_in(developed(graph, disease), "absent");
    for (const std::string& name : lacking) names.erase(name);
    return names;
  };
  const Names left{"LeftUretericBud", "LeftMetanephros", "LeftUreter", "LeftRenalPelvis",
                   "LeftRenalArtery"};
  Names right, both = left;
  for (const std::string& name : left) both.insert("Right" + name.substr(4));
  for (const std::string& name : both)
    if (name.starts_with("Right")) right.insert(name);
  EXPECT_EQ(more("RenalAgenesisLeft"), left);
  EXPECT_EQ(more("RenalAgenesisRight"), right);
  EXPECT_EQ(more("RenalAgenesisBilateral"), both);
  EXPECT_EQ(more("PersistentCloaca"), (Names{"UrogenitalSinus", "AnorectalCanal"}));
  EXPECT_TRUE(more("PelvicKidneyLeft").empty());
  EXPECT_TRUE(
      names_in(developed(graph, "PelvicKidneyLeft"), "inactive").contains("LeftGradualRotation"));
  EXPECT_FALSE(names_in(developed(graph, "HorseshoeKidney"), "absent").contains("RenalIsthmus"));
  EXPECT_TRUE(lacking.contains("RenalIsthmus"));
}

}  // namespace
}  // namespace geoprior::embryo
