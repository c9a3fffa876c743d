#include "tests/testbed/run_fixture.h"

#include <unistd.h>

#include <array>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/spec/spec.h"
#include "tests/testbed/scratch_place.h"

namespace geoprior::test {

namespace fs = std::filesystem;

void RunTest::SetUp() {
  std::string name = (scratch_place() / "geoprior-test-XXXXXX").string();
  ASSERT_NE(::mkdtemp(name.data()), nullptr);
  folder_ = name;
  ::setenv("GEOPRIOR_RUNS", (folder_ / "runs").c_str(), 1);
  ::setenv("GEOPRIOR_HOME", GEOPRIOR_SOURCE_DIR, 1);
  clear_stop();
}

void RunTest::TearDown() {
  clear_stop();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

fs::path RunTest::write_experiment(const std::string& id, const std::string& text) const {
  const fs::path file = folder_ / "experiments" / (id + ".toml");
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
  return file;
}

fs::path RunTest::pendulum(const std::string& scene_lines, const std::string& options) const {
  std::string text =
      "title = \"A pendulum\"\ntopic = \"toy-pendulum\"\nseed = 1\n[scene]\n" + scene_lines + "\n";
  const std::vector<std::array<std::string, 2>> variants{
      {"exact", "closed-form"}, {"euler", "explicit-euler"}, {"midpoint", "implicit-midpoint"}};
  for (const auto& [name, method] : variants) {
    text += "[[variant]]\nname = \"" + name + "\"\nmethod = \"" + method + "\"\n";
    if (name != "exact") text += "reference = \"exact\"\n";
    if (!options.empty()) text += "options = { " + options + " }\n";
  }
  return write_experiment("toy-pendulum/swing", text);
}

fs::path RunTest::circle(const std::string& scene_lines) const {
  // The reference comes second: the runner must run it first.
  return write_experiment("toy-circle/disc",
                          "title = \"A disc\"\ntopic = \"toy-circle\"\nseed = 1\n[scene]\n" +
                              scene_lines +
                              "\n[[variant]]\nname = \"polygon\"\nmethod = \"polygon\"\n"
                              "role = \"baseline\"\nreference = \"exact\"\n"
                              "options = { segments = 6 }\n"
                              "[[variant]]\nname = \"exact\"\nmethod = \"exact\"\n"
                              "[timing]\nrepetitions = 3\n");
}

Experiment RunTest::load(const fs::path& file, const LoadRequest& request) {
  return load_experiment(file, toy::topics(), request);
}

ExecuteResult RunTest::run(const Experiment& experiment, const fs::path& out, bool resume) {
  ExecuteRequest request;
  request.out = out;
  request.resume = resume;
  request.only_declared = true;
  return execute(experiment, toy::topics(), request);
}

ToyProgram::ToyProgram(const std::vector<std::string>& arguments, const fs::path& output,
                       const std::function<void()>& in_child)
    : ProgramProcess(
          [&] {
            if (in_child) in_child();
            return become_program(GEOPRIOR_TOY_PROGRAM, arguments);
          },
          output) {}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::map<std::string, std::string> lasting_files(const fs::path& run_folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(run_folder)) {
    const std::string name = entry.path().lexically_relative(run_folder).string();
    if (!entry.is_regular_file() || name == "journal.jsonl" || name == "run.h5") continue;
    files[name] = text_of(entry.path());
  }
  return files;
}

std::string error_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return {};
}

}  // namespace geoprior::test
