// Where the program finds itself, and how it calls Python.

#include "testbed/home.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "testbed/view/child_process.h"
#include "testbed/view/python.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Sets an environment variable for the life of a test.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() {
    if (old_) {
      ::setenv(name_, old_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

/// A home of its own with one script in results/.
class HomeWithScript {
 public:
  explicit HomeWithScript(const std::string& python_source) {
    std::string pattern = (fs::temp_directory_path() / "geoprior-home-XXXXXX").string();
    folder = ::mkdtemp(pattern.data());
    fs::create_directories(folder / "experiments");
    fs::create_directories(folder / "results");
    std::ofstream(folder / "results" / "script.py") << python_source;
  }
  ~HomeWithScript() { fs::remove_all(folder); }
  HomeWithScript(const HomeWithScript&) = delete;
  HomeWithScript& operator=(const HomeWithScript&) = delete;

  fs::path folder;
};

TEST(Home, IsFoundAboveTheExecutableOfABuild) {
  EXPECT_EQ(fs::canonical(geoprior_home()), fs::canonical(GEOPRIOR_SOURCE_DIR));
}

TEST(Home, VariableWinsAndIsChecked) {
  const HomeWithScript home("");
  {
    const Variable variable("GEOPRIOR_HOME", home.folder.string());
    EXPECT_EQ(geoprior_home(), home.folder);
  }
  const Variable variable("GEOPRIOR_HOME", "/proc");
  EXPECT_THAT(test::error_of([] { geoprior_home(); }), HasSubstr("GEOPRIOR_HOME=/proc"));
}

/// A folder like /usr with the program in it, in a folder like a clone.
class Prefix {
 public:
  Prefix() {
    std::string pattern = (fs::temp_directory_path() / "geoprior-prefix-XXXXXX").string();
    clone = ::mkdtemp(pattern.data());
    for (const char* folder : {"experiments", "results", "usr/bin",
                               "usr/share/geoprior/experiments", "usr/share/geoprior/results"}) {
      fs::create_directories(clone / folder);
    }
  }
  ~Prefix() { fs::remove_all(clone); }
  Prefix(const Prefix&) = delete;
  Prefix& operator=(const Prefix&) = delete;

  fs::path clone;
};

TEST(Home, OfAnInstalledProgramIsBesideItsBin) {
  const Prefix prefix;
  const Home installed = home_of(prefix.clone / "usr/bin/geoprior");
  EXPECT_EQ(installed.folder, prefix.clone / "usr/share/geoprior");
  EXPECT_TRUE(installed.installed);
  const Home built = home_of(prefix.clone / "build/release/geoprior");
  EXPECT_EQ(built.folder, prefix.clone);
  EXPECT_FALSE(built.installed);
  EXPECT_THAT(test::error_of([] { home_of("/proc/geoprior"); }), HasSubstr("GEOPRIOR_HOME"));
}

// The toy program, installed and started by a user: its home is read, the user's folder is written.
TEST(Home, OfAnInstalledProgramIsNotWrittenTo) {
  const Prefix prefix;
  const fs::path program = prefix.clone / "usr/bin/geoprior";
  fs::copy_file(GEOPRIOR_TOY_PROGRAM, program);
  fs::create_directories(prefix.clone / "usr/share/geoprior/experiments/toy-circle");
  std::ofstream(prefix.clone / "usr/share/geoprior/experiments/toy-circle/disc.toml")
      << toy::disc_experiment();
  const auto run = [&](const std::string& variables) {
    return run_child({"/bin/sh", "-c",
                      "unset GEOPRIOR_HOME GEOPRIOR_RUNS XDG_DATA_HOME HOME; exec env " +
                          variables + " '" + program.string() +
                          "' run toy-circle/disc --no-pictures"});
  };
  const fs::path user = prefix.clone / "user";
  EXPECT_EQ(run("HOME='" + user.string() + "'").exit_code, 0);
  EXPECT_TRUE(fs::is_directory(user / ".local/share/geoprior/results/runs/toy-circle/disc"));
  EXPECT_EQ(run("XDG_DATA_HOME='" + (user / "data").string() + "'").exit_code, 0);
  EXPECT_TRUE(fs::is_directory(user / "data/geoprior/results/runs/toy-circle/disc"));
  const ChildResult nowhere = run("XDG_DATA_HOME=relative");
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.errors, HasSubstr("HOME is not set"));
  EXPECT_TRUE(fs::is_empty(prefix.clone / "usr/share/geoprior/results"));
}

TEST(ChildProcess, ArgumentsArriveUnchanged) {
  const std::string awkward = "a b'c\"d$HOME`e;*\n";
  const ChildResult result = run_child(
      {"/bin/sh", "-c", R"(printf '%s' "$1" >&2; printf '%s' "$ADDED" >&2; exit 5)", "sh", awkward},
      {"ADDED=x y"});
  EXPECT_EQ(result.errors, awkward + "x y");
  EXPECT_EQ(result.exit_code, 5);
}

TEST(ChildProcess, MissingProgramIsAResultNotACrash) {
  const ChildResult result = run_child({"/no/such/program"});
  EXPECT_EQ(result.exit_code, 127);
  EXPECT_THAT(result.errors, HasSubstr("No such file"));
}

// Programs warn first and say last what they failed of.
TEST(ChildProcess, ReasonIsTheLastLineOfItsErrors) {
  const auto reason = [](const std::string& script) {
    return run_child({"/bin/sh", "-c", script}).reason();
  };
  EXPECT_EQ(reason("printf 'warning: old\\n\\nerror: no disk \\r\\n\\n' >&2; exit 3"),
            "error: no disk");
  EXPECT_EQ(reason("printf 'alone' >&2; exit 3"), "alone");
  EXPECT_EQ(reason("exit 3"), "ended with code 3");
  EXPECT_EQ(reason("kill -9 $$"), "was ended by signal 9");
}

TEST(Python, PassesArgumentsAndTheScriptsError) {
  const HomeWithScript home(
      "import sys\nimport h5py, numpy\nif sys.argv[1:] != ['a b', \"c'd\"]:\n"
      "    sys.exit('got ' + repr(sys.argv[1:]))\n");
  const Variable variable("GEOPRIOR_HOME", home.folder.string());
  EXPECT_NO_THROW(run_python("script", {"a b", "c'd"}));
  EXPECT_THAT(test::error_of([] { run_python("script", {"other"}); }), HasSubstr("got ['other']"));
  EXPECT_THAT(test::error_of([] { run_python("absent", {}); }), HasSubstr("absent.py"));
  const HomeWithScript warning(
      "import sys\nprint('DeprecationWarning: old', file=sys.stderr)\n"
      "raise ValueError('no such row')\n");
  const Variable other("GEOPRIOR_HOME", warning.folder.string());
  EXPECT_THAT(test::error_of([] { run_python("script", {}); }),
              AllOf(HasSubstr("ValueError: no such row"), Not(HasSubstr("DeprecationWarning"))));
}

}  // namespace
}  // namespace geoprior
