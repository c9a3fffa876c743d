// Claims and studies as they are read: nulls, reductions, yardsticks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testbed/runner/spec/spec_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SpecClaims : public SpecTest {};

TEST_F(SpecClaims, ClaimsAreCheckedAgainstMetricsVariantsAndCases) {
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
              HasSubstr("claim.cases: unknown key"));
  const std::string whole = "metric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\nexcept = ";
  EXPECT_THAT(claim(whole + "[{ cases = [\"x\"], reason = \"r\" }]"), HasSubstr("default"));
  EXPECT_THAT(claim(whole + "[{ cases = [\"default\"] }]"), HasSubstr("reason"));
  EXPECT_THAT(claim(whole + "[{ cases = [\"default\", \"default\"], reason = \"r\" }]"),
              HasSubstr("excepted twice"));
  EXPECT_THAT(claim("metric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\nat = 90"),
              HasSubstr("{ angle_deg = 90 }"));
  EXPECT_THAT(claim("metric = \"study:none\"\nvalue = 1"), HasSubstr("unknown study"));
  EXPECT_EQ(claim("metric = \"timing:solve\"\nvariant = \"exact\"\nof = \"polygon\"\nis = \">\""),
            "no error");
}

TEST_F(SpecClaims, OneSentenceIsAboutSeveralVariants) {
  const std::string claim = "[[claim]]\ntext = \"t\"\nmetric = \"radius_error\"\nvalue = 1\n";
  const std::string several = claim + "variants = [\"exact\", \"polygon\"]\n";
  const Experiment e = load(toy::disc_experiment() + several);
  ASSERT_EQ(e.claims.size(), 2U) << "a specification each";
  EXPECT_EQ(e.claims[1].variant, "polygon");
  EXPECT_EQ(load(e.resolved_toml).claims.size(), 2U);
  LoadRequest one;
  one.variants = {"exact"};
  EXPECT_EQ(load(toy::disc_experiment() + several, one).claims.size(), 1U);
  const auto error = [&](const std::string& rest) {
    return error_of(toy::disc_experiment() + claim + rest);
  };
  EXPECT_THAT(error("variants = [\"exact\"]\nvariant = \"exact\""),
              HasSubstr("has both `variant`"));
  EXPECT_THAT(error("variants = [\"exact\", \"exact\"]"), HasSubstr("names 'exact' twice"));
  EXPECT_THAT(error("variants = [\"exat\"]"), HasSubstr("did you mean 'exact'"));
  EXPECT_THAT(error_of(toy::disc_experiment() + several + claim + "variant = \"exact\""),
              HasSubstr("two claims say 't'"));
}

TEST_F(SpecClaims, SentencesOverSeedsSayHowMany) {
  const std::string claim =
      "metric = \"radius_error\"\nvariant = \"polygon\"\nvalue = 1\nover = \"seed\"\n";
  EXPECT_THAT(error_of(toy::disc_experiment() + "[[claim]]\ntext = \"round\"\n" + claim),
              HasSubstr("9 of 10 seeds"));
  EXPECT_EQ(error_of(toy::disc_experiment() + "[[claim]]\ntext = \"round in 9 of 10\"\n" + claim),
            "no error");
}

/// With a diagnostic that a metric measures, as the topic's table says.
TEST_F(SpecClaims, WhatAMetricMeasuresIsNotTakenFromTheMethod) {
  for (Topic& topic : topics_) {
    if (topic.name == "toy-circle") topic.diagnostics.front().metric = "radius_error";
  }
  const std::string claim = "[[claim]]\ntext = \"t\"\nis = \"<=\"\nvalue = 9\nmetric = ";
  EXPECT_THAT(error_of(toy::disc_experiment() + claim +
                       "\"diagnostic:evaluations\"\nvariant = \"polygon\"\n"),
              AllOf(HasSubstr("is what the method says of itself"),
                    HasSubstr("the metric 'radius_error'")));
  EXPECT_THAT(error_of(toy::disc_experiment() +
                       "[[study]]\nname = \"s\"\nkind = \"spread\"\nvariant = \"polygon\"\n"
                       "quantity = \"diagnostic:evaluations\"\n" +
                       claim + "\"study:s\"\n"),
              HasSubstr("is what the method says of itself"));
}

TEST_F(SpecClaims, ANumberThatAnotherClaimHasIsRefused) {
  const auto claim = [](const std::string& text, const std::string& rest) {
    return "[[claim]]\ntext = \"" + text +
           "\"\nmetric = \"radius_error\"\nvariant = \"polygon\"\n" + rest;
  };
  const std::string first = toy::disc_experiment() + claim("round", "value = 1\n");
  EXPECT_THAT(error_of(first + claim("as round, in 9 of 10", "value = 1\nover = \"seed\"\n")),
              HasSubstr("'round' claims the same of the same number"));
  EXPECT_EQ(error_of(first + claim("rounder", "value = 0.5\n")), "no error");
}

