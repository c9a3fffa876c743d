// Options that somebody turns: the rule on planted columns, and held against every topic.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "experiments/toy/toy_topic.h"
#include "testbed/catalogue.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/joined.h"
#include "tests/testbed/run_fixture.h"
#include "tests/topics/structure/source_tree.h"
#include "tests/topics/turned_options.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

FlatOptions flat(const std::string& json) {
  return flat_options(nlohmann::ordered_json::parse(json));
}

OptionRow row(const std::string& key, const std::string& type, const std::string& when = {}) {
  OptionRow made{key, type, "", "", "", ""};
  made.when = when;
  return made;
}

/// A scene with a tagged choice, a table that may be absent, and a list.
const OptionRows kRows({row("size", "number"), row("cut", "table"), row("cut.depth", "number"),
                        row("shape", "table"), row("shape.kind", "choice"),
                        row("shape.file", "text", "kind = file"),
                        row("shape.radius", "number", "kind = disc, open = yes"),
                        row("handles", "tables"), row("handles[].stiffness", "number"),
                        row("handles[].kind", "choice"),
                        row("handles[].path", "text", "kind = path")});

std::set<std::string> turned(const std::string& a, const std::string& b) {
  return turned_rows(flat(a), flat(b), kRows);
}

TEST(TurnedRows, OneKeyIsOneOption) {
  EXPECT_THAT(turned(R"({"size": 1, "cut": false})", R"({"size": 1, "cut": false})"), IsEmpty());
  EXPECT_THAT(turned(R"({"size": 1, "cut": false})", R"({"size": 2, "cut": false})"),
              ElementsAre("size"));
  EXPECT_THAT(turned(R"({"size": null})", R"({"size": 2})"), ElementsAre("size"));
  EXPECT_THAT(turned(R"({"size": 1, "other": [1, 2]})", R"({"size": 2, "other": [1, 3]})"),
              ElementsAre("other", "size"));
}

TEST(TurnedRows, ATableThatComesBringsWhatIsInIt) {
  EXPECT_THAT(turned(R"({"cut": false})", R"({"cut": {"depth": 1}})"), ElementsAre("cut"));
  EXPECT_THAT(turned(R"({"cut": {"depth": 2}})", R"({"cut": {"depth": 1}})"),
              ElementsAre("cut.depth"));
  EXPECT_THAT(turned(R"({"size": 1, "cut": false})", R"({"size": 2, "cut": {"depth": 1}})"),
              ElementsAre("cut", "size"));
}

TEST(TurnedRows, AChoiceBringsWhatItSelects) {
  const std::string disc = R"({"shape": {"kind": "disc", "radius": 1}})";
  EXPECT_THAT(turned(disc, R"({"shape": {"kind": "file", "file": "a.svg"}})"),
              ElementsAre("shape.kind"));
  EXPECT_THAT(turned(disc, R"({"shape": {"kind": "disc", "radius": 2}})"),
              ElementsAre("shape.radius"));
  EXPECT_THAT(turned(disc, R"({"shape": {"kind": "ring", "other": 2}})"),
              ElementsAre("shape.kind", "shape.other"))
      << "kind does not select it";
}

TEST(TurnedRows, OptionsOfAListAreCalledAfterIt) {
  const std::string two = R"({"handles": [{"stiffness": 1}, {"stiffness": 2}]})";
  EXPECT_THAT(turned(two, R"({"handles": [{"stiffness": 1}, {"stiffness": 3}]})"),
              ElementsAre("handles[].stiffness"));
  EXPECT_THAT(turned(two, R"({"handles": [{"stiffness": 1}]})"), ElementsAre("handles"));
  EXPECT_THAT(turned(two, R"({"handles": []})"), ElementsAre("handles"));
  EXPECT_THAT(turned(R"({"handles": [{"kind": "fixed"}, {"kind": "fixed"}]})",
                     R"({"handles": [{"kind": "fixed"}, {"kind": "path", "path": "p"}]})"),
              ElementsAre("handles[].kind"));
  EXPECT_THAT(turned(R"({"handles": [{"kind": "fixed"}, {"kind": "path", "path": "p"}]})",
                     R"({"handles": [{"kind": "path", "path": "p"}, {"kind": "path"}]})"),
              ElementsAre("handles[].kind", "handles[].path"))
      << "the path of the second is not taken along by the kind of the first";
}

/// Experiments on the toy disc, whose outcomes are planted.
class PlantedOptions : public RunTest {
 protected:
  PlantedOptions() : topic_(toy::circle_topic()), turned_(topic_) {}

