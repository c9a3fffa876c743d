#include "solvers/embryo/queries/queries.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "solvers/embryo/queries/rows.h"
#include "tests/embryo/rules/ontology_files.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::embryo {
namespace {

using geoprior::test::expect_error;
using Names = std::set<std::string>;

/// Three stages from day 10 to 40, a bud in a system in a body, a duct with a list and anchors.
const std::string kBudSystem = R"(
e:S1 a e:TemporalEntity ; e:order 1 ; e:startDay 10.0 ; e:endDay 20.0 ; e:unit "d" ; e:source e:Book .
e:S2 a e:TemporalEntity ; e:order 2 ; e:startDay 20.0 ; e:endDay 29.5 ; e:unit "d" ; e:source e:Book .
e:S3 a e:TemporalEntity ; e:order 3 ; e:startDay 30.0 ; e:endDay 40.0 ; e:unit "d" .
e:Body a e:EmbryologicalEntity ; e:existsFrom e:S1 ; e:existsUntil e:S3 .
e:System a e:EmbryologicalEntity ; e:partOf e:Body .
e:Bud a e:EmbryologicalEntity ; e:partOf e:System ; e:existsFrom e:S2 ; e:existsUntil e:S3 ; e:developsFrom e:Duct .
e:Duct a e:EmbryologicalEntity ; e:existsFrom e:S1 ; e:existsUntil e:S1 ; e:developsFrom e:Cord .
e:Cord a e:EmbryologicalEntity ; e:existsFrom e:S1 .
e:Bud_3 a e:SpatioTemporalEntity ; e:of e:Bud ; e:during e:S3 ; e:geometry [ a e:Duct ;
  e:radius 0.5 ; e:via (0.25 0 0.25) ; e:startsOn e:Body ; e:unit "deg" , "mm" ; e:source e:Book , e:Assumed ] .
e:Bud_2 a e:SpatioTemporalEntity ; e:of e:Bud ; e:during e:S2 ; e:geometry [ a e:Point ; e:source e:Book ] .
e:Budding a e:Growth ; e:actsOn e:Bud ; e:from e:S1 ; e:to e:S2 .
e:Turning a e:Rotation ; e:actsOn e:Bud ; e:from e:S2 ; e:to e:S3 ; e:angle 90 ; e:unit "deg" .
e:Still a e:Disease ; e:disables e:Turning .
)";

class BudSystem : public ::testing::Test {
 protected:
  explicit BudSystem(const std::optional<std::string>& disease = {})
      : stated_(test::small_graph(kBudSystem)),
        graph_(saturated_graph(stated_, test::developed(stated_, disease))),
        queries_(graph_) {}

  [[nodiscard]] std::string name(Term term) const {
    return term < 0 ? "" : graph_.dictionary().local_name(term);
  }
  [[nodiscard]] Term term(const std::string& local) const {
    return *graph_.dictionary().find_local(local);
  }
  [[nodiscard]] Names existing(double day) const {
    Names names;
    for (const StructureOfDay& row : queries_.existing(day)) names.insert(name(row.structure));
    return names;
  }
  [[nodiscard]] Names running(double day) const {
    Names names;
    for (const RunningProcess& row : queries_.running(day))
      names.insert(name(row.process) + " " + name(row.kind));
    return names;
  }
  [[nodiscard]] Names names_of(const std::vector<Term>& terms) const {
    Names names;
    for (const Term term : terms) names.insert(name(term));
    return names;
  }

  Graph stated_, graph_;
  ViewerQueries queries_;
};

TEST_F(BudSystem, HasStagesFromOneStartToTheNext) {
  EXPECT_FALSE(queries_.stage_of(9.99));
  EXPECT_EQ(name(*queries_.stage_of(10)), "S1");
  EXPECT_EQ(name(*queries_.stage_of(20)), "S2");
  EXPECT_EQ(name(*queries_.stage_of(29.9)), "S2");  // behind the stage's own end
  EXPECT_EQ(name(*queries_.stage_of(40)), "S3");
  EXPECT_FALSE(queries_.stage_of(40.01));
}

TEST_F(BudSystem, SaysWhatExistsAtADay) {
  EXPECT_EQ(existing(15), (Names{"Body", "Duct"}));
  EXPECT_EQ(existing(25), (Names{"Body", "Bud", "System"}));
  EXPECT_TRUE(existing(5).empty());
}

TEST_F(BudSystem, OrdersKeyFramesByStage) {
  const std::vector<KeyFrame> frames = queries_.key_frames(term("Bud"));
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(name(frames[0].key), "Bud_2");
  EXPECT_EQ(name(frames[0].primitive), "Point");
  EXPECT_EQ(frames[0].day, 24.75);
  EXPECT_EQ(name(frames[1].key), "Bud_3");
  EXPECT_EQ(frames[1].order, 3);
}

TEST_F(BudSystem, FollowsPartsAndProgenitors) {
  EXPECT_EQ(names_of(queries_.parts(term("Body"))), (Names{"System", "Bud"}));
  EXPECT_EQ(names_of(queries_.progenitors(term("Bud"))), (Names{"Duct", "Cord"}));
}

