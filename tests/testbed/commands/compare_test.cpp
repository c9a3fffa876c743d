// `geoprior compare` on runs of the toy topics: the program as a user starts it. A run that differs
// from another of the same specification is made by rewriting the record of a copy, which is read
// with --force.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "testbed/runner/comparison/comparison.h"
#include "testbed/runner/comparison/pages.h"
#include "testbed/runner/comparison/specification.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/reference/gates.h"
#include "testbed/streams.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using toy::Outcome;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

const std::string kNear = R"(
[[variant]]
name = "square"
method = "polygon"
role = "null"
options = { segments = 4 }
[[claim]]
text = "sixteen corners stay near"
metric = "radius_error"
variant = "polygon"
value = 0.1
null = "square"
)";

class Compare : public ::testing::Test {
 protected:
  void SetUp() override {
    home_.write("experiments/toy-circle/disc.toml", toy::disc_experiment("segments = 16", kNear));
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return home_.root() / name; }

  /// A run of the disc in the folder of that name.
  [[nodiscard]] fs::path disc(const std::string& name, const std::string& more = "") const {
    const Outcome outcome =
        home_.run("run toy-circle/disc --no-pictures --out " + path(name).string() + " " + more);
    EXPECT_LE(outcome.code, 1) << outcome.err;
    return path(name);
  }

  /// A copy of a run with another record.
  template <class Change>
  [[nodiscard]] fs::path changed_copy(const fs::path& run, const std::string& name,
                                      Change change) const {
    fs::copy(run, path(name), fs::copy_options::recursive);
    const fs::path file = path(name) / "run.h5";
    RunRecord record = read_run_file(file);
    change(record);
    record.content_sha256 = "0123456789abcdef";
    fs::remove(file);
    write_run_file(record, file);
    return path(name);
  }

  [[nodiscard]] static SummaryValue& value_of(RunRecord& record, const std::string& variant,
                                              const std::string& metric) {
    for (VariantRecord& one : record.cases.at(0).variants) {
      if (one.name == variant) return one.summary.at(metric);
    }
    throw std::runtime_error("no variant " + variant);
  }

  [[nodiscard]] Outcome compare(const fs::path& before, const fs::path& after,
                                const std::string& more = "") const {
    return home_.run("compare " + before.string() + " " + after.string() + " " + more);
  }

  /// With the copies of `changed_copy`.
  [[nodiscard]] Outcome compare_copies(const fs::path& before, const fs::path& after) const {
    return compare(before, after, "--force --json");
  }

  toy::Home home_;
};

TEST_F(Compare, RunsOfEqualBytesAreSaidToBeEqual) {
  const fs::path before = disc("before"), after = disc("after");
  const Outcome outcome = compare(before, after, "--json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("Same bytes"));
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["same_bytes"], true);
  EXPECT_EQ(result["fell"], false);
  EXPECT_TRUE(result["values"].empty());
  EXPECT_GT(result["within_tolerance"], 0);
  EXPECT_FALSE(result["times"].empty());
  for (const char* file : {"html", "markdown"}) {
    EXPECT_TRUE(fs::exists(result[file].get<std::string>())) << file;
    EXPECT_EQ(fs::path(result[file].get<std::string>()).parent_path().parent_path(), after);
  }
  EXPECT_THAT(outcome.err, HasSubstr("geoprior render")) << "neither has a picture";
}

TEST_F(Compare, AMetricThatGotWorseExitsWithOneAndABetterOneDoesNot) {
  const fs::path good = disc("good");
  const fs::path bad = changed_copy(good, "bad", [](RunRecord& record) {
    value_of(record, "polygon", "radius_error.max").value *= 1.5;
    value_of(record, "polygon", "radius_error.median").value *= 1.0000001;  // within 1e-6
  });
  const Outcome worse = compare_copies(good, bad);
  EXPECT_EQ(worse.code, 1) << worse.err;
  EXPECT_THAT(worse.err, AllOf(HasSubstr("Quality fell: 1 value is worse"),
                               HasSubstr("lower is better"), HasSubstr("+50 %")));
  const json row = json::parse(worse.out)["values"].at(0);
  EXPECT_EQ(json::parse(worse.out)["values"].size(), 1U);
  EXPECT_EQ(row["change"], "worse");
  EXPECT_EQ(row["metric"], "radius_error.max");
  EXPECT_EQ(row["variant"], "polygon");
  EXPECT_EQ(row["unit"], "m");
  EXPECT_EQ(row["direction"], "lower_is_better");
  const Outcome better = compare_copies(bad, good);
  EXPECT_EQ(better.code, 0) << better.err;
  EXPECT_EQ(json::parse(better.out)["values"][0]["change"], "better");
}