  [[nodiscard]] Experiment planted(const std::string& more) const {
    return load(write_experiment("toy-circle/disc", kBase + more));
  }

  /// @param more  further variants, sweeps and claims
  void add(const std::string& more, const Outcomes& outcomes) {
    BlessedSet blessed;
    blessed.outcomes = outcomes;
    turned_.add(planted(more), &blessed);
  }

  [[nodiscard]] std::string text_of(const std::string& where, const std::string& key) const {
    for (const OptionUnit& unit : turned_.units()) {
      if (unit.where == "toy-circle/" + where && unit.key == key) return unit.text();
    }
    return "there is no such option";
  }

  [[nodiscard]] static std::string variant(const std::string& name, const std::string& options) {
    return "[[variant]]\nname = \"" + name + "\"\nmethod = \"polygon\"\noptions = { " + options +
           " }\n";
  }

  const std::string kBase = "title = \"t\"\ntopic = \"toy-circle\"\n" + variant("base", "");
  const Topic topic_;
  TurnedOptions turned_;
};

TEST_F(PlantedOptions, AreNotTurnedByAnExperimentThatSetsThemAll) {
  add(variant("all", "segments = 8, corner = \"outside\", scale = 1.5"),
      {{"default", {{"base", "1"}, {"all", "2"}}}});
  for (const char* key : {"segments", "corner=on-rim", "corner=outside", "scale"}) {
    EXPECT_THAT(text_of("polygon", key), HasSubstr("never turned")) << key;
  }
  EXPECT_EQ(turned_.units().size(), 6U + 4U) << "`motion` itself has no value";
}

TEST_F(PlantedOptions, AreTurnedByVariantsSweepsAndOptionsOfTheScene) {
  add(variant("corner", "corner = \"outside\"") +
          "[[sweep]]\nkey = \"variant.base.options.segments\"\nvalues = [8]\n"
          "variants = [\"base\"]\n[[sweep]]\nkey = \"scene.points\"\nvalues = [8]\n"
          "variants = [\"base\"]\n",
      {{"default", {{"base", "1"}, {"corner", "2"}}},
       {"segments=8", {{"base", "3"}}},
       {"points=8", {{"base", "4"}}}});
  EXPECT_THAT(text_of("polygon", "corner=on-rim"),
              AllOf(HasSubstr("turned in"), HasSubstr("base, default against corner, default")));
  EXPECT_THAT(text_of("polygon", "corner=outside"), HasSubstr("turned in"));
  EXPECT_THAT(text_of("polygon", "segments"), HasSubstr("turned in"));
  EXPECT_THAT(text_of("scene", "points"), HasSubstr("turned in"));
  EXPECT_THAT(text_of("scene", "radius_m"), HasSubstr("never turned"));
  EXPECT_THAT(text_of("polygon", "scale"), HasSubstr("never turned"));
}

TEST_F(PlantedOptions, ThatDoNothingAreNotTurned) {
  add(variant("scaled", "scale = 1.5"), {{"default", {{"base", "1"}, {"scaled", "1"}}}});
  EXPECT_THAT(text_of("polygon", "scale"), HasSubstr("without effect in toy-circle/disc"));
  const auto problems = option_problems(turned_.units(), {}, folder());
  EXPECT_EQ(problems.size(), turned_.units().size());
  EXPECT_THAT(problems, Contains(StartsWith("toy-circle/polygon scale: without effect")));
}

TEST_F(PlantedOptions, OfColumnsThatNobodyBlessedAreUnknown) {
  add(variant("scaled", "scale = 1.5"), {});
  EXPECT_THAT(text_of("polygon", "scale"), HasSubstr("no outcome is blessed"));
}

TEST_F(PlantedOptions, AreTurnedWhereAStoredValueDiffers) {
  const Experiment experiment = planted(variant("scaled", "scale = 1.5"));
  const auto blessed_with = [](const std::string& metric) {
    BlessedSet blessed;
    blessed.values["default"]["base"][metric] = {1, "m"};
    blessed.values["default"]["scaled"][metric] = {2, "m"};
    return blessed;
  };
  for (const char* metric : {"diagnostic:evaluations", "distance_to_reference.max"}) {
    const BlessedSet blessed = blessed_with(metric);
    turned_.add(experiment, &blessed);
    EXPECT_THAT(text_of("polygon", "scale"), HasSubstr("no outcome is blessed")) << metric;
  }
  const BlessedSet blessed = blessed_with("radius_error.max");
  turned_.add(experiment, &blessed);
  EXPECT_THAT(text_of("polygon", "scale"), HasSubstr("turned in"));
}

