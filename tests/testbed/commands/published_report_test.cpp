// `geoprior report --published`: one page from the committed records alone, one error that names
// the record that is damaged or that there is none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/testbed/toy_home.h"

namespace geoprior::toy {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

namespace fs = std::filesystem;

const std::string kRecord = R"({
  "schema_version": 1, "experiment": "toy-circle/disc", "title": "A <disc>", "figure": "9.9",
  "command": "geoprior run toy-circle/disc", "source": "run.h5", "commit": "0123456789abcdef",
  "content_sha256": "fedcba", "processor": "A CPU", "sizes": "16", "failures": [],
  "cases": ["default"],
  "claims": [{"holds": false, "case": "default", "text": "it is round", "detail": "3 <= 2 m"}],
  "studies": {}, "times": {"default": {"exact": {"phase": "solve", "median": 0.004, "low": 0.003,
    "high": 0.005, "p95": 0.006, "whole": null, "prepare": null, "memory": null}}},
  "ratios": {"default": []}, "units": {"area.max": "m^2"},
  "values": {"default": {"exact": {"area.max": 12.5}}}
})";

/// A clone with the scripts of this one and no run.
class PublishedReport : public ::testing::Test {
 protected:
  PublishedReport() {
    for (const auto& file : fs::directory_iterator(GEOPRIOR_SOURCE_DIR "/results")) {
      if (file.is_regular_file()) {
        fs::create_symlink(file.path(), home_.root() / "results" / file.path().filename());
      }
    }
  }

  [[nodiscard]] fs::path publish(const std::string& text) const {
    return home_.write("results/published/toy-circle/disc.json", text);
  }

  Home home_;
};

TEST_F(PublishedReport, IsAPageOfWhatTheRecordsSay) {
  (void)publish(kRecord);
  const Outcome outcome = home_.run("report --published --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const fs::path page = home_.root() / "results/runs/published.html";
  EXPECT_THAT(outcome.out, HasSubstr("{\n  \"report\": \"" + page.string() + "\"\n}"));
  const std::string text = Home::read(page);
  for (const char* shown :
       {"A &lt;disc&gt;", "Thesis Figure 9.9", "Published numbers, 1 experiments: falls short",
        "it is round", "3 &lt;= 2 m", "4.00 ms", "12.50 m²", "16 vertices"}) {
    EXPECT_THAT(text, HasSubstr(shown));
  }
}

TEST_F(PublishedReport, NamesARecordThatIsCutInHalf) {
  const fs::path record = publish(kRecord.substr(0, kRecord.size() / 2));
  const std::string page = (home_.root() / "page.html").string();
  const Outcome outcome = home_.run("report --published --out '" + page + "'");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, MatchesRegex("error: published\\.py: " + record.string() +
                                        ": not a published record \\([^\n]*\\)\n"));
  EXPECT_FALSE(fs::exists(page));
}

TEST_F(PublishedReport, SaysWhereThereAreNone) {
  const Outcome outcome = home_.run("report --published");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: published.py: " + (home_.root() / "results/published").string() +
                             ": no published records\n");
}

TEST_F(PublishedReport, TakesNoRun) {
  const Outcome outcome = home_.run("report --published toy-circle/disc");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("run excludes --published"));
}

}  // namespace
}  // namespace geoprior::toy