TEST_F(SpecClaims, TheInputIsAVariantOfTheFile) {
  EXPECT_EQ(load("input = \"polygon\"\n" + toy::disc_experiment()).input, "polygon");
  EXPECT_EQ(load(toy::disc_experiment()).input, std::nullopt) << "the topic names none";
  EXPECT_THAT(error_of("input = \"polgon\"\n" + toy::disc_experiment()),
              HasSubstr("did you mean 'polygon'"));
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

TEST_F(SpecClaims, NullsAreOtherVariantsThatCanFailTheClaim) {
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

TEST_F(SpecClaims, ANullHasTheReferenceOfItsVariant) {
  const std::string claim = "metric = \"distance_to_reference\"\nvalue = 0.1\nnull = \"square\"\n";
  EXPECT_EQ(error_of(with_null(claim)), "no error");
  EXPECT_THAT(error_of(with_null(claim, "")), HasSubstr("is not measured against 'exact'"));
}

TEST_F(SpecClaims, TimesNeedNoNullAndOneLeftOutIsForgotten) {
  const Experiment timed = load(with_null("metric = \"timing:solve\"\nvalue = 1\n"));
  EXPECT_EQ(timed.claims.at(0).exempt, Exemption::timing);
  const std::string text = with_null("metric = \"radius_error\"\nvalue = 0.1\nnull = \"square\"\n");
  const Experiment alone = load(text, only({"polygon"}));
  EXPECT_FALSE(alone.claims.at(0).null.has_value());
  EXPECT_EQ(load(alone.resolved_toml).claims.size(), 1U);
}

TEST_F(SpecClaims, TwoClaimsOfOneTextAreRefused) {
  const std::string claim =
      "[[claim]]\ntext = \"t\"\nmetric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\n";
  EXPECT_THAT(error_of(toy::disc_experiment() + claim + claim), HasSubstr("two claims say 't'"));
}

TEST_F(SpecClaims, ReductionsOfBothSidesOfAClaim) {
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

TEST_F(SpecClaims, WhatRunsUnderFurtherSeedsIsDecidedOverThem) {
  const auto file = [&](const std::string& of_sweep, const std::string& of_claim) {
    return disc_with("[[sweep]]\nkey = \"seed\"\nvalues = [2, 3]\n" + of_sweep +
                     "[[claim]]\ntext = \"small, in 9 of 10 seeds\"\nmetric = \"radius_error\"\n"
                     "variant = \"polygon\"\nvalue = 1\n" +
                     of_claim);
  };
  const std::string for_claims = "claims_only = true\n", over = "over = \"seed\"\n";
  EXPECT_THAT(error_of(file(for_claims, "")), HasSubstr("one would decide the claim"));
  EXPECT_EQ(load(file(for_claims, over)).claims.at(0).over, ClaimOver::seed);
  EXPECT_EQ(load(file("", "")).claims.size(), 1U) << "each seed is a case of its own";
  EXPECT_EQ(load(file(for_claims + "variants = [\"exact\"]\n", "")).claims.size(), 1U);
}

TEST_F(SpecClaims, MatchedNamesQualityAndRivals) {
  const auto study = [&](const std::string& kind, const std::string& members) {
    return disc_with("[[study]]\nname = \"equal\"\nkind = \"" + kind +
                     "\"\nvariant = \"polygon\"\nquantity = \"timing:solve\"\n" + members);
  };
  const std::string match = "match = \"radius_error\"\n";
  const std::string families = "families = [{ variants = [\"exact\"] }]\n";
  const StudySpec read = load(study("matched", match + families)).studies.at(0);
  EXPECT_EQ(read.match, "radius_error");
  EXPECT_EQ(read.match_reduce, Reduction::last);
  EXPECT_EQ(read.families, (std::vector<std::vector<std::string>>{{"exact"}}));
  EXPECT_THAT(error_of(study("matched", families)), HasSubstr("match: is missing"));
  EXPECT_THAT(error_of(study("matched", match)), HasSubstr("families: is missing"));
  EXPECT_THAT(error_of(study("matched", match + "families = [{ variants = [] }]\n")),
              HasSubstr("has no members"));
  EXPECT_THAT(error_of(study("matched", match + "families = [{ variants = [\"circle\"] }]\n")),
              HasSubstr("no variant 'circle'"));
  EXPECT_THAT(error_of(study("spread", match)), HasSubstr("no meaning"));
  EXPECT_THAT(error_of(study("range", families)), HasSubstr("no meaning"));
  EXPECT_THAT(error_of(study("matched", match + families + "match_reduce = \"every\"\n")),
              HasSubstr("match_reduce"));
  const std::string keep = "keep = \"radius_error\"\n", within = "keep_within = 0.1\n";
  const StudySpec kept = load(study("matched", match + families + keep + within)).studies.at(0);
  EXPECT_EQ(kept.keep, "radius_error");
  EXPECT_EQ(kept.keep_within, 0.1);
  EXPECT_EQ(kept.keep_direction, Direction::lower_is_better);
  EXPECT_THAT(error_of(study("matched", match + families + keep)), HasSubstr("keep_within"));
  EXPECT_THAT(error_of(study("matched", match + families + within)), HasSubstr("keep: is missing"));
  EXPECT_THAT(error_of(study("matched", match + families + "keep = \"x\"\n" + within)),
              HasSubstr("no better and worse"));
  EXPECT_THAT(error_of(study("spread", keep + within)), HasSubstr("no meaning"));
}

TEST_F(SpecClaims, WithinSpreadNamesItsYardstick) {
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
  EXPECT_THAT(error_of(study("pooled", "")), HasSubstr("is not measured of events alone"));
}

}  // namespace
}  // namespace geoprior::test