TEST_F(PlantedOptions, AreTurnedByTheNullOfAClaim) {
  const Experiment experiment = planted(
      "[[variant]]\nname = \"rough\"\nmethod = \"polygon\"\nrole = \"null\"\n"
      "options = { segments = 4 }\n[[claim]]\ntext = \"t\"\nmetric = \"radius_error\"\n"
      "variant = \"base\"\nvalue = 0.1\nnull = \"rough\"\n");
  BlessedSet blessed;
  blessed.claims["t"]["default"].outcome = ClaimOutcome::not_told_apart;
  turned_.add(experiment, &blessed);
  EXPECT_THAT(text_of("polygon", "segments"), HasSubstr("no outcome is blessed"));
  blessed.claims["t"]["default"].outcome = ClaimOutcome::holds;
  turned_.add(experiment, &blessed);
  EXPECT_THAT(text_of("polygon", "segments"), HasSubstr("turned in"));
}

TEST_F(PlantedOptions, AreNotTurnedByAnotherSeedOrMethod) {
  add("[[variant]]\nname = \"exact\"\nmethod = \"exact\"\n[[sweep]]\nkey = \"seed\"\n"
      "values = [2]\n",
      {{"default", {{"base", "1"}, {"exact", "2"}}}, {"seed=2", {{"base", "3"}, {"exact", "4"}}}});
  for (const OptionUnit& unit : turned_.units()) EXPECT_EQ(unit.turned, Turned::never) << unit.key;
}

/// A scene with points and a motion as the disc has them, and with a radius that is another one.
struct EarOptions {
  double radius_m = 1;
  int points = 24;
};
void describe(OptionVisitor& v, EarOptions& o) {
  v.value("radius_m", o.radius_m, {.doc = "radius of the ear", .unit = "m", .min = 0});
  v.value("points", o.points, {.doc = "points on the rim", .min = 3, .max = 1000000});
}

class PlantedUser : public PlantedOptions {
 protected:
  /// What is known of the scene of a topic that uses the disc's.
  [[nodiscard]] std::string text_of_user(const std::string& key,
                                         const std::vector<UsersChoice>& choices = {}) const {
    Topic ear = topic_;
    ear.name = "ear";
    ear.default_scene = [] { return std::make_unique<TypedOptions<EarOptions>>(); };
    TurnedOptions known(ear);
    known.share_scene(turned_, choices);
    for (const OptionUnit& unit : known.units()) {
      if (unit.where == "ear/scene" && unit.key == key) return unit.text();
    }
    return "there is no such option";
  }

  [[nodiscard]] static std::string sweep(const std::string& key) {
    return "[[sweep]]\nkey = \"scene." + key + "\"\nvalues = [8]\n";
  }
};

TEST_F(PlantedUser, SharesRowsOfTheSceneThatAreDescribedAlike) {
  EXPECT_THAT(text_of_user("points"), HasSubstr("never turned"));
  add(sweep("points") + sweep("radius_m"), {{"default", {{"base", "1"}}},
                                            {"points=8", {{"base", "2"}}},
                                            {"radius_m=8", {{"base", "3"}}}});
  EXPECT_THAT(text_of_user("points"), HasSubstr("turned in toy-circle/disc"));
  EXPECT_THAT(text_of("scene", "radius_m"), HasSubstr("turned in toy-circle/disc"));
  EXPECT_THAT(text_of_user("radius_m"), HasSubstr("never turned")) << "in other words";
}

TEST_F(PlantedUser, SharesChoicesOfTheUsersAndNoFailures) {
  add(sweep("points"), {{"default", {{"base", "1"}}}, {"points=8", {{"base", "1"}}}});
  EXPECT_THAT(text_of_user("points"), HasSubstr("without effect"));
  const auto choose = [](const std::string& where) {
    return users_choices(where + " points a_test.cpp Disc.HasPoints\n", "disc.txt");
  };
  EXPECT_THAT(text_of_user("points", choose("toy-circle/scene")),
              HasSubstr("turned in disc.txt:1"));
  EXPECT_THAT(text_of_user("points", choose("toy-circle/polygon")), HasSubstr("without effect"));
}

class UsersChoices : public RunTest {};

