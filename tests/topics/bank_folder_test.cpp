// The bank of sounds that a user has: a folder, from the program that writes it to the program that
// plays it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>

#include "testbed/formats/atomic_file.h"
#include "testbed/formats/wav_file.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/journal/sha256.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class BankFolder : public RunTest {
 protected:
  void SetUp() override {
    RunTest::SetUp();
    const std::vector<Topic> topics = all_topics();
    const auto is_sound = [](const Topic& topic) { return topic.name == "sound"; };
    if (std::none_of(topics.begin(), topics.end(), is_sound)) GTEST_SKIP() << "without sound";
  }

  /// What the program prints; fails unless it ends with 0.
  std::string program(const std::vector<std::string>& arguments) const {
    const auto start = [&] { return become_program(GEOPRIOR_PROGRAM, arguments); };
    const int code = ProgramProcess(start, folder() / "log").wait();
    std::string log = text_of(folder() / "log");
    EXPECT_EQ(code, 0) << log;
    return log;
  }

  /// A swatch that snaps, heard through a folder beside the experiment.
  RunRecord heard(const std::string& bank, const std::string& out) const {
    const fs::path file = write_experiment(
        "sound/bank", "title = \"A bank\"\ntopic = \"sound\"\n[scene]\nbank = \"" + bank +
                          "\"\nswatches = { rulings = [0.03], widths = [0.03] }\n[[variant]]\n"
                          "name = \"heard\"\nmethod = \"sound\"\noptions = { tail = 0.1 }\n");
    program({"run", file.string(), "--no-pictures", "--out", (folder() / out).string()});
    return read_run_file(folder() / out / "run.h5");
  }

  [[nodiscard]] fs::path beside(const std::string& name) const {
    return folder() / "experiments" / "sound" / name;
  }
  void write_sound(const fs::path& file, double level) const {
    const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(480, level, 0);
    write_file_atomically(file, std::span<const std::byte>(wav_bytes({48000, ramp})));
  }
};

std::string input_sha256(const RunRecord& record, const std::string& name) {
  for (const StoredFile& input : record.inputs) {
    if (input.name.ends_with(name)) return input.sha256;
  }
  return "not recorded";
}

TEST_F(BankFolder, IsPlayedFromTheFolderThatTheProgramWrote) {
  fs::create_directories(beside("my-bank").parent_path());
  program({"bank", beside("my-bank").string(), "--sizes", "1", "--variants", "1"});
  const RunRecord first = heard("my-bank", "first"), second = heard("my-bank", "second");
  EXPECT_EQ(first.content_sha256, second.content_sha256);
  std::size_t files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(beside("my-bank"))) {
    EXPECT_EQ(input_sha256(first, entry.path().filename()), sha256_of_file(entry.path()));
    ++files;
  }
  EXPECT_GT(files, 4U);
}

// One flap by hand: a change of its samples is heard.
TEST_F(BankFolder, OfAHandIsHeardAsItIs) {
  fs::create_directories(beside("hand"));
  write_sound(beside("hand") / "a.wav", 0.5);
  std::ofstream(beside("hand") / "bank.csv") << "file,kind,l_r,l_c\na.wav,flap,0.03,0.06\n";
  const std::string as_it_is = heard("hand", "as-it-is").content_sha256;
  write_sound(beside("hand") / "a.wav", -0.25);
  const std::string quieter = heard("hand", "quieter").content_sha256;
  EXPECT_NE(as_it_is, quieter);
}

TEST_F(BankFolder, IsAFolderInDescribe) {
  EXPECT_TRUE(std::regex_search(program({"describe", "sound"}), std::regex("\\n *bank +folder")));
}

}  // namespace
}  // namespace geoprior::test
