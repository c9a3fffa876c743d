// Names that would leave their folder: refused wherever they come from, with one line and exit code
// 2, before anything is computed, written or removed.

#include "testbed/runner/names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "core/error.h"
#include "testbed/runner/inputs/run_reference.h"
#include "testbed/runner/journal/run_file.h"
#include "testbed/runner/reference/reference.h"
#include "testbed/runner/spec/sweeps.h"
#include "testbed/runner/spec/toml_tree.h"
#include "testbed/view/export.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using toy::disc_experiment;
using toy::Outcome;

const std::vector<std::string> kNoNames{"",
                                        ".",
                                        "..",
                                        ".hidden",
                                        "a/b",
                                        "../x",
                                        "/tmp/x",
                                        "a\\b",
                                        "a b",
                                        "a\nb",
                                        std::string("a\0b", 3),
                                        "\x7f",
                                        "µm",
                                        "50%",
                                        "x.geoprior-tmp",
                                        std::string(kLongestName + 1, 'x')};

TEST(Names, OfFilesStayInTheirFolder) {
  for (const std::string& name : kNoNames) {
    EXPECT_FALSE(is_name(name)) << name;
    EXPECT_FALSE(is_plain_name(name)) << name;
    EXPECT_TRUE(is_name(name_from(name))) << name;
  }
  for (const char* name : {"a", "surface", "stop_angle_deg=26", "1e-05,seed=2", "0.5-m-apart",
                           "x=+1.5", "checkpoints", "feature3_0000.exr", "_", "-5", "a..b"}) {
    EXPECT_TRUE(is_name(name)) << name;
    EXPECT_EQ(name_from(name), name);
  }
  EXPECT_TRUE(is_name(std::string(kLongestName, 'x')));
  EXPECT_FALSE(is_plain_name("a.b"));
}

TEST(Names, OfExperimentsAreTwo) {
  EXPECT_TRUE(is_experiment_id("skinning/knee"));
  for (const char* id : {"", "knee", "/knee", "skinning/", "../knee", "skinning/..", "a/b/c",
                         "../../../x", "/tmp/x", "a//b", "skinning/knee/"}) {
    EXPECT_FALSE(is_experiment_id(id)) << id;
  }
}

TEST(Names, OfStudiesAreTextOnOneLine) {
  EXPECT_NO_THROW(require_text_name("growth of implicit: ∫ w², 2 threads", "a study", "x.toml:3"));
  for (const std::string name : {"", "a\nb", "\x1b[2J", "\xff", "\xc3", "\xc3(", "a\x7f"}) {
    EXPECT_THAT(error_of([&] { require_text_name(name, "a study", "x.toml:3"); }),
                AllOf(StartsWith("x.toml:3: "), HasSubstr("one line"), Not(HasSubstr("\n"))));
  }
  EXPECT_THROW(require_text_name(std::string(201, 'x'), "a study", ""), Error);
}

TEST(Names, AreShownOnOneShortLine) {
  EXPECT_EQ(quoted_name("a\nb\x1b"), "'a\\x0ab\\x1b'");
  EXPECT_EQ(quoted_name("µm"), "'µm'");
  EXPECT_EQ(quoted_name("\xff"), "'\\xff'");
  EXPECT_LT(quoted_name(std::string(100000, 'x')).size(), 80U);
}

// The rule must fit what is there: every name of the repository's experiments and references.
TEST(Names, OfTheRepositoryFitTheRule) {
  const fs::path root = GEOPRIOR_SOURCE_DIR;
  int experiments = 0, cases = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "experiments")) {
    const fs::path& file = entry.path();
    if (file.extension() != ".toml" || file.stem().has_extension()) continue;
    const TomlNode tree = parse_toml_file(file);
    if (tree.find("variant") == nullptr) continue;
    ++experiments;
    const std::string id = file.parent_path().filename().string() + "/" + file.stem().string();
    EXPECT_TRUE(is_experiment_id(id)) << id;
    for (const TomlNode& variant : tree.find("variant")->items) {
      EXPECT_TRUE(is_plain_name(variant.find("name")->text)) << file;
    }
    for (const bool quick : {false, true}) EXPECT_NO_THROW(expand_sweeps(tree, quick)) << file;
    for (const auto& [size, set] : read_reference(root / "results/reference" / (id + ".txt"))) {
      for (const auto& [name, variants] : set.values) {
        std::string of_seeds = name;
        std::replace(of_seeds.begin(), of_seeds.end(), '*', '0');  // medians: "seed=*"
        EXPECT_TRUE(is_name(of_seeds) || name.empty()) << id << " " << name;
        ++cases;
      }
    }
  }
  EXPECT_GT(experiments, 40);
  EXPECT_GT(cases, 200);
}

