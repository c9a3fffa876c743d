// Defaults, overrides, the resolved text and its hash, mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testbed/runner/spec/spec_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Spec : public SpecTest {};

TEST_F(Spec, ResolvesDefaultsRolesAndIdentifier) {
  const Experiment e = load(toy::disc_experiment());
  EXPECT_EQ(e.id, "toy-circle/disc");
  ASSERT_EQ(case_names(e), std::vector<std::string>{"default"});
  ASSERT_EQ(e.cases[0].variants.size(), 2U);
  EXPECT_EQ(e.cases[0].variants[0].role, "method");
  EXPECT_EQ(e.cases[0].variants[1].role, "ablation");
  EXPECT_EQ(e.cases[0].variants[1].reference, "exact");
  EXPECT_EQ(options(e, 0, 1), json::parse(R"({"segments":16,"corner":"on-rim","scale":1.0})"));
  EXPECT_EQ(json::parse(e.cases[0].scene_json)["points"], 24);
  EXPECT_EQ(e.cases[0].seed, 1U);
}

TEST_F(Spec, QuickOverridesKeysAndSweepValues) {
  const std::string text = toy::disc_experiment() + kSweep +
                           "[timing]\nrepetitions = 9\n[quick]\n\"scene.motion.frames\" = 2\n"
                           "\"timing.repetitions\" = 1\n\"variant.polygon.options.scale\" = 0.75\n";
  const Experiment full = load(text), quick = load(text, sized(true));
  EXPECT_EQ(full.timing_repetitions, 9);
  EXPECT_EQ(quick.timing_repetitions, 1);
  EXPECT_EQ(json::parse(quick.cases[0].scene_json)["motion"]["frames"], 2);
  EXPECT_EQ(options(quick, 0, 1)["scale"], 0.75);
  EXPECT_THAT(case_names(quick), ElementsAre("default", "segments=8"));
  EXPECT_NE(full.hash, quick.hash);
}

TEST_F(Spec, CheckNamesMetricsThatHaveReferenceValues) {
  const std::string check = "[check]\nmetrics = [\"radius_error\"]\n";
  const Experiment checked = load(toy::disc_experiment() + check);
  EXPECT_THAT(checked.checked_metrics, ElementsAre("radius_error"));
  EXPECT_EQ(checked.hash, load(toy::disc_experiment()).hash) << "no number of the run changes";
  EXPECT_THAT(load(checked.resolved_toml).checked_metrics, ElementsAre("radius_error"));
  const std::string quick_only = "[check]\nquick_metrics = [\"radius_error\"]\n";
  EXPECT_THAT(load(toy::disc_experiment() + quick_only).checked_metrics, ElementsAre());
  const Experiment quick = load(toy::disc_experiment() + quick_only, sized(true));
  EXPECT_THAT(quick.checked_metrics, ElementsAre("radius_error"));
  EXPECT_THAT(load(quick.resolved_toml).checked_metrics, ElementsAre("radius_error"));
  EXPECT_THAT(error_of(toy::disc_experiment() + "[check]\nquick_metrics = [\"radius\"]\n"),
              HasSubstr("quick_metrics: unknown metric 'radius'"));
  EXPECT_THAT(error_of(toy::disc_experiment() + "[check]\nmetrics = [\"radius\"]\n"),
              AllOf(HasSubstr("unknown metric 'radius'"), HasSubstr("disc.toml"),
                    HasSubstr("allowed: radius_error")));
}

TEST_F(Spec, SetOverridesWithTomlValuesAndBareWords) {
  const Experiment e =
      load(toy::disc_experiment(),
           with({"scene.motion.to_deg=45", "variant.polygon.options.corner=outside", "seed=9"}, 2));
  EXPECT_EQ(json::parse(e.cases[0].scene_json)["motion"]["to_deg"], 45.0);
  EXPECT_EQ(options(e, 0, 1)["corner"], "outside");
  EXPECT_EQ(e.cases[0].seed, 9U);
  EXPECT_EQ(e.cases[0].threads, 2);
  const std::string text = toy::disc_experiment();
  EXPECT_THAT(error_of(text, with({"scene.radus_m=3"})),
              AllOf(HasSubstr("--set scene.radus_m=3"), HasSubstr("did you mean 'radius_m'")));
  EXPECT_THAT(error_of(text, with({"title=x"})), HasSubstr("cannot be set"));
  EXPECT_THAT(error_of(text, with({"seed"})), HasSubstr("key=value"));
  EXPECT_THAT(error_of(text, with({"variant.poly.options.scale=1"})), HasSubstr("exact, polygon"));
  EXPECT_THAT(error_of(text, with({"variant.polygon.options.segments=2"})),
              HasSubstr("between 3 and"));
}

