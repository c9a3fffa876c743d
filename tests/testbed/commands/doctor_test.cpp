// What `geoprior doctor` says of a machine: of homes with and without models, of Pythons that have
// modules and that have none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using toy::Outcome;

class Doctor : public ::testing::Test {
 protected:
  void SetUp() override { home_.write("data/human.glb", "a model"); }

  /// Sets variables for the program, as a shell does before a command.
  [[nodiscard]] Outcome run(const std::string& variables, const std::string& arguments) const {
    const std::string program = GEOPRIOR_TOY_PROGRAM;
    return home_.run(arguments, "env' " + variables + " '" + program);
  }

  /// A Python that knows one module of the program's, and is started in no time.
  [[nodiscard]] fs::path python_with(const std::string& modules,
                                     const std::string& name = "python") const {
    const fs::path file = home_.write(name, "#!/bin/sh\nprintf '" + modules + "' >&2\n");
    ::chmod(file.c_str(), 0755);
    return file;
  }

  /// Before other variables, where it does not matter what the machine's own has: asks that one.
  [[nodiscard]] std::string quick_python() const {
    const fs::path python = python_with("has python 3.0\\n", "bin/python3");
    return "GEOPRIOR_PYTHON='" + python.string() + "' PATH='" + python.parent_path().string() +
           "':/usr/bin:/bin ";
  }

  toy::Home home_;
};

json finding(const json& answer, const std::string& what) {
  for (const json& finding : answer["findings"]) {
    if (finding["what"] == what) return finding;
  }
  return {};
}

TEST_F(Doctor, EveryFindingSaysWhatItIsForAndHowToGetIt) {
  const Outcome outcome = home_.run("doctor --json");
  const json answer = json::parse(outcome.out);
  std::set<std::string> seen;
  bool ready = true;
  for (const json& finding : answer["findings"]) {
    seen.insert(finding["what"]);
    EXPECT_NE(finding["needed_for"], "") << finding;
    EXPECT_NE(finding["where"], "") << finding;
    EXPECT_NE(finding["get"], "") << finding;
    ready = ready && (finding["found"] || !finding["required"]);
  }
  for (const char* what :
       {"home folder", "model human.glb", "folder of runs", "display", "font", "python3",
        "python3 numpy", "python3 h5py", "python3 matplotlib", "python3 in PATH, numpy",
        "python3 in PATH, scipy", "ffmpeg", "blender"}) {
    EXPECT_TRUE(seen.contains(what)) << what;
  }
  EXPECT_EQ(answer["ready"], ready);
  EXPECT_EQ(outcome.code, ready ? 0 : 1) << outcome.err;
  EXPECT_EQ(finding(answer, "home folder")["where"], home_.root().string());
}

TEST_F(Doctor, WhatIsRequiredAndMissingIsTheExitCode) {
  const std::string all = "has python 3.0\\nhas numpy 1\\nhas h5py 2\\nhas matplotlib 3\\n";
  const auto with = [&](const std::string& modules) {
    return run("GEOPRIOR_PYTHON='" + python_with(modules).string() + "'", "doctor");
  };
  const Outcome enough = with(all);
  EXPECT_EQ(enough.code, 0) << enough.err;
  // An optional module is missing, and said to be.
  EXPECT_THAT(enough.err, HasSubstr("apt-get install python3-pandas"));
  fs::remove(home_.root() / "data/human.glb");
  const Outcome without = with("has python 3.0\\nhas numpy 1\\nhas matplotlib 3\\n");
  EXPECT_EQ(without.code, 1) << without.err;
  EXPECT_THAT(without.err, AllOf(HasSubstr("MISSING"), HasSubstr("python3-h5py"),
                                 HasSubstr("scripts/setup.sh")));
}

// What `run` could not make there is not found, whatever its permissions say.
TEST_F(Doctor, RunsNeedAFolderThatCanBeMade) {
  const auto of = [&](const fs::path& runs) {
    const std::string variables = quick_python() + "GEOPRIOR_RUNS='" + runs.string() + "'";
    return finding(json::parse(run(variables, "doctor --json").out), "folder of runs");
  };
  const json file = of(home_.write("a file", ""));
  EXPECT_EQ(file["found"], false);
  EXPECT_THAT(file["where"].get<std::string>(), HasSubstr("a file: folder cannot be made"));
  const fs::path place = home_.root() / "new/runs";
  EXPECT_EQ(of(place)["found"], true);
  EXPECT_FALSE(fs::exists(place.parent_path()));  // it was only tried
}

// A method from outside is started by the python3 of PATH, plots by another.
TEST_F(Doctor, ThePythonOfPathIsAskedForItself) {
  const std::string bare = (home_.root() / "bin/python3").string();
  const fs::path full =
      python_with("has python 3.0\\nhas numpy 1\\nhas h5py 2\\nhas matplotlib 3\\n", "full");
  const Outcome outcome =
      run(quick_python() + "GEOPRIOR_PYTHON='" + full.string() + "'", "doctor --json");
  const json answer = json::parse(outcome.out);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(finding(answer, "python3 numpy")["found"], true);
  const json in_path = finding(answer, "python3 in PATH, numpy");
  EXPECT_EQ(in_path["found"], false);
  EXPECT_EQ(in_path["where"], "not in " + bare);
  EXPECT_THAT(in_path["get"].get<std::string>(), HasSubstr("first in PATH"));
}

TEST_F(Doctor, AWrongPythonIsNotMendedByPackages) {
  const auto advice = [](const Outcome& outcome, const std::string& what) {
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    return finding(json::parse(outcome.out), what)["get"].get<std::string>();
  };
  const Outcome none = run(quick_python() + "GEOPRIOR_PYTHON=/bin/false", "doctor --json");
  EXPECT_THAT(advice(none, "python3"), HasSubstr("unset it"));
  EXPECT_THAT(advice(none, "python3 h5py"), Not(HasSubstr("apt-get")));
  // Packages are for Debian's own, which this one is not.
  EXPECT_THAT(advice(run(quick_python(), "doctor --json"), "python3 h5py"),
              AllOf(HasSubstr("for " + (home_.root() / "bin").string()),
                    HasSubstr("set GEOPRIOR_PYTHON to another")));
}

TEST_F(Doctor, WithoutAHomeItSaysSoAndGoesOn) {
  const Outcome outcome = run("GEOPRIOR_HOME=/proc", "doctor --json");
  EXPECT_EQ(outcome.code, 1);
  const json answer = json::parse(outcome.out);
  EXPECT_EQ(finding(answer, "home folder")["found"], false);
  EXPECT_EQ(finding(answer, "folder of runs")["found"], false);
  EXPECT_FALSE(finding(answer, "ffmpeg").is_null());
}

}  // namespace
}  // namespace geoprior