TEST_F(Compare, TheExperimentsOwnToleranceCounts) {
  home_.write(
      "experiments/toy-circle/disc.toml",
      toy::disc_experiment("segments = 16", "[tolerance]\nradius_error = { relative = 1 }\n"));
  const fs::path good = disc("good");
  const fs::path bad = changed_copy(good, "bad", [](RunRecord& record) {
    value_of(record, "polygon", "radius_error.max").value *= 1.5;
  });
  EXPECT_EQ(compare_copies(good, bad).code, 0);
}

TEST_F(Compare, ALostValueIsAFallAndANewOneIsAChange) {
  const fs::path with = disc("with");
  const fs::path without = changed_copy(with, "without", [](RunRecord& record) {
    value_of(record, "polygon", "radius_error.max").value = kNoNumber;
  });
  const Outcome lost = compare_copies(with, without);
  EXPECT_EQ(lost.code, 1) << lost.err;
  EXPECT_EQ(json::parse(lost.out)["values"][0]["change"], "lost");
  EXPECT_TRUE(json::parse(lost.out)["values"][0]["after"].is_null());
  const Outcome found = compare_copies(without, with);
  EXPECT_EQ(found.code, 0) << found.err;
  EXPECT_EQ(json::parse(found.out)["values"][0]["change"], "changed");
}

TEST_F(Compare, ANullControlIsNotJudged) {
  const fs::path good = disc("good");
  const fs::path other = changed_copy(good, "other", [](RunRecord& record) {
    value_of(record, "square", "radius_error.max").value *= 2;
  });
  const Outcome outcome = compare_copies(good, other);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["values"][0]["unjudged"], "null control");
}

TEST_F(Compare, AClaimThatNoLongerHoldsExitsWithOne) {
  const fs::path good = disc("good");
  const fs::path bad =
      changed_copy(good, "bad", [](RunRecord& record) { record.claims.at(0).holds = false; });
  const Outcome outcome = compare_copies(good, bad);
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 claim fell"));
  const json claim = json::parse(outcome.out)["claims"].at(0);
  EXPECT_EQ(claim["before"], "holds");
  EXPECT_EQ(claim["after"], "falls short");
  EXPECT_EQ(compare_copies(bad, good).code, 0);
}

TEST_F(Compare, AVariantThatFailedIsAFallAndIsListedOnce) {
  const fs::path good = disc("good");
  const fs::path bad = changed_copy(good, "bad", [](RunRecord& record) {
    VariantRecord& polygon = record.cases.at(0).variants.at(1);
    polygon.status = "failed";
    polygon.error = "does not converge";
    polygon.summary.clear();
  });
  const Outcome outcome = compare_copies(good, bad);
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_TRUE(result["values"].empty());
  EXPECT_EQ(result["variants"][0]["after"], "failed: does not converge");
}

TEST_F(Compare, TimesNeverChangeTheExitCode) {
  const fs::path fast = disc("fast");
  const fs::path slow = changed_copy(fast, "slow", [](RunRecord& record) {
    record.provenance["cpu"] = "an abacus";
    for (auto& frame : record.cases.at(0).variants.at(1).timing.at("solve")) {
      for (double& seconds : frame) seconds *= 2;
    }
  });
  const Outcome outcome = compare_copies(fast, slow);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  EXPECT_EQ(result["times"][0]["variant"], "polygon") << "the slowest comes first";
  EXPECT_DOUBLE_EQ(result["times"][0]["median_ratio"], 2);
  EXPECT_DOUBLE_EQ(result["times"][0]["low"], 2);
  EXPECT_EQ(result["same_processor"], false);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("2 [2, 2]"), HasSubstr("an abacus"), HasSubstr("not paired")));
}

TEST_F(Compare, OtherSpecificationsAreRefusedWithTheirKeysOrComparedWhereTheyAgree) {
  const fs::path sixteen = disc("sixteen");
  const fs::path eight = disc("eight", "--set variant.polygon.options.segments=8 --set seed=2");
  const Outcome refused = compare(sixteen, eight);
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("seed: 1 -> 2"), HasSubstr("--common"),
                                 HasSubstr("variant.polygon.options.segments: 16 -> 8")));
  EXPECT_FALSE(fs::exists(path("out")));
  const Outcome common = compare(sixteen, eight, "--common --json --out " + path("out").string());
  EXPECT_EQ(common.code, 1) << common.err;
  const json result = json::parse(common.out);
  EXPECT_EQ(result["differing_keys"].size(), 2U);
  EXPECT_EQ(result["values"][0]["change"], "worse");
  EXPECT_TRUE(fs::exists(path("out/compare.html")));
  EXPECT_THAT(toy::Home::read(path("out/compare.md")),
              AllOf(HasSubstr("| variant.polygon.options.segments | 16 | 8 |"),
                    HasSubstr("| worse | radius_error.")));
}