TEST_F(Spec, ResolvedTextIsAnExperimentFileOfTheSameHash) {
  const std::string text = toy::disc_experiment("segments = 12", kSweep) +
                           "[tolerance]\nradius_error = { absolute = 1e-3 }\n"
                           "[figure_view]\ndirection = [0, 1, 1]\ncolor_by = \"radius\"\n";
  for (const bool quick : {false, true}) {
    const Experiment first = load(text, sized(quick));
    const Experiment again =
        load_experiment(home_.write("spec.toml", first.resolved_toml), topics_, {});
    EXPECT_EQ(again.resolved_toml, first.resolved_toml);
    EXPECT_EQ(again.hash, first.hash);
    EXPECT_EQ(again.id, "toy-circle/disc");
    EXPECT_EQ(again.quick, quick);
    EXPECT_EQ(case_names(again), case_names(first));
  }
}

TEST_F(Spec, HashTellsSpecificationsApartAndIgnoresTheCamera) {
  const Experiment base = load(toy::disc_experiment());
  EXPECT_EQ(base.hash.size(), 64U);
  EXPECT_EQ(load("# a comment\n" + toy::disc_experiment()).hash, base.hash);
  EXPECT_EQ(load(toy::disc_experiment() + "[figure_view]\nup = [1, 0, 0]\n").hash, base.hash);
  EXPECT_NE(load(toy::disc_experiment(), with({"seed=2"})).hash, base.hash);
  EXPECT_NE(load(toy::disc_experiment("segments = 17")).hash, base.hash);
}

TEST_F(Spec, MistakesNameFileLineKeyAndWhatIsAllowed) {
  const std::string good = toy::disc_experiment();
  EXPECT_THAT(error_of(good + "[secne]\n"),
              AllOf(HasSubstr("disc.toml:16:"), HasSubstr("did you mean 'scene'")));
  EXPECT_THAT(error_of(toy::disc_experiment("segmants = 3")),
              AllOf(HasSubstr("disc.toml:15:13"), HasSubstr("variant.polygon.options.segmants"),
                    HasSubstr("did you mean 'segments'")));
  EXPECT_THAT(error_of(toy::disc_experiment("segments = 1")), HasSubstr("between 3 and 1e+05"));
  EXPECT_THAT(error_of(toy::disc_experiment("scale = nan")), HasSubstr("not finite"));
  EXPECT_THAT(
      error_of(
          "title = \"x\"\ntopic = \"toy-circel\"\n[[variant]]\nname = \"a\"\nmethod = \"exact\"\n"),
      AllOf(HasSubstr(":2:1"), HasSubstr("did you mean 'toy-circle'")));
  EXPECT_THAT(error_of("title = \"x\"\ntopic = \"toy-circle\"\n"), HasSubstr("[[variant]]"));
  EXPECT_THAT(error_of("topic = \"toy-circle\"\n[[variant]]\nname = \"a\"\nmethod = \"exact\"\n"),
              AllOf(HasSubstr("title"), HasSubstr("is missing")));
  EXPECT_THAT(error_of(good + "[[variant]]\nname = \"exact\"\nmethod = \"exact\"\n"),
              HasSubstr("two variants are called 'exact'"));
  EXPECT_THAT(error_of(good + "[[variant]]\nname = \"a/b\"\nmethod = \"exact\"\n"),
              HasSubstr("is no name of a variant"));
  EXPECT_THAT(error_of(good + "[[variant]]\nname = \"c\"\nmethod = \"exat\"\n"),
              HasSubstr("did you mean 'exact'"));
  EXPECT_THAT(error_of(good + "[variant2]\n"), HasSubstr("unknown key"));
  EXPECT_THAT(error_of(good + "[claim]\ntext = \"x\"\n"), HasSubstr("[[claim]]"));
  EXPECT_THAT(error_of(good + "[tolerance]\nradius = { absolute = 1 }\n"),
              HasSubstr("radius_error"));
}

TEST_F(Spec, WarmUpIsOfTheExperimentOrOfTheKindOfMethod) {
  EXPECT_FALSE(load(toy::disc_experiment()).timing_warm_up.has_value());
  const Experiment e = load(disc_with("[timing]\nwarm_up = 3\n"));
  EXPECT_EQ(e.timing_warm_up, 3);
  EXPECT_THAT(e.resolved_toml, HasSubstr("warm_up = 3"));
}

}  // namespace
}  // namespace geoprior::test