TEST_F(BudSystem, LosesDeepPartsWhereLevelsAreFixed) {
  const auto levels = [&](int n) {
    return names_of(followed(stated_, term("Body"), term("partOf"), true, n));
  };
  EXPECT_EQ(levels(1), Names{"System"});
  EXPECT_EQ(levels(2), names_of(queries_.parts(term("Body"))));
  EXPECT_EQ(names_of(followed(stated_, term("Bud"), term("developsFrom"), false, 1)),
            Names{"Duct"});
}

TEST_F(BudSystem, RunsProcessesFromMiddleToMiddle) {
  EXPECT_TRUE(running(14.9).empty());
  EXPECT_EQ(running(15), Names{"Budding Growth"});
  EXPECT_EQ(running(24.75), (Names{"Budding Growth", "Turning Rotation"}));
  EXPECT_EQ(running(35), Names{"Turning Rotation"});
  EXPECT_TRUE(running(35.1).empty());
}

class StillBudSystem : public BudSystem {
 protected:
  StillBudSystem() : BudSystem("Still") {}
};

TEST_F(StillBudSystem, RunsNothingThatItsDiseaseDisables) { EXPECT_TRUE(running(30).empty()); }

TEST_F(BudSystem, KnowsUnitAndSourceOfEveryNumber) {
  std::multiset<std::string> rows;
  for (const SourcedNumber& row : queries_.numbers())
    rows.insert(name(row.property) + " " + name(row.value) + " " + name(row.unit) + " " +
                name(row.source));
  // One row for each of two sources; a length is measured in mm though deg stands there too.
  EXPECT_EQ(rows.count("radius 0.5 mm Assumed"), 1u);
  EXPECT_EQ(rows.count("radius 0.5 mm Book"), 1u);
  EXPECT_EQ(rows.count("via 0.25  Book"), 2u);
  EXPECT_EQ(rows.count("via 0  Book"), 1u);
  EXPECT_EQ(rows.count("endDay 29.5 d Book"), 1u);
  EXPECT_EQ(rows.count("startDay 30.0 d "), 1u);
  EXPECT_EQ(rows.count("angle 90 deg "), 1u);
  EXPECT_EQ(rows.count("order 3  "), 1u);
  EXPECT_EQ(rows.size(), 9u + 8u + 1u);
}

TEST_F(BudSystem, NamesWhatIsIncomplete) {
  std::multiset<std::string> rows;
  for (const IncompleteStructure& row : queries_.incomplete())
    rows.insert(name(row.structure) + " " + std::to_string(static_cast<int>(row.missing)));
  EXPECT_EQ(rows, (std::multiset<std::string>{"Cord 1", "Cord 2", "Duct 2"}));
}

TEST_F(BudSystem, BundlesTheGeometriesOfADay) {
  const FrameBundle bundle = queries_.bundle(35);
  ASSERT_EQ(bundle.entries.size(), 2u);
  const FrameBundle::Entry& last = bundle.entries[1];
  std::vector<std::string> values;
  for (int i = last.first_value; i < last.last_value; ++i)
    values.push_back(name(bundle.values[i].property) + " " + name(bundle.values[i].value));
  std::sort(values.begin(), values.end());
  EXPECT_EQ(values, (std::vector<std::string>{"radius 0.5", "startsOn Body", "via 0", "via 0.25",
                                              "via 0.25"}));
  EXPECT_TRUE(queries_.bundle(15).entries.empty());
}

TEST_F(BudSystem, HasRowsOfTextsForEachQuery) {
  const ViewerQuestion question{.day = 25, .structure = "Bud", .system = "Body"};
  for (int q = 1; q <= kViewerQueries; ++q)
    for (const auto& row : query_rows(queries_, q, question))
      EXPECT_EQ(row.size(), query_columns(q).size()) << q;
  const std::string ours(kNamespace);
  EXPECT_EQ(query_rows(queries_, 2, question)[0],
            (std::vector<std::string>{ours + "Bud_2", ours + "S2", "2", ours + "Point"}));
  EXPECT_TRUE(query_rows(queries_, 3, {.system = "Nothing"}).empty());
  expect_error([&] { (void)query_rows(queries_, 9, question); }, {"no query 9", "1 to 8"});
}

TEST(ViewerQueries, OfAnEmptyGraphAreEmpty) {
  const Graph graph;
  const ViewerQueries queries(graph);
  for (int q = 1; q <= kViewerQueries; ++q) EXPECT_TRUE(query_rows(queries, q, {}).empty());
}

TEST(ViewerQueries, OfTheUrinarySystemFindNothingIncomplete) {
  const Graph graph = test::urinary_graph();
  const Graph all = saturated_graph(graph, test::developed(graph));
  EXPECT_TRUE(ViewerQueries(all).incomplete().empty());
  EXPECT_GE(ViewerQueries(all).existing(44).size(), 25u);
}

}  // namespace
}  // namespace geoprior::embryo
