// The walk "a metric" of docs/architecture.md, on the topic that is plugged in: its values reach
// the reference of an experiment without a simulation, and nothing else moves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using toy::Outcome;

const std::string kExperiment = R"(title = "A square that grows"
topic = "sample"
[scene]
frames = 3
[[variant]]
name = "square"
method = "growing-square"
options = { rate = 0.5 }
[[variant]]
name = "still"
method = "growing-square"
role = "null"
options = { rate = 0 }
[figure_view]
metrics = ["edge"]
)";

const std::string kClaim = R"([[claim]]
text = "the area is that of a square of edge rate * t"
metric = "area"
variant = "square"
at = { time_s = 3 }
is = "=="
value = 2.25
tolerance = 1e-9
null = "still"
)";

class AddingAMetric : public ::testing::Test {
 protected:
  void SetUp() override {
    home_.write("experiments/sample/growth.toml", kExperiment);
    const Outcome blessed = earlier("bless sample/growth --reason 'first values'");
    ASSERT_EQ(blessed.code, 0) << blessed.err;
    home_.write("experiments/sample/growth.toml", kExperiment + kClaim);
  }
  [[nodiscard]] Outcome earlier(const std::string& arguments) const {
    return home_.run(arguments, GEOPRIOR_SAMPLE_PROGRAM);
  }
  [[nodiscard]] Outcome later(const std::string& arguments) const {
    return home_.run(arguments, GEOPRIOR_LATER_SAMPLE_PROGRAM);
  }
  /// By a program that cannot make a method.
  [[nodiscard]] Outcome without_simulation(const std::string& arguments) const {
    ::setenv("GEOPRIOR_NO_METHODS", "1", 1);
    Outcome outcome = later(arguments);
    ::unsetenv("GEOPRIOR_NO_METHODS");
    return outcome;
  }
  [[nodiscard]] std::string reference() const {
    return toy::Home::read(home_.root() / "results/reference/sample/growth.txt");
  }
  [[nodiscard]] std::size_t runs() const {
    const fs::path folder = home_.root() / "results/runs/sample/growth";
    return std::distance(fs::directory_iterator(folder), {});
  }
  toy::Home home_;
};

TEST_F(AddingAMetric, NeedsNoSimulationUntilTheProgramIsChecked) {
  const Outcome measured = without_simulation("measure sample/growth --no-pictures --json");
  ASSERT_EQ(measured.code, 0) << measured.err;
  const auto json = nlohmann::json::parse(measured.out);
  EXPECT_EQ(json["added"], nlohmann::json({"area"}));
  EXPECT_EQ(json["changed"].size() + json["gone"].size(), 0U);
  // A square of edge 0.5 m/s * 3 s.
  EXPECT_NEAR(json["cases"][0]["variants"][0]["summary"]["area.max"]["value"], 2.25, 1e-12);

  const std::string before = reference();
  EXPECT_THAT(before, Not(HasSubstr("area")));
  const Outcome blessed = without_simulation("bless sample/growth --rows area --reason 'area'");
  ASSERT_EQ(blessed.code, 0) << blessed.err;
  EXPECT_THAT(reference(), HasSubstr("area@3"));
  EXPECT_EQ(runs(), 2U) << "the blessed one, and the one that was measured";

  // That the frames of the later program are still those blessed only a run of it can say.
  const Outcome checked = later("check sample/growth --mutations");
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_THAT(checked.err, HasSubstr("same bytes"));
  EXPECT_EQ(runs(), 3U);
}

TEST_F(AddingAMetric, IsANoticeUntilItIsBlessed) {
  const Outcome checked = later("check sample/growth");
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_THAT(checked.err, HasSubstr("notice"));
}

TEST_F(AddingAMetric, IsMeasuredWhereOnlyTheBlessedRunIsThere) {
  const Outcome blessed = without_simulation("bless sample/growth --rows area,edge --reason both");
  EXPECT_EQ(blessed.code, 0) << blessed.err;
  EXPECT_THAT(reference(), AllOf(HasSubstr("area@3"), HasSubstr("edge.max")));
  EXPECT_EQ(runs(), 1U);
}

TEST_F(AddingAMetric, IsRefusedWhereItCannotBeMeasuredOrIsNotKept) {
  const std::string before = reference();
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const Outcome outcome =
        without_simulation("bless sample/growth --reason x --rows " + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(why)) << arguments;
    EXPECT_EQ(reference(), before) << arguments;
  };
  refused("aera", "did you mean 'area'");
  refused("area --quick", "there is no blessed run of this size");
  home_.write("experiments/sample/growth.toml", kExperiment);
  refused("area", "neither a claim nor its figure nor [check] reads it");
  home_.write("experiments/sample/growth.toml", kExperiment + kClaim);
  fs::remove_all(home_.root() / "results/runs/sample");
  refused("area", "there is no stored run whose frames are those blessed");
}

}  // namespace
}  // namespace geoprior
