#include "experiments/embryo/query_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testbed/scratch_folder.h"

namespace geoprior::embryo {
namespace {

using geoprior::test::expect_error;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class QueryCommand : public geoprior::test::ScratchFolder {
 protected:
  [[nodiscard]] std::string answer(const std::filesystem::path& experiment,
                                   const QueryOptions& given) const {
    const TopicCommand command = query_command();
    const auto options = command.default_options();
    dynamic_cast<TypedOptions<QueryOptions>&>(*options).options = given;
    return command.run(experiment.string(), *options).text;
  }
  void write_bud() const {
    write("bud.rules", "next2(S, U) :- next(S, T), next(T, U).");
    write("bud.toml",
          "topic = \"embryo\"\n[scene]\nrules = \"bud.rules\"\nexpected = \"none.toml\"");
    write("steps.rq", "PREFIX e: <urn:geoprior:embryo#> SELECT ?b { e:CS13 e:next2 ?b }");
  }
};

TEST_F(QueryCommand, TakesItsQueryBehindTheExperiment) {
  EXPECT_EQ(query_command().second_argument, "query");
}

TEST_F(QueryCommand, NamesWhatItCannotRead) {
  const auto none = write("none.toml", "topic = \"embryo\"");
  expect_error([&] { (void)answer(none, {.query = "q1.rq"}); }, {"none.toml", "has no [scene]"});
  const auto other = write("other.toml", "topic = \"grammar\"\n[scene]");
  expect_error([&] { (void)answer(other, {.query = "q1.rq"}); }, {"'grammar'", "embryo"});
  const auto typo = write("typo.toml", "[scene]\nontologie = \"a.ttl\"");
  expect_error([&] { (void)answer(typo, {.query = "q1.rq"}); }, {"typo.toml:2", "ontologie"});
  const auto good = write("good.toml", "[scene]");
  expect_error([&] { (void)answer(good, {.query = "no.rq"}); }, {"query", "no file 'no.rq'"});
}

class LongQueryCommand : public QueryCommand {};

TEST_F(LongQueryCommand, AnswersOverWhatFollowsFromTheRules) {
  write_bud();
  const std::string csv =
      answer(folder() / "bud.toml", {.query = (folder() / "steps.rq").string()});
  EXPECT_EQ(csv, "b\nurn:geoprior:embryo#CS15\n");
}

TEST_F(LongQueryCommand, AsksUnderAnotherDisease) {
  const auto file = write("scene.toml", "[scene]\ndisease = \"RenalAgenesisLeft\"");
  const QueryOptions sick{.query = "q1.rq"};
  QueryOptions healthy = sick;
  healthy.disease = "none";
  EXPECT_THAT(answer(file, sick), StartsWith("structure,stage\n"));
  EXPECT_THAT(answer(file, sick), ::testing::Not(HasSubstr("#LeftMetanephros,")));
  EXPECT_THAT(answer(file, healthy), HasSubstr("#LeftMetanephros,"));
}

}  // namespace
}  // namespace geoprior::embryo
