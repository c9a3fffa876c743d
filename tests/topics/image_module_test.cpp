// The module of images is opened when a picture is: one that is missing or broken is named by what
// needs it, and by nothing else.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <link.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A tent, photographed: the scene leaves the photograph as a PNG file.
constexpr const char* kPhotograph = R"(title = "A photograph"
topic = "sketch"
seed  = 1
[scene]
known = { shape = "tent" }
[[variant]]
name   = "one-view"
method = "one-view"
[timing]
repetitions = 1
)";

/// A copy of the program in a folder of its own, without the module.
class ImageModule : public RunTest {
 protected:
  void SetUp() override {
    RunTest::SetUp();
    const std::vector<Topic> topics = all_topics();
    const auto is_sketch = [](const Topic& topic) { return topic.name == "sketch"; };
    if (std::none_of(topics.begin(), topics.end(), is_sketch)) GTEST_SKIP() << "without sketch";
    // Scratch folders may lie where nothing can be started.
    std::string name = GEOPRIOR_BINARY_DIR "/image-module-XXXXXX";
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    program_folder_ = name;
    fs::copy_file(GEOPRIOR_PROGRAM, program());
  }
  void TearDown() override {
    if (!program_folder_.empty()) fs::remove_all(program_folder_);
    RunTest::TearDown();
  }

  [[nodiscard]] fs::path program() const { return program_folder_ / "geoprior"; }
  [[nodiscard]] fs::path module() const { return program_folder_ / "geoprior_images.so"; }
  [[nodiscard]] std::string log() const { return text_of(folder() / "log"); }

  /// Its exit code.
  [[nodiscard]] int run(const std::vector<std::string>& arguments) const {
    const auto start = [&] { return become_program(program(), arguments); };
    return ProgramProcess(start, folder() / "log").wait();
  }

  /// Makes a photograph, which asks for the module. What the program says.
  [[nodiscard]] std::string refusal() const {
    const fs::path file = write_experiment("sketch/photograph", kPhotograph);
    EXPECT_EQ(run({"run", file, "--no-pictures", "--out", folder() / "run"}), 2) << log();
    return log();
  }

 private:
  fs::path program_folder_;
};

TEST_F(ImageModule, MissingIsNamedByWhatNeedsIt) {
  EXPECT_THAT(refusal(), HasSubstr(module().string() + ": cannot be read: No such file"));
}

TEST_F(ImageModule, MissingLeavesAllElse) {
  EXPECT_EQ(run({"--help"}), 0) << log();
  EXPECT_EQ(run({"list"}), 0) << log();
  const fs::path file = GEOPRIOR_SOURCE_DIR "/tests/topics/small/details.toml";
  EXPECT_EQ(run({"run", file, "--no-pictures", "--out", folder() / "details"}), 0) << log();
}

TEST_F(ImageModule, CutOffIsNamedAtAnyLength) {
  fs::copy_file(GEOPRIOR_IMAGE_MODULE, module());
  for (std::uintmax_t size = fs::file_size(module()) - 1; size > 0; size /= 8) {
    fs::resize_file(module(), size);
    const std::string problem = size < sizeof(ElfW(Ehdr)) ? "is no shared object" : "is cut off";
    EXPECT_THAT(refusal(), HasSubstr(module().string() + ": " + problem)) << size << " bytes";
  }
}

TEST_F(ImageModule, OtherFilesAreNamed) {
  std::ofstream(module()) << std::string(1000, '#');
  EXPECT_THAT(refusal(), HasSubstr(module().string() + ": is no shared object"));
  fs::copy_file(program(), module(), fs::copy_options::overwrite_existing);
  EXPECT_THAT(refusal(), HasSubstr(module().string() + ": cannot be opened: "));
  void* const other = ::dlopen("libz.so.1", RTLD_LAZY);
  link_map* at = nullptr;
  ASSERT_TRUE(other != nullptr && ::dlinfo(other, RTLD_DI_LINKMAP, &at) == 0) << ::dlerror();
  fs::copy_file(at->l_name, module(), fs::copy_options::overwrite_existing);
  EXPECT_THAT(refusal(), HasSubstr(module().string() + ": is no module of images"));
}

TEST_F(ImageModule, BesideTheProgramIsOpened) {
  fs::copy_file(GEOPRIOR_IMAGE_MODULE, module());
  const fs::path file = write_experiment("sketch/photograph", kPhotograph);
  EXPECT_LE(run({"run", file, "--no-pictures", "--out", folder() / "run"}), 1) << log();
}

}  // namespace
}  // namespace geoprior::test
