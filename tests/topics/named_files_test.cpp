// Options that name files and folders, each through the program: what is named is read, recorded,
// and decides the result.
#include "tests/topics/named_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "testbed/runner/journal/run_file.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/options/listing.h"
#include "testbed/topic.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

/// Keys of files and folders of the scene and the methods of a topic: "paper pattern.file".
std::vector<std::string> keys_of(const Topic& topic) {
  std::vector<std::string> keys;
  const auto add = [&](OptionSet& options) {
    for (const OptionRow& row : list_options([&](OptionVisitor& v) { options.visit(v); })) {
      if (row.type.starts_with("file") || row.type.starts_with("folder"))
        keys.push_back(topic.name + " " + row.key);
    }
  };
  add(*topic.default_scene());
  for (const MethodEntry& method : topic.methods) add(*method.default_options());
  return keys;
}

std::vector<std::string> keys_of_all() {
  std::vector<std::string> keys;
  for (const Topic& topic : all_topics()) {
    const std::vector<std::string> more = keys_of(topic);
    keys.insert(keys.end(), more.begin(), more.end());
  }
  return keys;
}

class NamedFiles : public RunTest, public ::testing::WithParamInterface<std::string> {
 protected:
  /// Runs the sample as the program does; returns its exit code.
  [[nodiscard]] int run_program(const NamedFile& sample, bool changed) const {
    const std::string topic = GetParam().substr(0, GetParam().find(' '));
    const fs::path file = write_experiment(
        topic + "/named", "title = \"A file of one's own\"\ntopic = \"" + topic + "\"\n[scene]\n" +
                              sample.scene + "[[variant]]\nname = \"v\"\nmethod = \"" +
                              sample.method + "\"\noptions = { " + sample.options +
                              " }\n[timing]\nrepetitions = 1\n");
    sample.write(file.parent_path(), changed);
    const fs::path out = folder() / (changed ? "changed" : "out");
    ProgramProcess program(
        [&] {
          return run_as_program(
              {"run", file.string(), "--no-pictures", "--threads", "1", "--out", out.string()},
              all_topics());
        },
        folder() / "log");
    const int code = program.wait();
    for (const std::string& name : sample.read)
      hashes_[name] = sha256_of_file(file.parent_path() / name);
    return code;
  }
  [[nodiscard]] RunRecord record(const NamedFile& sample, bool changed) const {
    EXPECT_EQ(run_program(sample, changed), 0) << log();
    return read_run_file(folder() / (changed ? "changed" : "out") / "run.h5");
  }
  [[nodiscard]] std::string log() const { return text_of(folder() / "log"); }

  mutable std::map<std::string, std::string> hashes_;  ///< of the files that are named
};

TEST_P(NamedFiles, AreReadRecordedAndDecideTheResult) {
  const auto found = named_files().find(GetParam());
  ASSERT_NE(found, named_files().end()) << "no sample of " << GetParam();
  const RunRecord first = record(found->second, false);
  for (const auto& [name, sha256] : hashes_) {
    const bool recorded =
        std::any_of(first.inputs.begin(), first.inputs.end(),
                    [&, hash = sha256](const auto& input) { return input.sha256 == hash; });
    EXPECT_TRUE(recorded) << name << " is not among the inputs of the record";
  }
  for (const CaseRecord& one : first.cases) {
    for (const std::string& warning : one.warnings)
      EXPECT_NE(log().find(warning), std::string::npos) << "not printed: " << warning;
  }
  if (!found->second.refusal.empty()) {
    EXPECT_EQ(run_program(found->second, true), 2);
    EXPECT_NE(log().find(found->second.refusal), std::string::npos) << log();
    return;
  }
  const RunRecord second = record(found->second, true);
  EXPECT_NE(second.content_sha256, first.content_sha256) << "another file, the same result";
}

INSTANTIATE_TEST_SUITE_P(
    Topics, NamedFiles, ::testing::ValuesIn(keys_of_all()), [](const auto& key) {
      std::string name = key.param;
      std::replace_if(
          name.begin(), name.end(),
          [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
      return name;
    });

}  // namespace
}  // namespace geoprior::test
