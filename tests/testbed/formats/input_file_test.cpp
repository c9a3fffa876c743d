// Inputs are regular files: a pipe would be waited for, a device read for ever.

#include "testbed/formats/input_file.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "testbed/formats/atomic_file.h"
#include "testbed/formats/hdf5/content.h"
#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/spec/toml_tree.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

class InputFile : public RunTest {
 protected:
  /// A pipe that nobody writes to.
  [[nodiscard]] fs::path pipe(const std::string& name) const {
    const fs::path file = folder() / name;
    fs::create_directories(file.parent_path());
    EXPECT_EQ(::mkfifo(file.c_str(), 0600), 0);
    return file;
  }
  /// Exit code and words of the program.
  [[nodiscard]] std::pair<int, std::string> outcome(const std::vector<std::string>& command) const {
    ToyProgram program(command, folder() / "log");
    const int code = program.wait();
    return {code, text_of(folder() / "log")};
  }
};

TEST_F(InputFile, ThatIsAPipeADeviceOrAFolderIsRefusedByEveryReader) {
  const std::vector<std::pair<fs::path, std::string>> files{
      {pipe("pipe.obj"), "is a pipe (allowed: a file)"},
      {"/dev/zero", "is a device (allowed: a file)"},
      {folder(), "is a folder (allowed: a file)"},
      {folder() / "nothing", "cannot be read: No such file"}};
  for (const auto& [file, words] : files) {
    const auto refused = AllOf(HasSubstr(file.string()), HasSubstr(words));
    EXPECT_THAT(error_of([&] { (void)open_input_file(file); }), refused);
    EXPECT_THAT(error_of([&] { (void)read_whole_file(file); }), refused);
    EXPECT_THAT(error_of([&] { (void)sha256_of_file(file); }), refused);
    EXPECT_THAT(error_of([&] { (void)parse_toml_file(file); }), refused);
  }
  EXPECT_THAT(error_of([&] { (void)read_mesh_file(folder() / "pipe.obj"); }), HasSubstr("no file"));
  EXPECT_THAT(error_of([&] { (void)read_vtk_part(pipe("part.vtp")); }), HasSubstr("no file"));
  EXPECT_THAT(error_of([&] { (void)read_hdf5(pipe("run.h5")); }), HasSubstr("no file"));
}

TEST_F(InputFile, MayBeALinkToAFile) {
  write_file_atomically(folder() / "file", std::string_view("bytes"));
  fs::create_symlink(folder() / "file", folder() / "link");
  EXPECT_EQ(read_whole_file(folder() / "link"), "bytes");
}

TEST_F(InputFile, OfTheCommandLineThatIsAPipeIsRefused) {
  const auto [code, words] = outcome({"run", pipe("experiment.toml").string()});
  EXPECT_EQ(code, 2);
  EXPECT_THAT(words, HasSubstr("experiment.toml: is a pipe"));
}

TEST_F(InputFile, ThatIsTheReferenceOfACheckIsRefusedAsAPipe) {
  for (const char* name : {"home/experiments/toy-circle", "home/results/reference/toy-circle"}) {
    fs::create_directories(folder() / name);
  }
  fs::copy_file(circle(), folder() / "home/experiments/toy-circle/disc.toml");
  (void)pipe("home/results/reference/toy-circle/disc.txt");
  ::setenv("GEOPRIOR_HOME", (folder() / "home").c_str(), 1);
  const auto [code, words] = outcome({"check", "toy-circle/disc"});
  EXPECT_EQ(code, 2);
  EXPECT_THAT(words, HasSubstr("disc.txt: is a pipe"));
}

TEST_F(InputFile, ThatIsAJournalOrAPictureOfARunIsRefusedAsAPipe) {
  const fs::path run = folder() / "run";
  (void)pipe("run/journal.jsonl");
  EXPECT_THAT(outcome({"run", circle().string(), "--out", run.string(), "--resume"}).second,
              HasSubstr("journal.jsonl: is a pipe"));
  fs::remove_all(run);
  ASSERT_EQ(outcome({"run", circle().string(), "--out", run.string(), "--no-pictures"}).first, 0);
  (void)pipe("run/figure.png");
  const auto [code, words] = outcome({"report", run.string()});
  EXPECT_EQ(code, 2);
  EXPECT_THAT(words, HasSubstr("figure.png: is no file"));
}

}  // namespace
}  // namespace geoprior::test