TEST_F(UsersChoices, NameAnOptionAndItsTest) {
  std::ofstream(folder() / "a_test.cpp")
      << "TEST_F(Page,\n       HasItsSize) { set(\"scene.width_mm = 3\"); }";
  const std::vector<OptionUnit> units{{"toy/scene", "page.width_mm"},
                                      {"toy/scene", "page.ink=red"},
                                      {"toy/scene", "page.ink=blue", Turned::with_effect},
                                      {"toy/scene", "size", Turned::with_effect}};
  const auto problems = [&](const std::string& lines) {
    return option_problems(units, users_choices(lines, "toy.txt"), folder());
  };
  const std::string width = "# of the page\ntoy/scene page.width_mm a_test.cpp Page.HasItsSize\n";
  EXPECT_THAT(problems(width), ElementsAre("toy/scene page.ink=red: never turned"));
  const std::string ink = "toy/scene page.ink a_test.cpp Page.HasItsSize\n";
  EXPECT_THAT(problems(width + ink), ElementsAre(HasSubstr("a_test.cpp never says ink")));
  const auto problem = [&](const std::string& line) { return problems(width + line).back(); };
  EXPECT_THAT(problem("toy/scene size a_test.cpp Page.HasItsSize\n"),
              StartsWith("toy.txt:3: toy/scene size: "));
  EXPECT_THAT(problems(width + "toy/scene size a_test.cpp Page.HasItsSize\n"),
              Contains(HasSubstr("an experiment turns it")));
  EXPECT_THAT(problems(width + "toy/scene page.pen a_test.cpp Page.HasItsSize\n"),
              Contains(HasSubstr("there is no such option")));
  EXPECT_THAT(problem("toy/scene page.ink b_test.cpp Page.HasItsSize\n"),
              HasSubstr("there is no file"));
  EXPECT_THAT(problem("toy/scene page.ink a_test.cpp Page.HasNoSize\n"), HasSubstr("has no test"));
  for (const char* line : {"toy/scene size\n", "toy/scene size a_test.cpp Page\n",
                           "toy/scene size a_test.cpp Page.HasItsSize too\n"}) {
    EXPECT_THAT(error_of([&] { (void)users_choices(line, "toy.txt"); }), HasSubstr("toy.txt:1"));
  }
}

/// Compares the columns of an experiment's full and quick runs.
void add_experiment(const CatalogueEntry& entry, const std::vector<Topic>& topics,
                    TurnedOptions& turned) {
  const Reference reference = read_reference(reference_file(entry.id));
  for (const bool quick : {false, true}) {
    LoadRequest request;
    request.quick = quick;
    const Experiment experiment = load_experiment(entry.file, topics, request);
    const auto blessed = reference.find(quick ? "quick" : "full");
    turned.add(experiment, blessed == reference.end() ? nullptr : &blessed->second);
  }
}

std::vector<UsersChoice> users_choices_of(const std::string& topic) {
  const fs::path file =
      fs::path(GEOPRIOR_SOURCE_DIR "/tests/topics/users_choices") / (topic + ".txt");
  if (!fs::exists(file)) return {};
  return users_choices(read_whole_file(file), file.filename().string());
}

// A line each option, or value of a choice, that no experiment turns:
//   build/release/tests/test_topics --gtest_filter=Options.AreTurned* | grep '^  '
TEST(Options, AreTurnedOrAreAUsersChoice) {
  const std::vector<Topic> topics = all_topics();
  const std::vector<CatalogueEntry> experiments = catalogue();
  std::map<std::string, TurnedOptions> turned_in;
  for (const Topic& topic : topics) {
    TurnedOptions& turned = turned_in.emplace(topic.name, topic).first->second;
    for (const CatalogueEntry& entry : experiments) {
      if (entry.topic == topic.name) add_experiment(entry, topics, turned);
    }
  }
  for (const auto& [topic, used] : structure::uses_of_topics(GEOPRIOR_SOURCE_DIR)) {
    const auto user = turned_in.find(topic);
    if (user == turned_in.end()) continue;
    for (const std::string& name : used) {
      user->second.share_scene(turned_in.at(name), users_choices_of(name));
    }
  }
  for (const Topic& topic : topics) {
    const TurnedOptions& turned = turned_in.at(topic.name);
    std::vector<OptionUnit> units = turned.units();
    // tests/testbed/external turn those of methods from outside.
    std::erase_if(units,
                  [&](const OptionUnit& unit) { return unit.where == topic.name + "/external"; });
    const std::vector<std::string> problems =
        option_problems(units, users_choices_of(topic.name), GEOPRIOR_SOURCE_DIR);
    EXPECT_TRUE(problems.empty()) << topic.name << ": " << problems.size() << " of " << units.size()
                                  << " options\n  " << joined(problems, "\n  ");
  }
}

}  // namespace
}  // namespace geoprior::test