TEST(Names, OfRunReferencesAreChecked) {
  EXPECT_EQ(parse_run_reference("run:fluid/wake/seed=2,cell=0.03/flip#features.h5").artifact,
            "features.h5");
  for (const char* text : {"run:../x/y", "run:a/../y", "run:a/b/..", "run:a/b/c/../d", "run:a/b/.",
                           "run:a/b/c#../../x", "run:a/b/c#/etc/passwd", "run:a/b/c\nd"}) {
    EXPECT_THAT(error_of([&] { (void)parse_run_reference(text); }),
                AllOf(HasSubstr("no reference to a run"), Not(HasSubstr("\n"))));
  }
}

std::string sweep(const std::string& lines) {
  return disc_experiment("segments = 16", "[[sweep]]\nkey = \"seed\"\n" + lines + "\n");
}

/// The program on a folder of its own, beside things that are not its own.
class ForeignNames : public ::testing::Test {
 protected:
  void SetUp() override {
    home_.write("precious/work.txt", "years of work");
    home_.write("results/reference/toy-circle/disc.txt", "geoprior reference 5\n\nend 0\n");
    before_ = files();
  }

  [[nodiscard]] fs::path root() const { return home_.root(); }
  /// Every file and folder but what the tests write themselves, with the files' bytes.
  [[nodiscard]] std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(root())) {
      const std::string name = entry.path().lexically_relative(root()).string();
      const bool own = name.ends_with(".toml") || name == "stdout.txt" || name == "stderr.txt";
      if (!own) all[name] = entry.is_regular_file() ? test::text_of(entry.path()) : "";
    }
    return all;
  }
  /// One line, exit code 2, and nothing is other than it was.
  void expect_refused(const std::string& arguments, const std::vector<std::string>& parts) {
    const Outcome outcome = home_.run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    const std::size_t at = outcome.err.find("error: ");
    ASSERT_NE(at, std::string::npos) << outcome.err;
    const std::string line = outcome.err.substr(at);
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
    for (const std::string& part : parts) EXPECT_THAT(line, HasSubstr(part));
    EXPECT_EQ(files(), before_) << arguments;
  }

  toy::Home home_;
  std::map<std::string, std::string> before_;
};

TEST_F(ForeignNames, OfAnIdentifierAreRefused) {
  for (const std::string id : {"../../../precious", "/tmp/geoprior-precious", "precious", "..",
                               "../precious", "a/b/c", "toy-circle/..", ""}) {
    home_.write("foreign.toml", "id = \"" + id + "\"\n" + disc_experiment());
    const std::string file = "'" + (root() / "foreign.toml").string() + "'";
    const std::vector<std::string> parts{"foreign.toml:1:", "id: ", "two names"};
    expect_refused("run " + file + " --no-pictures", parts);
    expect_refused("bless " + file + " --reason because", parts);
    expect_refused("check " + file, parts);
  }
}

TEST_F(ForeignNames, OfOurExperimentsBlessNothing) {
  home_.write("experiments/toy-circle/disc.toml", disc_experiment());
  home_.write("foreign.toml", "id = \"toy-circle/disc\"\n" + disc_experiment("segments = 3"));
  home_.write("copy/experiments/toy-circle/disc.toml", disc_experiment("segments = 3"));
  before_ = files();
  for (const char* file : {"foreign.toml", "copy/experiments/toy-circle/disc.toml"}) {
    expect_refused("bless '" + (root() / file).string() + "' --reason because",
                   {file, "is not the file of the experiment 'toy-circle/disc'",
                    (root() / "experiments/toy-circle/disc.toml").string()});
  }
  // A file of the clone that calls itself another one is no better.
  home_.write("experiments/toy-circle/other.toml",
              "id = \"toy-circle/disc\"\n" + disc_experiment("segments = 3"));
  expect_refused("bless toy-circle/other --reason because", {"is not the file of the experiment"});
  EXPECT_EQ(home_.run("bless toy-circle/disc --reason because").code, 0);
  EXPECT_EQ(home_
                .run("bless '" + (root() / "experiments/toy-circle/disc.toml").string() +
                     "' --reason because")
                .code,
            0);
  EXPECT_EQ(home_.run("check toy-circle/disc").code, 0);
}

TEST_F(ForeignNames, OfSweptCasesAreRefusedBeforeAnythingIsComputed) {
  const std::string long_name(300, 'x');
  for (const std::string name :
       {"..", ".", "", "../x", "/tmp/x", "a/b", "a\\\\b", "a\\nb", ".x", "µm", long_name.c_str()}) {
    home_.write("experiments/toy-circle/disc.toml",
                sweep("values = [1, 2]\nnames = [\"good\", \"" + name + "\"]"));
    expect_refused("run toy-circle/disc --no-pictures",
                   {"disc.toml:19:", "sweep.names", "is no name of a case", "letters, digits"});
  }
  home_.write("experiments/toy-circle/disc.toml",
              sweep("values = [1]\nnames = [\"" + std::string(100, 'x') + "\"]\ngrid = true\n" +
                    "[[sweep]]\nkey = \"threads\"\nvalues = [1]\nnames = [\"" +
                    std::string(100, 'y') + "\"]\ngrid = true"));
  expect_refused("run toy-circle/disc --no-pictures",
                 {"disc.toml:23:", "sweep.values", "(201 characters)", "1 to 128"});
}