TEST_F(Compare, WithCommonAVariantOfOneRunIsNamedAndNotJudged) {
  const fs::path all = disc("all");
  const fs::path one = disc("one", "--variant exact");
  const Outcome outcome = compare(all, one, "--common --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(json::parse(outcome.out)["only_before"].dump(), HasSubstr("variant 'polygon'"));
}

TEST_F(Compare, WhatIsOnlyDrawnOrCheckedIsNoOtherSpecification) {
  const fs::path before = disc("before");
  home_.write("experiments/toy-circle/disc.toml",
              toy::disc_experiment("segments = 16", kNear + toy::kPlotted));
  EXPECT_EQ(compare(before, disc("after")).code, 0);
}

TEST_F(Compare, OneRunIsComparedWithItselfByTwoVariantsOnly) {
  const fs::path run = disc("run");
  const Outcome same = compare(run, run / "run.h5");
  EXPECT_EQ(same.code, 2);
  EXPECT_THAT(same.err, AllOf(HasSubstr("is the same run twice"), HasSubstr("--variants A=B")));
  const Outcome worse = compare(run, run, "--variants exact=polygon --json");
  EXPECT_EQ(worse.code, 1) << worse.err;
  EXPECT_EQ(json::parse(worse.out)["values"][0]["variant"], "exact → polygon");
  EXPECT_THAT(json::parse(worse.out)["differing_options"].dump(), HasSubstr("\"method\""));
  EXPECT_EQ(compare(run, run, "--variants polygon=exact").code, 0);
  const Outcome unknown = compare(run, run, "--variants exact=poligon");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'polygon'"));
  EXPECT_EQ(compare(run, run, "--variants exact").code, 2);
  for (const char* itself : {"exact=exact", "exact=polygon,polygon=polygon"}) {
    const Outcome refused = compare(run, run, std::string("--json --variants ") + itself);
    EXPECT_EQ(refused.code, 2) << itself;
    EXPECT_THAT(refused.err,
                AllOf(HasSubstr("is one variant of one run, twice"), HasSubstr("--variants A=B")));
    EXPECT_EQ(refused.out, "");
  }
  EXPECT_EQ(compare(run, disc("other"), "--variants exact=exact").code, 0);
}

TEST_F(Compare, InputFilesWithOtherBytesAreNamed) {
  const fs::path run = disc("run");
  const auto reading = [&](const std::string& name, const std::vector<StoredFile>& inputs) {
    return changed_copy(run, name, [&](RunRecord& record) { record.inputs = inputs; });
  };
  const std::string old_hash(64, 'a'), new_hash(64, 'b'), kept(64, 'c');
  const fs::path before = reading("before", {{"mine.py", old_hash}, {"kept.csv", kept}});
  const fs::path after = reading("after", {{"mine.py", new_hash}, {"moved/kept.csv", kept}});
  const Outcome outcome = compare_copies(before, after);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("are equal, although 1 input file is not the same."),
                                 HasSubstr("mine.py  aaaaaaaaaaaa    bbbbbbbbbbbb"),
                                 Not(HasSubstr("kept.csv"))));
  const json inputs = json::parse(outcome.out)["differing_inputs"];
  ASSERT_EQ(inputs.size(), 1U);
  EXPECT_EQ(inputs[0], json({{"name", "mine.py"}, {"before", {old_hash}}, {"after", {new_hash}}}));
  EXPECT_THAT(compare(run, after, "--force").err, HasSubstr("absent"));
  const fs::path worse = changed_copy(after, "worse", [](RunRecord& record) {
    value_of(record, "polygon", "radius_error.max").value *= 1.5;
  });
  EXPECT_THAT(compare_copies(before, worse).err,
              HasSubstr("Quality fell: 1 value is worse, 1 input file is not the same."));
  EXPECT_THAT(
      compare(before, reading("same", {{"kept.csv", kept}, {"mine.py", old_hash}}), "--force").err,
      Not(HasSubstr("input file")));
}

