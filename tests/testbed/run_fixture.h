#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "testbed/runner/execute.h"
#include "testbed/runner/spec/spec.h"
#include "tests/testbed/program_process.h"

namespace geoprior::test {

/// A folder of its own for a test, below which experiments, runs and --out folders lie.
class RunTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Writes experiments/<id>.toml, so that the experiment gets this id.
  std::filesystem::path write_experiment(const std::string& id, const std::string& text) const;
  /// A pendulum of three variants with checkpoints, events, a table and an artifact.
  [[nodiscard]] std::filesystem::path pendulum(const std::string& scene_lines = {},
                                               const std::string& options = {}) const;
  /// A disc: exact, and a polygon that is compared with it.
  [[nodiscard]] std::filesystem::path circle(const std::string& scene_lines = {}) const;
  [[nodiscard]] static Experiment load(const std::filesystem::path& file,
                                       const LoadRequest& request = {});
  static ExecuteResult run(const Experiment& experiment, const std::filesystem::path& out,
                           bool resume = false);

 private:
  std::filesystem::path folder_;
};

/// `geoprior_toy` as a program of its own.
class ToyProgram : public ProgramProcess {
 public:
  /// @param output    file that gets stdout and stderr
  /// @param in_child  called before the program starts (limits, signals)
  ToyProgram(const std::vector<std::string>& arguments, const std::filesystem::path& output,
             const std::function<void()>& in_child = {});
};

/// Bytes of every file of a run that must not depend on how often it was interrupted: all but the
/// log, run.h5 (it holds times) and pictures.
std::map<std::string, std::string> lasting_files(const std::filesystem::path& run_folder);

std::string text_of(const std::filesystem::path& file);

/// The message of the Error that `body` throws; fails the test when it throws none.
std::string error_of(const std::function<void()>& body);

}  // namespace geoprior::test
