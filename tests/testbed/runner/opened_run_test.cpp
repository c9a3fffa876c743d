#include "testbed/runner/opened_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "testbed/view/export.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Turns one bit of a file.
void damage(const fs::path& file, std::size_t byte) {
  std::string bytes = read_whole_file(file);
  bytes.at(byte) = static_cast<char>(bytes[byte] ^ 1);
  write_file_atomically(file, std::string_view(bytes));
}

class OpenedRunTest : public ::testing::Test {
 protected:
  OpenedRunTest() { make_fake_run(folder_.path); }
  [[nodiscard]] fs::path path() const { return folder_.path; }
  [[nodiscard]] std::string open_error() const {
    return test::error_of([&] { const OpenedRun run(path()); });
  }

 private:
  TestFolder folder_;
};

TEST_F(OpenedRunTest, GivesTheRecordAndTheFilesOfARunAsItWasWritten) {
  const OpenedRun run(path());
  EXPECT_EQ(run.record().experiment_id, "test/boxes");
  const StoredFile& file = run.record().cases[0].variants[0].frames[1].files[0];
  EXPECT_EQ(run.file(file), path() / file.name);
}

TEST_F(OpenedRunTest, ARunFileThatIsNotTheRecordedOneIsNamed) {
  damage(path() / "run.h5", 1000);
  EXPECT_THAT(open_error(), StartsWith((path() / "run.h5").string() + ": is damaged"));
  EXPECT_THAT(open_error(), HasSubstr("--force"));
}

TEST_F(OpenedRunTest, WithoutARecordedChecksumARunIsNotRead) {
  const fs::path journal = path() / "journal.jsonl";
  const std::string whole = read_whole_file(journal);
  for (const std::string& text :
       {whole.substr(0, whole.size() / 2), whole.substr(0, whole.size() - 1), std::string(),
        std::string(10000, 'x') + "\n"}) {
    write_file_atomically(journal, std::string_view(text));
    EXPECT_THAT(open_error(), HasSubstr("its checksum is not in the journal")) << text.size();
  }
  fs::remove(journal);
  EXPECT_THAT(open_error(), HasSubstr("its checksum is not in the journal"));
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(OpenedRun(path(), Unverified::used).record().title, "Boxes");
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("--force"));
}

TEST_F(OpenedRunTest, AFrameOfAnotherVariantInItsPlaceIsNamed) {
  const OpenedRun run(path());
  const StoredFile& file = run.record().cases[0].variants[0].frames[2].files[0];
  const StoredFile& other = run.record().cases[0].variants[0].frames[0].files[0];
  fs::copy_file(path() / other.name, path() / file.name, fs::copy_options::overwrite_existing);
  EXPECT_THAT(test::error_of([&] { (void)run.file(file); }),
              StartsWith((path() / file.name).string() + ": is damaged or another file"));
  EXPECT_THAT(test::error_of([&] { export_run(run, "obj", path() / "out"); }),
              HasSubstr(file.name));
  ::testing::internal::CaptureStderr();
  export_run(OpenedRun(path(), Unverified::used), "obj", path() / "out");
  const std::string told = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(told, HasSubstr(file.name));
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1);
}

TEST_F(OpenedRunTest, AMissingFrameIsNamedWithForceToo) {
  const StoredFile file = OpenedRun(path()).record().cases[0].variants[1].frames[0].files[0];
  fs::remove(path() / file.name);
  for (const Unverified unverified : {Unverified::refused, Unverified::used}) {
    EXPECT_THAT(
        test::error_of([&] { export_run(OpenedRun(path(), unverified), "obj", path() / "out"); }),
        HasSubstr(file.name));
  }
}

}  // namespace
}  // namespace geoprior