TEST_F(Compare, RunsOfOtherTopicsAreRefused) {
  home_.write("experiments/toy-pendulum/swing.toml", R"(
title = "A pendulum"
topic = "toy-pendulum"
[scene]
frames = 2
duration_s = 0.1
[[variant]]
name = "exact"
method = "closed-form"
)");
  const fs::path swing = path("swing");
  ASSERT_EQ(home_.run("run toy-pendulum/swing --no-pictures --out " + swing.string()).code, 0);
  const Outcome outcome = compare(disc("disc"), swing, "--common");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("different topics"), HasSubstr("toy-pendulum")));
}

TEST_F(Compare, ADamagedRunIsRefusedByName) {
  const fs::path good = disc("good"), bad = disc("bad");
  std::fstream(bad / "run.h5", std::ios::in | std::ios::out | std::ios::binary)
      .seekp(-9, std::ios::end)
      .write("x", 1);
  for (const auto& [a, b] : {std::pair{good, bad}, std::pair{bad, good}}) {
    const Outcome outcome = compare(a, b);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("bad/run.h5"), HasSubstr("damaged")));
  }
  EXPECT_EQ(compare(good, path("nothing")).code, 2);
}

TEST_F(Compare, AFolderThatCannotBeWrittenIsAnErrorAndLeavesNothing) {
  const fs::path before = disc("before"), after = disc("after");
  home_.write("file", "no folder");
  const Outcome outcome = compare(before, after, "--json --out " + path("file/out").string());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("file"));
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(toy::Home::read(path("file")), "no folder");
}

TEST_F(Compare, WhereNoPageCanBeWrittenTheVerdictStandsAndOutIsNamed) {
  const fs::path before = disc("before"), after = disc("after");
  const std::string hash = read_run_file(before / "run.h5").content_sha256;
  const fs::path in_the_way = home_.write("after/compare-" + hash.substr(0, 8), "no folder");
  const Outcome outcome = compare(before, after, "--json");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("Same bytes"), HasSubstr(in_the_way.string()),
                                 HasSubstr("--out DIR")));
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(compare(before, after, "--out " + path("out").string()).code, 0);
  EXPECT_TRUE(fs::exists(path("out/compare.html")));
}

TEST_F(Compare, TitlesAndClaimsAreText) {
  const std::string title = "<script>alert(1)</script> | `a` & *b*";
  std::string text = toy::disc_experiment("segments = 16", kNear);
  text.replace(text.find("A disc as a polygon"), 19, title);
  home_.write("experiments/toy-circle/disc.toml", text);
  const fs::path good = disc("good");
  const fs::path bad = changed_copy(good, "bad", [](RunRecord& record) {
    value_of(record, "polygon", "radius_error.max").value *= 2;
    record.provenance["cpu"] = "a | b\n<img src=x>";
  });
  EXPECT_EQ(compare(good, bad, "--force --out " + path("out").string()).code, 1);
  const std::string html = toy::Home::read(path("out/compare.html"));
  EXPECT_THAT(html,
              AllOf(HasSubstr("<h1>&lt;script&gt;alert(1)&lt;/script&gt; | `a` &amp; *b*</h1>"),
                    Not(HasSubstr("<script")), Not(HasSubstr("<img src=x"))));
  const std::string markdown = toy::Home::read(path("out/compare.md"));
  EXPECT_THAT(markdown,
              AllOf(HasSubstr("## &lt;script&gt;alert(1)&lt;/script&gt; \\| \\`a\\` &amp; \\*b\\*"),
                    Not(HasSubstr("<")), HasSubstr("| a \\| b &lt;img src=x&gt; |")));
}

TEST_F(Compare, PicturesOfBothRunsAreInThePage) {
  const fs::path before = disc("before"), after = disc("after");
  // Nine bytes are iVBORw0KGgpN; the examples of RFC 4648's alphabet: "Man" is TWFu, "Ma" TWE=.
  const std::string signature = "\x89PNG\r\n\x1a\n", nine = signature + "M";
  home_.write("before/figure.png", nine + "Man");
  home_.write("after/figure.png", nine + "Ma");
  ASSERT_EQ(compare(before, after, "--out " + path("out").string()).code, 0);
  EXPECT_THAT(toy::Home::read(path("out/compare.html")),
              AllOf(HasSubstr("data:image/png;base64,iVBORw0KGgpNTWFu\""),
                    HasSubstr("data:image/png;base64,iVBORw0KGgpNTWE=\"")));
  for (const std::string& none :
       {std::string("<svg onload=x>"), std::string(), signature.substr(0, 7)}) {
    home_.write("after/figure.png", none);
    const Outcome outcome = compare(before, after, "--out " + path("out").string());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err,
                HasSubstr("after: figure.png is no PNG; made anew by: geoprior render"));
    EXPECT_THAT(toy::Home::read(path("out/compare.md")),
                AllOf(HasSubstr("- before: in compare.html"), Not(HasSubstr("- after: in"))));
    const std::string page = toy::Home::read(path("out/compare.html"));
    EXPECT_EQ(page.find("<img"), page.rfind("<img")) << "that of the first run alone";
  }
  fs::remove(after / "figure.png");
  fs::create_symlink(before / "figure.png", after / "figure.png");
  EXPECT_EQ(compare(before, after).code, 2) << "no link below a run is followed";
}