TEST_F(ForeignNames, TitlesAreLines) {
  for (const char* text : {"x\\nclaims 5 of 5 hold", "\\u001b[8m", "a\\tb", "\\u009b2J"}) {
    const std::string line = "title = \"" + std::string(text) + "\"";
    home_.write("foreign.toml",
                std::regex_replace(disc_experiment(), std::regex("title[^\n]*"), line));
    const std::string file = "'" + (root() / "foreign.toml").string() + "'";
    expect_refused("run " + file + " --no-pictures",
                   {"foreign.toml:1:", "the text of the title is no line"});
  }
}

TEST(ForeignSweeps, WithLongValuesNeedNames) {
  const std::string text =
      "[[sweep]]\nkey = \"scene.file\"\nvalues = [\"" + std::string(300, 'x') + "\"]\n";
  EXPECT_THAT(error_of([&] { (void)expand_sweeps(parse_toml_text(text, "x.toml"), false); }),
              AllOf(StartsWith("x.toml:3:"), HasSubstr("(305 characters)"), HasSubstr("`names`")));
  const std::string named = text + "names = [\"one\"]\n";
  EXPECT_EQ(expand_sweeps(parse_toml_text(named, "x.toml"), false).back().name, "one");
}

TEST_F(ForeignNames, OfVariantsAndStudiesAreRefused) {
  const std::string long_name(300, 'x');
  for (const std::string name : {"..", "", "a/b", "a.b", "a\\nb", long_name.c_str()}) {
    home_.write("experiments/toy-circle/disc.toml",
                disc_experiment("segments = 16",
                                "[[variant]]\nname = \"" + name + "\"\nmethod = \"polygon\"\n"));
    expect_refused("run toy-circle/disc --no-pictures",
                   {"disc.toml:17:", "name", "is no name of a variant", "letters, digits"});
  }
  home_.write("experiments/toy-circle/disc.toml",
              disc_experiment("segments = 16",
                              "[[study]]\nname = \"a\\u001bb\"\nvariant = \"polygon\"\n"
                              "quantity = \"radius_error\"\nagainst = \"seed\"\n"));
  expect_refused("run toy-circle/disc --no-pictures",
                 {"disc.toml:17:", "name", "'a\\x1bb' is no name of a study"});
}

using Change = void (*)(RunRecord&);

/// Runs whose names leave their folder, and the place that must be named.
const std::vector<std::pair<Change, std::string>> kForeignRuns{
    {[](RunRecord& r) { r.cases[0].name = "../../precious"; }, "/cases"},
    {[](RunRecord& r) { r.cases[0].name = "/tmp/precious"; }, "/cases"},
    {[](RunRecord& r) { r.cases[0].name = ".."; }, "/cases"},
    {[](RunRecord& r) { r.cases[0].variants[0].name = "../../../precious"; }, "default/variants"},
    {[](RunRecord& r) { r.cases[0].variants[0].name = "/tmp/precious"; }, "default/variants"},
    {[](RunRecord& r) { r.cases[0].variants[0].frames[0].files[0].name = "/etc/passwd"; },
     "first-box/frames"},
    {[](RunRecord& r) {
       r.cases[0].variants[0].frames[1].files[0].name = "frames/default/first-box/../../../x.vtp";
     },
     "first-box/frames"},
    {[](RunRecord& r) {
       r.cases[0].variants[0].frames[1].files[0].name = "frames/default/second-box/x_0000.vtp";
     },
     "first-box/frames"},
    {[](RunRecord& r) {
       r.cases[0].variants[1].artifacts = {{"../../x", ""}};
     },
     "second-box/artifacts"},
    {[](RunRecord& r) { r.studies.resize(1), r.studies[0].name = "a\nb"; }, "/study"},
    {[](RunRecord& r) { r.experiment_id = "../../x"; }, "/@experiment_id"},
};

TEST(ForeignRun, NamesThatLeaveItAreRefusedWithFileAndPlace) {
  for (const auto& [change, place] : kForeignRuns) {
    const TestFolder folder;
    const fs::path run = folder.path / "a/b/run";
    fs::create_directories(run);
    RunRecord record = make_fake_run(run);
    change(record);
    write_fake_run(record, run);
    const auto count = [&] {
      return std::distance(fs::recursive_directory_iterator(folder.path), {});
    };
    const auto before = count();
    EXPECT_THAT(error_of([&] { (void)read_run_file(run / "run.h5"); }),
                AllOf(StartsWith((run / "run.h5").string()), HasSubstr(place + ": "),
                      HasSubstr("(allowed: "), Not(HasSubstr("\n"))));
    for (const char* format : {"obj", "ply", "glb"}) {
      EXPECT_THROW(export_run(OpenedRun(run), format, folder.path / "a/out"), Error);
    }
    EXPECT_EQ(count(), before) << place;
  }
}

}  // namespace
}  // namespace geoprior
