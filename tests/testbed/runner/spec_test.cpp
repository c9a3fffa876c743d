#include "testbed/runner/spec/spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

LoadRequest sized(bool quick) {
  LoadRequest request;
  request.quick = quick;
  return request;
}

LoadRequest only(std::vector<std::string> variants) {
  LoadRequest request;
  request.variants = std::move(variants);
  return request;
}

LoadRequest with(std::vector<std::string> sets, std::optional<int> threads = {}) {
  LoadRequest request;
  request.sets = std::move(sets);
  request.threads = threads;
  return request;
}

class Spec : public ::testing::Test {
 protected:
  Experiment load(const std::string& text, const LoadRequest& request = {}) {
    return load_experiment(home_.write("experiments/toy-circle/disc.toml", text), topics_, request);
  }
  std::string error_of(const std::string& text, const LoadRequest& request = {}) {
    try {
      (void)load(text, request);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  static std::vector<std::string> case_names(const Experiment& experiment) {
    std::vector<std::string> names;
    for (const CaseSpec& c : experiment.cases) names.push_back(c.name);
    return names;
  }
  static json options(const Experiment& e, std::size_t c, std::size_t v) {
    return json::parse(e.cases.at(c).variants.at(v).options_json);
  }

  toy::Home home_;
  std::vector<Topic> topics_ = toy::topics();
};

constexpr const char* kSweep = R"(
[[sweep]]
key = "variant.polygon.options.segments"
values = [8, 32]
quick_values = [8]
)";

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

TEST_F(Spec, SweepWithoutGridMakesItsCasesBesideTheBase) {
  const Experiment e = load(toy::disc_experiment() + kSweep +
                            "[[sweep]]\nkey = \"seed\"\nvalues = [4, 5]\nnames = [\"a\", \"b\"]\n");
  EXPECT_THAT(case_names(e), ElementsAre("default", "segments=8", "segments=32", "a", "b"));
  EXPECT_EQ(options(e, 2, 1)["segments"], 32);
  EXPECT_EQ(options(e, 3, 1)["segments"], 16);
  EXPECT_EQ(e.cases[4].seed, 5U);
  EXPECT_EQ(e.cases[2].swept.at("variant.polygon.options.segments"), "32");
}

TEST_F(Spec, GridSweepsMakeTheirProduct) {
  const std::string grid = "grid = true\nbase = false\n";
  const Experiment e = load(toy::disc_experiment() + kSweep + grid +
                            "[[sweep]]\nkey = \"scene.points\"\nvalues = [6, 12, 18]\n" + grid);
  ASSERT_EQ(e.cases.size(), 6U);
  EXPECT_EQ(e.cases[4].name, "segments=32,points=12");
  EXPECT_EQ(options(e, 4, 1)["segments"], 32);
  EXPECT_EQ(json::parse(e.cases[4].scene_json)["points"], 12);
}

TEST_F(Spec, SweepsForClaimsOnlySayThatOfTheirCases) {
  const Experiment e = load(toy::disc_experiment() + kSweep +
                            "[[sweep]]\nkey = \"seed\"\nvalues = [7]\nclaims_only = true\n");
  for (const CaseSpec& made : e.cases) EXPECT_EQ(made.claims_only, made.name == "seed=7");
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

TEST_F(Spec, QuickValuesThatStandInOneForOneKeepTheNames) {
  const std::string sweep = toy::disc_experiment() +
                            "[[sweep]]\nkey = \"seed\"\nvalues = [4, 5]\nnames = [\"a\", \"b\"]\n";
  EXPECT_THAT(case_names(load(sweep + "quick_values = [6, 7]\n", sized(true))),
              ElementsAre("default", "a", "b"));
  EXPECT_THAT(case_names(load(sweep + "quick_values = [6]\n", sized(true))),
              ElementsAre("default", "seed=6"));
}

TEST_F(Spec, QuickVersionLeavesOutWhatOnlyTheFullOneHas) {
  const auto claim = [](const std::string& text) {
    return "[[claim]]\ntext = \"" + text +
           "\"\nmetric = \"radius_error\"\nvariant = \"polygon\"\nvalue = 1\n";
  };
  const std::string text = toy::disc_experiment() + kSweep + claim("both") +
                           "cases = [\"segments=8\", \"segments=32\"]\n" + claim("full") +
                           "cases = [\"segments=32\"]\n" +
                           "[[sweep]]\nkey = \"seed\"\nvalues = [4]\nquick_values = []\n";
  EXPECT_EQ(load(text).claims.size(), 2U);
  const Experiment quick = load(text, sized(true));
  EXPECT_THAT(case_names(quick), ElementsAre("default", "segments=8"));
  ASSERT_EQ(quick.claims.size(), 1U);
  EXPECT_THAT(quick.claims[0].cases, ElementsAre("segments=8"));
  // What a run writes down of itself can be read again.
  const Experiment again = load(quick.resolved_toml);
  EXPECT_EQ(case_names(again), case_names(quick));
  EXPECT_EQ(again.claims.size(), 1U);
  EXPECT_THAT(error_of(text + claim("none") + "cases = [\"segments=9\"]\n", sized(true)),
              HasSubstr("segments=9"));
}

TEST_F(Spec, SweepsAreTakenOutWithWhatIsClaimedOfThem) {
  const std::string claim =
      "[[claim]]\nmetric = \"radius_error\"\nvariant = \"polygon\"\nvalue = 1\n";
  const std::string seeds = "[[sweep]]\nkey = \"seed\"\nvalues = [4, 5]\n";
  const std::string text = toy::disc_experiment() + kSweep + seeds + claim +
                           "text = \"of seeds\"\nover = \"seed\"\n" + claim +
                           "text = \"of a case\"\ncases = [\"segments=32\"]\n" + claim +
                           "text = \"of the file\"\n";
  LoadRequest alone;
  alone.sets = {"sweep=[]"};
  const Experiment one = load(text, alone);
  EXPECT_THAT(case_names(one), ElementsAre("default"));
  ASSERT_EQ(one.claims.size(), 1U) << "one seed decides no claim over seeds";
  EXPECT_EQ(one.claims[0].text, "of the file");
  EXPECT_EQ(load(one.resolved_toml).claims.size(), 1U);
  alone.sets = {"sweep=[1]"};
  EXPECT_THAT(error_of(text, alone), HasSubstr("sweeps can only be taken out"));
}

TEST_F(Spec, QuickVersionLeavesOutClaimsThatItIsTooShortFor) {
  const auto claim = [](const std::string& text, const std::string& more) {
    return "[[claim]]\ntext = \"" + text +
           "\"\nmetric = \"radius_error\"\nvariant = \"polygon\"\nvalue = 1\n" + more;
  };
  const std::string text =
      toy::disc_experiment() + claim("both", "") + claim("long", "quick = false\n");
  EXPECT_EQ(load(text).claims.size(), 2U);
  const Experiment quick = load(text, sized(true));
  ASSERT_EQ(quick.claims.size(), 1U);
  EXPECT_EQ(quick.claims[0].text, "both");
  EXPECT_THAT(error_of(toy::disc_experiment() + claim("no", "quick = 0\n"), sized(true)),
              HasSubstr("quick"));
}

TEST_F(Spec, QuickVersionLeavesOutVariants) {
  const auto claim = [](const std::string& more) {
    return "[[claim]]\ntext = \"t\"\nmetric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\n" +
           more;
  };
  const std::string octagon =
      "[[variant]]\nname = \"octagon\"\nmethod = \"polygon\"\nquick = false\n";
  const std::string sweep =
      "[[sweep]]\nkey = \"seed\"\nvalues = [2]\nvariants = [\"exact\", \"octagon\"]\n"
      "[[sweep]]\nkey = \"scene.radius_m\"\nvalues = [3]\nvariants = [\"octagon\"]\n";
  const std::string text = toy::disc_experiment() + octagon + sweep;
  const Experiment full = load(text);
  EXPECT_EQ(full.cases[0].variants.size(), 3U);
  EXPECT_EQ(full.cases.size(), 3U);
  const Experiment quick = load(text + claim(""), sized(true));
  EXPECT_EQ(quick.cases[0].variants.size(), 2U);
  EXPECT_THAT(case_names(quick), ElementsAre("default", "seed=2"));
  EXPECT_EQ(load(quick.resolved_toml).hash, quick.hash) << "an experiment file itself";
  const std::string view =
      "[figure_view]\nvariants = [\"exact\", \"octagon\"]\ncases = [\"default\", \"radius_m=3\"]\n";
  const FigureView shown =
      figure_view_of(load(text + view, sized(true)).resolved_toml, "", topics_);
  EXPECT_THAT(shown.variants, ElementsAre("exact"));
  EXPECT_THAT(shown.cases, ElementsAre("default"));
  LoadRequest named = sized(true);
  named.variants = {"octagon"};
  EXPECT_EQ(load(text, named).cases[0].variants[0].name, "octagon");

  EXPECT_THAT(error_of(text + claim("null = \"octagon\"\n"), sized(true)),
              AllOf(HasSubstr("quick runs leave variant 'octagon' out"), HasSubstr("null"),
                    HasSubstr("`quick = false` of the claim")));
  EXPECT_EQ(load(text + claim("null = \"octagon\"\nquick = false\n"), sized(true)).claims.size(),
            0U);
  EXPECT_EQ(load(text + claim("null = \"octagon\"\n")).claims.size(), 1U);
  const std::string study =
      "[[study]]\nname = \"growth\"\nkind = \"exponent\"\nvariant = \"octagon\"\n"
      "quantity = \"radius_error\"\nagainst = \"seed\"\n"
      "[[claim]]\ntext = \"s\"\nmetric = \"study:growth\"\nvalue = 1\n";
  EXPECT_THAT(error_of(text + study, sized(true)),
              HasSubstr("quick runs leave variant 'octagon' out"));
  EXPECT_THAT(
      error_of(text + "[[variant]]\nname = \"x\"\nmethod = \"polygon\"\nreference = \"octagon\"\n"),
      AllOf(HasSubstr("variant 'octagon' is left out of quick runs"), HasSubstr("reference")));
  std::string none = toy::disc_experiment();
  for (std::size_t at = 0; (at = none.find("[[variant]]\n", at)) != std::string::npos; at += 30) {
    none.insert(at + 12, "quick = false\n");
  }
  EXPECT_THAT(error_of(none), HasSubstr("has no variant of quick runs"));
}

/// Sweeps about variants that are left out: what was run is what the text says that it is.
TEST_F(Spec, LeavesOutSweepsOfVariantsThatAreLeftOut) {
  const auto sweep = [](const std::string& key, const std::string& variants,
                        const std::string& more) {
    return "[[sweep]]\nkey = \"" + key + "\"\nvalues = [3, 4]\nvariants = [" + variants + "]\n" +
           more;
  };
  const std::string octagon =
      "[[variant]]\nname = \"octagon\"\nmethod = \"polygon\"\nquick = false\n";
  const auto cases_of = [&](const std::string& sweeps) {
    const Experiment quick = load(toy::disc_experiment() + octagon + sweeps, sized(true));
    const Experiment again = load(quick.resolved_toml);
    EXPECT_EQ(case_names(again), case_names(quick)) << sweeps;
    EXPECT_EQ(again.hash, quick.hash) << sweeps;
    return case_names(quick);
  };
  const std::string grid = "grid = true\n", no_base = "base = false\n";
  EXPECT_THAT(cases_of(sweep("seed", "\"octagon\"", no_base)), ElementsAre("default"));
  EXPECT_THAT(
      cases_of(sweep("seed", "\"octagon\"", grid) + sweep("scene.radius_m", "\"octagon\"", grid)),
      ElementsAre("default"));
  EXPECT_THAT(
      cases_of(sweep("seed", "\"octagon\"", grid) + sweep("scene.radius_m", "\"exact\"", grid)),
      ElementsAre("default", "seed=3,radius_m=3", "seed=3,radius_m=4", "seed=4,radius_m=3",
                  "seed=4,radius_m=4"));
}

TEST_F(Spec, CheckNamesMetricsThatHaveReferenceValues) {
  const std::string check = "[check]\nmetrics = [\"radius_error\"]\n";
  const Experiment checked = load(toy::disc_experiment() + check);
  EXPECT_THAT(checked.checked_metrics, ElementsAre("radius_error"));
  EXPECT_EQ(checked.hash, load(toy::disc_experiment()).hash) << "no number of the run changes";
  EXPECT_THAT(load(checked.resolved_toml).checked_metrics, ElementsAre("radius_error"));
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

TEST_F(Spec, VariantSelectionKeepsReferencesAndDropsClaimsAboutOthers) {
  const std::string claims =
      "[[claim]]\ntext = \"a\"\nmetric = \"radius_error\"\nvariant = \"polygon\"\nvalue = 1\n"
      "[[claim]]\ntext = \"b\"\nmetric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\n";
  const std::string text = toy::disc_experiment() + kSweep + claims;
  const Experiment exact = load(text, only({"exact"}));
  ASSERT_EQ(exact.cases.size(), 1U) << "the sweep of the other variant's option is left out";
  EXPECT_EQ(exact.cases[0].variants.size(), 1U);
  ASSERT_EQ(exact.claims.size(), 1U);
  EXPECT_EQ(exact.claims[0].text, "b");
  EXPECT_EQ(load(text, only({"polygon"})).cases[0].variants.size(), 2U);
  EXPECT_THAT(error_of(text, only({"exakt"})), HasSubstr("did you mean 'exact'"));
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

TEST_F(Spec, ClaimsAreCheckedAgainstMetricsVariantsAndCases) {
  const auto claim = [&](const std::string& rest) {
    return error_of(toy::disc_experiment() + "[[claim]]\ntext = \"t\"\n" + rest);
  };
  EXPECT_THAT(claim("metric = \"radius_eror\"\nvariant = \"exact\"\nvalue = 1"),
              HasSubstr("did you mean 'radius_error'"));
  EXPECT_THAT(claim("metric = \"radius_error\"\nvariant = \"exat\"\nvalue = 1"),
              HasSubstr("did you mean 'exact'"));
  EXPECT_THAT(claim("metric = \"radius_error\"\nvariant = \"exact\""),
              HasSubstr("compared with nothing"));
  EXPECT_THAT(claim("metric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\nof = \"polygon\""),
              HasSubstr("both"));
  EXPECT_THAT(claim("metric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\ncases = [\"x\"]"),
              HasSubstr("default"));
  EXPECT_THAT(claim("metric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\nat = 90"),
              HasSubstr("{ angle_deg = 90 }"));
  EXPECT_THAT(claim("metric = \"study:none\"\nvalue = 1"), HasSubstr("unknown study"));
  EXPECT_EQ(claim("metric = \"timing:solve\"\nvariant = \"exact\"\nof = \"polygon\"\nis = \">\""),
            "no error");
}

/// A claim about the polygon, with a null called "square".
std::string with_null(const std::string& rest, const std::string& reference = "exact") {
  return toy::disc_experiment() +
         "[[variant]]\nname = \"square\"\nmethod = \"polygon\"\nrole = \"null\"\n" +
         (reference.empty() ? "" : "reference = \"" + reference + "\"\n") +
         "options = { segments = 4 }\n"
         "[[claim]]\ntext = \"t\"\nvariant = \"polygon\"\n" +
         rest;
}

TEST_F(Spec, NullsAreOtherVariantsThatCanFailTheClaim) {
  const std::string metric = "metric = \"radius_error\"\nvalue = 0.1\n";
  const Experiment e = load(with_null(metric + "null = \"square\"\n"));
  EXPECT_EQ(e.claims.at(0).null, "square");
  EXPECT_EQ(e.cases.at(0).variants.at(2).role, "null");
  EXPECT_EQ(e.claims.at(0).metric_tolerance.absolute,
            find_metric(topic_of(e, topics_), "radius_error")->tolerance.absolute);
  EXPECT_THAT(
      error_of(with_null(metric + "null = \"sqare\"\n")),
      AllOf(HasSubstr("null: there is no variant 'sqare'"), HasSubstr("did you mean 'square'")));
  EXPECT_THAT(error_of(with_null(metric + "null = \"polygon\"\n")),
              HasSubstr("null: is the variant itself"));
  const std::string of = "metric = \"radius_error\"\nof = \"exact\"\nnull = \"exact\"\n";
  EXPECT_THAT(error_of(with_null(of + "is = \"<=\"\n")), HasSubstr("would pass: it is what"));
  EXPECT_EQ(error_of(with_null(of + "is = \"<\"\n")), "no error");
  EXPECT_EQ(error_of(with_null(of + "is = \"<=\"\nfactor = 0.5\n")), "no error");
}

TEST_F(Spec, ANullHasTheReferenceOfItsVariant) {
  const std::string claim = "metric = \"distance_to_reference\"\nvalue = 0.1\nnull = \"square\"\n";
  EXPECT_EQ(error_of(with_null(claim)), "no error");
  EXPECT_THAT(error_of(with_null(claim, "")), HasSubstr("is not measured against 'exact'"));
}

TEST_F(Spec, TimesNeedNoNullAndOneLeftOutIsForgotten) {
  const Experiment timed = load(with_null("metric = \"timing:solve\"\nvalue = 1\n"));
  EXPECT_EQ(timed.claims.at(0).exempt, Exemption::timing);
  const std::string text = with_null("metric = \"radius_error\"\nvalue = 0.1\nnull = \"square\"\n");
  const Experiment alone = load(text, only({"polygon"}));
  EXPECT_FALSE(alone.claims.at(0).null.has_value());
  EXPECT_EQ(load(alone.resolved_toml).claims.size(), 1U);
}

TEST_F(Spec, TwoClaimsOfOneTextAreRefused) {
  const std::string claim =
      "[[claim]]\ntext = \"t\"\nmetric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\n";
  EXPECT_THAT(error_of(toy::disc_experiment() + claim + claim), HasSubstr("two claims say 't'"));
}

TEST_F(Spec, SweepsOfOneNameAreToldApartAndRepeatedCasesRefused) {
  const std::string two =
      "[[variant]]\nname = \"other\"\nmethod = \"polygon\"\n"
      "[[sweep]]\nkey = \"variant.polygon.options.segments\"\nvalues = [8]\n"
      "[[sweep]]\nkey = \"variant.other.options.segments\"\nvalues = [8]\n";
  const auto names = case_names(load(toy::disc_experiment() + two));
  EXPECT_THAT(names, ElementsAre("default", "variant.polygon.options.segments=8",
                                 "variant.other.options.segments=8"));
  EXPECT_THAT(error_of(toy::disc_experiment() + "[[sweep]]\nkey = \"seed\"\nvalues = [1, 1]\n"),
              HasSubstr("two cases are called"));
  EXPECT_THAT(error_of(toy::disc_experiment() + "[[sweep]]\nkey = \"title\"\nvalues = [1]\n"),
              HasSubstr("cannot be swept"));
}

std::string disc_with(const std::string& more) { return toy::disc_experiment() + more; }

TEST_F(Spec, ReductionsOfBothSidesOfAClaim) {
  const std::string head =
      "[[claim]]\ntext = \"t\"\nmetric = \"timing:solve\"\nvariant = \"polygon\"\n";
  const Experiment e =
      load(disc_with(head + "of = \"polygon\"\nreduce = \"p95\"\nof_reduce = \"median\"\n"));
  EXPECT_EQ(e.claims.at(0).reduce, Reduction::p95);
  EXPECT_EQ(e.claims.at(0).of_reduce, Reduction::median);
  EXPECT_FALSE(load(disc_with(head + "of = \"exact\"\n")).claims.at(0).of_reduce.has_value());
  EXPECT_THAT(error_of(disc_with(head + "value = 1\nof_reduce = \"median\"\n")),
              HasSubstr("reduces the frames of no variant"));
  EXPECT_THAT(error_of(disc_with(head + "of = \"exact\"\nat = { angle_deg = 90 }\n"
                                        "of_reduce = \"median\"\n")),
              HasSubstr("`at` picks one frame"));
  EXPECT_THAT(error_of(disc_with(head + "of = \"exact\"\nreduce = \"every\"\n"
                                        "of_reduce = \"median\"\n")),
              HasSubstr("frame by frame"));
}

TEST_F(Spec, WithinSpreadNamesItsYardstick) {
  const std::string sweep = "[[sweep]]\nkey = \"seed\"\nvalues = [1, 2, 3]\nbase = false\n";
  const auto study = [&](const std::string& kind, const std::string& of) {
    return disc_with(sweep + "[[study]]\nname = \"near\"\nkind = \"" + kind +
                     "\"\nvariant = \"polygon\"\nquantity = \"radius_error\"\n" + of);
  };
  EXPECT_EQ(load(study("within-spread", "of = \"exact\"\n")).studies.at(0).of, "exact");
  EXPECT_THAT(error_of(study("within-spread", "")), HasSubstr("of: is missing"));
  EXPECT_THAT(error_of(study("spread", "of = \"exact\"\n")), HasSubstr("no meaning"));
  EXPECT_THAT(error_of(study("within-spread", "of = \"circle\"\n")),
              HasSubstr("no variant 'circle'"));
}

TEST_F(Spec, WarmUpIsOfTheExperimentOrOfTheKindOfMethod) {
  EXPECT_FALSE(load(toy::disc_experiment()).timing_warm_up.has_value());
  const Experiment e = load(disc_with("[timing]\nwarm_up = 3\n"));
  EXPECT_EQ(e.timing_warm_up, 3);
  EXPECT_THAT(e.resolved_toml, HasSubstr("warm_up = 3"));
}

TEST_F(Spec, FigureViewHasClassesOfItsColours) {
  const Experiment e = load(disc_with(
      "[figure_view]\ncolor_by = \"kind\"\nclasses = [\"flat\", \"cone\"]\nshading = \"flat\"\n"
      "material = \"paper\"\nedges = true\n"));
  EXPECT_THAT(e.view.classes, ElementsAre("flat", "cone"));
  EXPECT_EQ(e.view.shading, FigureView::Shading::flat);
  EXPECT_EQ(e.view.material, FigureView::Material::paper);
  EXPECT_TRUE(e.view.edges);
  EXPECT_THAT(error_of(disc_with("[figure_view]\nclasses = [\"flat\"]\n")),
              HasSubstr("the values of no array"));
  EXPECT_THAT(error_of(disc_with("[figure_view]\nmaterial = \"wood\"\n")), HasSubstr("clay"));
}

TEST_F(Spec, FigureViewDrawsOverThePatternWhatItDrawsOverTheSheet) {
  const auto view = [&](const std::string& pattern) {
    return disc_with("[figure_view]\noverlays = [\"rulings\", \"tears\"]\n" + pattern);
  };
  EXPECT_TRUE(load(view("")).view.pattern.empty());
  EXPECT_THAT(load(view("pattern = [\"tears\"]\n")).view.pattern, ElementsAre("tears"));
  EXPECT_THAT(error_of(view("pattern = [\"tear\"]\n")),
              AllOf(HasSubstr("pattern"), HasSubstr("'tear'"), HasSubstr("tears")));
  const std::string curve = "expected = { points = [{ u = 0, v = 0 }, { u = 0, v = 1 }] }\n";
  EXPECT_EQ(load(view("pattern = [\"tears\"]\n" + curve)).view.expected->points.at(1).v, 1);
  EXPECT_THAT(error_of(view(curve)), HasSubstr("expected"));
}

TEST_F(Spec, FigureViewBeginsWithThatOfTheTopic) {
  for (Topic& topic : topics_) {
    topic.view.color_by = "kind";
    topic.view.classes = {"flat", "cone"};
    topic.view.material = FigureView::Material::paper;
    topic.view.overlays = {"rulings"};
    topic.view.target = {1, 2, 3};
  }
  const auto view_of = [&](const std::string& lines) { return load(disc_with(lines)).view; };
  const FigureView plain = view_of("");
  EXPECT_EQ(plain.color_by, "kind");
  EXPECT_THAT(plain.classes, ElementsAre("flat", "cone"));
  EXPECT_EQ(plain.material, FigureView::Material::paper);
  EXPECT_THAT(plain.overlays, ElementsAre("rulings"));
  EXPECT_EQ(plain.target, (std::array<double, 3>{1, 2, 3}));
  const FigureView other = view_of("[figure_view]\ncolor_by = \"speed\"\noverlays = []\n");
  EXPECT_EQ(other.color_by, "speed");
  EXPECT_TRUE(other.classes.empty()) << "those are of another array";
  EXPECT_TRUE(other.overlays.empty());
  EXPECT_EQ(other.material, FigureView::Material::paper);
  EXPECT_FALSE(view_of("[figure_view]\ncolor_by = \"\"\n").color_by);
}

std::vector<double> drawn(const Experiment& e) { return e.view.parameters; }

// The toy's disc ends at 90 degrees, its quick run at what the test says.
TEST_F(Spec, AFrameOfTheFigureBeyondTheEndOfTheRunIsRefused) {
  const auto text = [](const std::string& frames) {
    return disc_with("[figure_view]\n" + frames + "\n");
  };
  EXPECT_THAT(drawn(load(text("parameters = [30, 90]"))), ElementsAre(30, 90));
  const std::string message = error_of(text("parameters = [30, 91]"));
  EXPECT_THAT(message, AllOf(HasSubstr("disc.toml:"), HasSubstr("figure_view.parameters"),
                             HasSubstr("91 deg lies beyond the end of the run"),
                             HasSubstr("at most 90 deg")));
  EXPECT_THAT(error_of(text("at = { angle_deg = 120 }")),
              AllOf(HasSubstr("figure_view.at"), HasSubstr("120 deg")));
  EXPECT_THAT(error_of(text("parameters = [30]"), with({"figure_view.parameters=[95]"})),
              AllOf(HasSubstr("--set figure_view.parameters"), HasSubstr("95 deg")));
}

// A shortened run shows its own end; what is judged is the run that the file describes.
TEST_F(Spec, FramesOfTheFigureAreJudgedAgainstTheFullRun) {
  const auto text = [](const std::string& frames) {
    return disc_with("[figure_view]\n" + frames + "\n[quick]\n\"scene.motion.to_deg\" = 20\n");
  };
  EXPECT_THAT(drawn(load(text("parameters = [10, 90]"), sized(true))), ElementsAre(10, 20));
  EXPECT_THAT(error_of(text("parameters = [91]"), sized(true)), HasSubstr("at most 90 deg"));
  const LoadRequest shorter = with({"scene.motion.to_deg=45"});
  EXPECT_THAT(drawn(load(text("parameters = [10, 90]"), shorter)), ElementsAre(10, 45));
  const LoadRequest longer = with({"scene.motion.to_deg=180", "figure_view.parameters=[135]"});
  EXPECT_THAT(drawn(load(text("parameters = [10]"), longer)), ElementsAre(135));
  for (const LoadRequest& request : {sized(true), shorter, longer}) {
    const Experiment first = load(text("parameters = [10, 90]"), request);
    const Experiment again =
        load_experiment(home_.write("spec.toml", first.resolved_toml), topics_, {});
    EXPECT_EQ(drawn(again), drawn(first)) << "the resolved text is an experiment file itself";
  }
}

// The cases of a sweep may end apart: a frame is wanted of the longest that is drawn.
TEST_F(Spec, FramesOfTheFigureMayLieInAnyCaseThatIsDrawn) {
  const auto text = [](const std::string& view) {
    return toy::disc_experiment() +
           "[[sweep]]\nkey = \"scene.motion.to_deg\"\nvalues = [30, 180]\n" +
           "[figure_view]\nparameters = [150]\n" + view;
  };
  EXPECT_THAT(drawn(load(text(""))), ElementsAre(150));
  EXPECT_THAT(error_of(text("cases = [\"default\", \"to_deg=30\"]\n")),
              HasSubstr("at most 90 deg"));
}

/// The topic of the experiment in the documentation of the file format, as far as it needs one.
struct KneeScene {
  std::string character, skeleton;
  struct Motion {
    std::string joint, axis;
    double from_deg = 0, to_deg = 0;
    int frames = 2;
  } motion;
};
void describe(OptionVisitor& v, KneeScene& o) {
  v.value("character", o.character, {.doc = "character"});
  v.value("skeleton", o.skeleton, {.doc = "skeleton"});
  v.group("motion", {.doc = "motion"}, [&] {
    v.value("joint", o.motion.joint, {.doc = "joint"});
    v.value("axis", o.motion.axis, {.doc = "axis"});
    v.value("from_deg", o.motion.from_deg, {.doc = "first", .unit = "deg"});
    v.value("to_deg", o.motion.to_deg, {.doc = "last", .unit = "deg"});
    v.value("frames", o.motion.frames, {.doc = "frames", .min = 1});
  });
}
struct NoOptions {};
void describe(OptionVisitor&, NoOptions&) {}
struct ImplicitLike {
  std::string blend;
  double step = 0.2, stop_angle_deg = 45;
};
void describe(OptionVisitor& v, ImplicitLike& o) {
  v.value("blend", o.blend, {.doc = "operator"});
  v.value("step", o.step, {.doc = "step"});
  v.value("stop_angle_deg", o.stop_angle_deg, {.doc = "angle", .unit = "deg"});
}

Topic knee_topic() {
  Topic topic;
  topic.name = "skinning";
  topic.default_scene = [] { return std::make_unique<TypedOptions<KneeScene>>(); };
  MethodEntry baseline{"dual-quaternion", true, "", "", {}, {}},
      implicit{"implicit", false, "", "", {}, {}};
  baseline.default_options = [] { return std::make_unique<TypedOptions<NoOptions>>(); };
  implicit.default_options = [] { return std::make_unique<TypedOptions<ImplicitLike>>(); };
  topic.methods = {baseline, implicit};
  topic.metrics.emplace_back().rows.emplace_back().name = "overlap_volume";
  return topic;
}

constexpr const char* kKnee = R"(
title  = "Knee flexion: linear blend, dual quaternion, delta mush and implicit skinning"
figure = "3.2"                 # of the thesis; empty for a study of our own
topic  = "skinning"
seed   = 1
[scene]                        # typed by the topic; inputs may be any file the topic reads
character = "human"
skeleton  = "human.skeleton.toml"
motion    = { joint = "knee-left", axis = "flexion", from_deg = 0, to_deg = 120, frames = 25 }
[[variant]]
name = "dual-quaternion"
method = "dual-quaternion"
role = "baseline"
[[variant]]
name = "implicit"
method = "implicit"
options = { blend = "gradient-controlled", step = 0.35, stop_angle_deg = 55 }
[[claim]]                      # a statement that the runner can decide
text   = "implicit skinning removes the self-contact that dual quaternions leave"
metric = "overlap_volume"
variant = "implicit"
of     = "dual-quaternion"
at     = { angle_deg = 90 }    # or reduce = "max" | "median" over the frames
is     = "<="
factor = 0.2
[[sweep]]                      # each makes further cases; grid = true for the product with other sweeps
key    = "variant.implicit.options.stop_angle_deg"     # any dotted key
values = [26, 55, 80]
[timing]
repetitions = 5                # processes: whole runs, default 1, and labelled so
[quick]                        # what tests and --quick override (coarser, fewer frames)
"scene.motion.frames" = 4
[figure_view]                  # camera, colour map, which frame: how the picture is drawn
)";

TEST_F(Spec, TheDocumentedExampleLoads) {
  const auto file = home_.write("experiments/skinning/knee.toml", kKnee);
  const Experiment e = load_experiment(file, {knee_topic()}, {});
  EXPECT_EQ(e.id, "skinning/knee");
  EXPECT_EQ(e.figure, "3.2");
  EXPECT_THAT(case_names(e), ElementsAre("default", "stop_angle_deg=26", "stop_angle_deg=55",
                                         "stop_angle_deg=80"));
  ASSERT_EQ(e.claims.size(), 1U);
  EXPECT_EQ(e.claims[0].at_parameter, 90);
  EXPECT_EQ(e.claims[0].at_key, "angle_deg");
  EXPECT_EQ(e.claims[0].factor, 0.2);
  EXPECT_EQ(e.timing_repetitions, 5);
  EXPECT_EQ(options(e, 3, 1)["stop_angle_deg"], 80);
  const Experiment quick = load_experiment(file, {knee_topic()}, sized(true));
  EXPECT_EQ(json::parse(quick.cases[0].scene_json)["motion"]["frames"], 4);
}

}  // namespace
}  // namespace geoprior
