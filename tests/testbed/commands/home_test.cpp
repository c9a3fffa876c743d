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