TEST(CompareEscapes, LeaveNoMarkup) {
  EXPECT_EQ(escaped_html("a < b & \"c\" 'd' > e"),
            "a &lt; b &amp; &quot;c&quot; &#39;d&#39; &gt; e");
  // The samples that the scripts of results/ are held to as well (report_test.py).
  std::ifstream file(GEOPRIOR_SOURCE_DIR "/tests/testbed/foreign_texts.json");
  for (const json& sample : json::parse(file)) {
    const auto text = sample["text"].get<std::string>();
    EXPECT_EQ(printable(text), sample["printable"]);
    EXPECT_EQ(escaped_markdown(text), sample["markdown"]);
  }
}

TEST(CompareJudges, EachDirectionByItsTolerance) {
  const auto change = [](Direction direction, double before, double after) -> std::string {
    Gate gate;
    gate.tolerance = {0.1, 0};
    gate.direction = direction;
    gate.target = 1;
    ValueChange value;
    value.before = before;
    value.after = after;
    if (!judge_change(gate, value)) return "within";
    return value.change == Change::worse    ? "worse"
           : value.change == Change::lost   ? "lost"
           : value.change == Change::better ? "better"
                                            : "changed";
  };
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(change(Direction::lower_is_better, 2, 2.05), "within");
  EXPECT_EQ(change(Direction::lower_is_better, 2, 2.2), "worse");
  EXPECT_EQ(change(Direction::lower_is_better, 2, 1.8), "better");
  EXPECT_EQ(change(Direction::lower_is_better, 2, infinity), "worse");
  EXPECT_EQ(change(Direction::lower_is_better, infinity, 2), "better");
  EXPECT_EQ(change(Direction::lower_is_better, infinity, infinity), "within");
  EXPECT_EQ(change(Direction::higher_is_better, 2, 1.8), "worse");
  EXPECT_EQ(change(Direction::closer_to_target, 1.1, 1.5), "worse");
  EXPECT_EQ(change(Direction::closer_to_target, 1.5, 1.1), "better");
  EXPECT_EQ(change(Direction::closer_to_target, 1.2, 0.8), "changed") << "as far on the other side";
  EXPECT_EQ(change(Direction::none, 2, 3), "changed");
  EXPECT_EQ(change(Direction::lower_is_better, 2, kNoNumber), "lost");
  EXPECT_EQ(change(Direction::lower_is_better, kNoNumber, 2), "changed");
  EXPECT_EQ(change(Direction::lower_is_better, kNoNumber, kNoNumber), "within");
  EXPECT_EQ(change(Direction::none, 2, kNoNumber), "changed");
}

TEST(CompareSpecifications, TablesOfArraysAreNamed) {
  const auto keys = [](const std::string& before, const std::string& after) {
    std::string text;
    for (const KeyDifference& one :
         differing_keys(parse_toml_text(before, "a"), parse_toml_text(after, "b"))) {
      text += one.key + ": " + one.before + " -> " + one.after + "\n";
    }
    return text;
  };
  EXPECT_EQ(keys("seed = 1\n[scene]\nr = 1.5\n", "seed = 1\n[scene]\nr = 2.5\nn = [1, 2]\n"),
            "scene.r: 1.5 -> 2.5\nscene.n: absent -> [1,2]\n");
  EXPECT_EQ(keys("[[variant]]\nname = \"a\"\nn = 1\n",
                 "[[variant]]\nname = \"b\"\nn = 3\n[[variant]]\nname = \"a\"\nn = 2\n"),
            "variant.a.n: 1 -> 2\nvariant.b: absent -> present\n")
      << "a variant before another one does not change it";
  EXPECT_EQ(keys("[figure_view]\nx = 1\n", "[check]\ny = 1\n"), "");
}

}  // namespace
}  // namespace geoprior
