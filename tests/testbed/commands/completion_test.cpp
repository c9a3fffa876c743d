// Completion scripts and the manual page: made of what the commands say of themselves, and accepted
// by those who read them.
#include "testbed/commands/shell/completion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "testbed/commands/shell/manual.h"
#include "testbed/view/child_process.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using toy::Outcome;

class Completion : public ::testing::Test {
 protected:
  void SetUp() override {
    home_.write("experiments/toy-circle/disc.toml", toy::disc_experiment());
    home_.write("experiments/toy-circle/disc-large.toml", toy::disc_experiment());
  }

  [[nodiscard]] std::string script(const std::string& shell) const {
    const Outcome outcome = home_.run("completion " + shell);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.out;
  }

  /// What bash prints for the last of these words, which the shell would have split.
  [[nodiscard]] std::string asked_of_bash(const std::string& words, const std::string& before,
                                          const std::string& behind) const {
    const auto completion = home_.write("completion.bash", script("bash"));
    const auto asking = home_.write(
        "ask.bash", "source '" + completion.string() + "'\n" + before + "\nCOMP_WORDS=(" + words +
                        ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_geoprior\n" + behind + "\n");
    const ChildResult result = run_child({"bash", asking.string()});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return result.errors;
  }

  [[nodiscard]] std::set<std::string> offered(const std::string& words) const {
    return lines_of(asked_of_bash(words, "", "printf '%s\\n' \"${COMPREPLY[@]}\" >&2"));
  }

  /// What bash is told of the words that it is offered; outside of a completion it cannot be.
  [[nodiscard]] std::string told(const std::string& words) const {
    return asked_of_bash(words, "told=; compopt() { told=$*; }", "echo \"$told\" >&2");
  }

  static std::set<std::string> lines_of(const std::string& text) {
    std::istringstream all(text);
    std::set<std::string> lines;
    for (std::string line; std::getline(all, line);) lines.insert(line);
    return lines;
  }

  /// Runs a program on a text where the program is installed.
  void expect_accepted(const std::vector<std::string>& command, const std::string& text) const {
    if (!find_program(command.front())) return;
    std::vector<std::string> call = command;
    call.push_back(home_.write("accepted.txt", text).string());
    const ChildResult result = run_child(call);
    EXPECT_EQ(result.exit_code, 0) << command.front() << ": " << result.errors;
    EXPECT_EQ(result.errors, "") << command.front();
  }

  toy::Home home_;
};

TEST_F(Completion, BashOffersCommandsOptionsAndExperiments) {
  EXPECT_EQ(offered("geoprior ru"), std::set<std::string>{"run"});
  EXPECT_THAT(offered("geoprior run toy-circle/di"),
              IsSupersetOf({"toy-circle/disc", "toy-circle/disc-large"}));
  EXPECT_THAT(offered("geoprior run toy-circle/disc --qu"), Contains("--quick"));
  EXPECT_EQ(offered("geoprior run --set a = b toy-circle/di"),
            offered("geoprior run toy-circle/di"));
  EXPECT_THAT(offered("geoprior check toy-circle/disc toy-circle/disc-"),
              Contains("toy-circle/disc-large"));
  EXPECT_THAT(offered("geoprior describe poly"), Contains("polygon"));
  EXPECT_THAT(offered("geoprior render x --view toy-c"), Contains("toy-circle/disc"));
  EXPECT_EQ(offered("geoprior export x --format g"), std::set<std::string>{"glb"});
  EXPECT_EQ(offered("geoprior export x --format = o"), std::set<std::string>{"obj"});
  // A number is no word that could be offered.
  EXPECT_EQ(offered("geoprior run x --threads ''"), std::set<std::string>{""});
}

TEST_F(Completion, BashOffersArgumentsAtTheirPlaces) {
  const std::set<std::string> nothing{""}, topics{"sketch", "skinning"};
  EXPECT_EQ(offered("geoprior new ''"), std::set<std::string>{"external"});
  EXPECT_EQ(offered("geoprior new external sk"), topics);
  EXPECT_EQ(offered("geoprior new external skinning ''"), nothing);
  // Values of options are no arguments.
  EXPECT_EQ(offered("geoprior new --out x external sk"), topics);
  EXPECT_EQ(offered("geoprior new --out = x external sk"), topics);
  EXPECT_THAT(offered("geoprior compare x toy-c"), Contains("toy-circle/disc"));
  EXPECT_EQ(offered("geoprior compare x y toy-c"), nothing);
}

// As names of files they are quoted, and a folder is followed by a slash and no blank.
TEST_F(Completion, BashKnowsWhatIsAFile) {
  for (const char* words : {"run ''", "compare x", "report x --out ''", "run x --out ''"}) {
    EXPECT_EQ(told("geoprior " + std::string(words)), "-o filenames\n") << words;
  }
  EXPECT_EQ(told("geoprior new external ''"), "\n");
}

TEST_F(Completion, FishOffersArgumentsAtTheirPlaces) {
  if (!find_program("fish")) GTEST_SKIP() << "no fish";
  const auto completion = home_.write("completion.fish", script("fish"));
  const auto first_words = [&](const std::string& line) {
    const ChildResult result =
        run_child({"fish", "-c",
                   "source '" + completion.string() + "'; complete -C 'geoprior " + line +
                       "' | string replace -r '\\t.*' '' >&2; true"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return lines_of(result.errors);
  };
  const std::set<std::string> topics{"sketch", "skinning"};
  EXPECT_EQ(first_words("new "), std::set<std::string>{"external"});
  EXPECT_EQ(first_words("new external sk"), topics);
  EXPECT_EQ(first_words("new --out x external sk"), topics);
  EXPECT_EQ(first_words("new external skinning "), std::set<std::string>{});
  EXPECT_THAT(first_words("check x toy-circle/disc-"), Contains("toy-circle/disc-large"));
}

// --format=ply and --format ply.
TEST_F(Completion, ZshTakesValuesBehindAnEqualsSign) {
  const std::string zsh = script("zsh");
  EXPECT_THAT(zsh, AllOf(HasSubstr("'--format=["), HasSubstr(":(vtp obj ply glb)'"),
                         HasSubstr("'2:topic:(assembly "), HasSubstr("'--quick[")));
}

TEST_F(Completion, ShellsAcceptTheirScripts) {
  expect_accepted({"bash", "-n"}, script("bash"));
  expect_accepted({"zsh", "-n"}, script("zsh"));
  expect_accepted({"fish", "--no-execute"}, script("fish"));
  EXPECT_EQ(home_.run("completion tcsh").code, 2);
}

TEST_F(Completion, EveryShellHasEveryOption) {
  const std::string zsh = script("zsh"), fish = script("fish"), bash = script("bash");
  for (const std::string option : {"quick", "variant", "resume", "fps", "rows", "format"}) {
    EXPECT_THAT(bash, HasSubstr("--" + option));
    EXPECT_THAT(zsh, ContainsRegex("--" + option + "=?\\["));
    EXPECT_THAT(fish, HasSubstr("-l " + option));
  }
}

// What the shells would read as their own: brackets, colons and quotes of a description.
TEST(CompletionScripts, DescriptionsAreQuoted) {
  const CommandWord option{{"--odd"}, "N", "it's [x]: \"a\\b\"", false, false, Offer::nothing, {}};
  const CommandTree program{"geoprior", "", "",
                            {},         {}, {{"make", "it's: x", "", {option}, {}, {}}}};
  EXPECT_THAT(zsh_completion(program, {}),
              AllOf(HasSubstr(R"('--odd=[it'\''s \[x\]\: "a\\b"]:N: ')"),
                    HasSubstr(R"('make:it'\''s\: x')")));
  EXPECT_THAT(fish_completion(program, {}), HasSubstr(R"(-l odd -x -d 'it\'s [x]: "a\\b"')"));
}

TEST_F(Completion, ManualHasEveryCommandAndLintsClean) {
  const Outcome manual = home_.run("manual");
  EXPECT_EQ(manual.code, 0) << manual.err;
  for (const char* section : {".SH NAME", ".SH SYNOPSIS", ".SH COMMANDS", ".SS run", ".SS doctor",
                              ".SH EXAMPLES", ".SH EXIT CODES", ".SH ENVIRONMENT"}) {
    EXPECT_THAT(manual.out, HasSubstr(std::string(section) + "\n"));
  }
  expect_accepted({"mandoc", "-T", "lint", "-W", "warning"}, manual.out);
}

TEST(Manual, TextIsNoMacroOfItsFormatter) {
  const CommandTree program{"geoprior", ".x a\\b", "", {}, {}, {{"make", "'so", "", {}, {}, {}}}};
  const std::string page = manual_page(program, "2025-01-31", "1.2.3");
  EXPECT_THAT(page,
              AllOf(HasSubstr(".TH GEOPRIOR 1 2025-01-31 \"geoprior 1.2.3\""),
                    HasSubstr("\\&.x a\\eb"), HasSubstr("\n\\&'so.\n"), Not(HasSubstr("\n'so"))));
}

}  // namespace
}  // namespace geoprior
