// What happens when the disk does not take any more.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/system_reason.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

class Disk : public RunTest {
 protected:
  [[nodiscard]] fs::path out() const { return folder() / "out"; }
  [[nodiscard]] fs::path log() const { return folder() / "log"; }
  /// Runs the toy where no file can grow past `bytes`.
  int run_limited(const fs::path& file, rlim_t bytes) const {
    ToyProgram program({"run", file.string(), "--no-pictures", "--out", out().string()}, log(),
                       [bytes] {
                         ::signal(SIGXFSZ, SIG_DFL);  // as a shell starts a program
                         const rlimit limit{bytes, bytes};
                         ::setrlimit(RLIMIT_FSIZE, &limit);
                       });
    return program.wait();
  }
};

// The limits hit the log in the middle of the run, a frame's file, and run.h5 at the end.
TEST_F(Disk, FullIsOneErrorAndARunThatCanBeResumed) {
  const auto file = pendulum("frames = 6");
  const ExecuteResult undisturbed = run(load(file), folder() / "undisturbed");
  const auto log_size = fs::file_size(undisturbed.folder / "journal.jsonl");
  ASSERT_GT(fs::file_size(undisturbed.folder / "run.h5"), log_size + 2000);
  for (const rlim_t bytes : {rlim_t{log_size / 2}, rlim_t{1500}, rlim_t{log_size + 1000}}) {
    fs::remove_all(out());
    EXPECT_EQ(run_limited(file, bytes), 2) << text_of(log());
    EXPECT_THAT(text_of(log()), HasSubstr("File too large")) << bytes;
    EXPECT_FALSE(fs::exists(out() / "run.h5"));
    std::error_code absent;  // a run without a first frame leaves no folder
    for (const auto& entry : fs::recursive_directory_iterator(out(), absent)) {
      EXPECT_FALSE(is_temporary_file(entry.path())) << entry.path();
    }
    const ExecuteResult resumed = run(load(file), out(), fs::exists(out() / "journal.jsonl"));
    EXPECT_EQ(resumed.record.content_sha256, undisturbed.record.content_sha256);
    EXPECT_EQ(lasting_files(out()), lasting_files(undisturbed.folder));
  }
}

// A sound is written at the end, and is larger than all else where there are no checkpoints.
TEST_F(Disk, FullWhileASoundIsWrittenIsOneErrorAndARunThatCanBeResumed) {
  const auto file = pendulum("frames = 6", "step_s = 1e-4, checkpoints = false");
  const ExecuteResult undisturbed = run(load(file), folder() / "undisturbed");
  rlim_t sound = 0, others = 0;
  for (const auto& entry : fs::recursive_directory_iterator(undisturbed.folder)) {
    if (!entry.is_regular_file() || entry.path().filename() == "run.h5") continue;
    rlim_t& largest = entry.path().extension() == ".wav" ? sound : others;
    largest = std::max<rlim_t>(largest, entry.file_size());
  }
  ASSERT_GT(sound, others);
  EXPECT_EQ(run_limited(file, sound - 1), 2) << text_of(log());
  EXPECT_THAT(text_of(log()), HasSubstr("File too large"));
  EXPECT_THAT(text_of(log()), HasSubstr(".wav"));
  for (const auto& entry : fs::recursive_directory_iterator(out())) {
    EXPECT_FALSE(is_temporary_file(entry.path())) << entry.path();
    EXPECT_NE(entry.path().extension(), ".wav");
  }
  const ExecuteResult resumed = run(load(file), out(), true);
  EXPECT_EQ(resumed.record.content_sha256, undisturbed.record.content_sha256);
  EXPECT_EQ(lasting_files(out()), lasting_files(undisturbed.folder));
}

TEST_F(Disk, UnwritableFolderIsOneErrorBeforeAnythingIsComputed) {
  const fs::path nowhere = "/proc/geoprior-run";  // not even root can make a folder there
  ToyProgram program({"run", pendulum().string(), "--no-pictures", "--out", nowhere.string()},
                     log());
  EXPECT_EQ(program.wait(), 2);
  EXPECT_THAT(text_of(log()), HasSubstr(nowhere.string()));
  EXPECT_THAT(text_of(log()), HasSubstr("cannot be made"));
}

TEST_F(Disk, FolderWithoutPermissionIsNamed) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directories(out());
  fs::permissions(out(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(error_of([&] { run(load(circle()), out()); }), HasSubstr("not writable"));
  fs::permissions(out(), fs::perms::owner_all);
}

TEST_F(Disk, FullDeviceIsSaidInWords) {
  const int full = ::open("/dev/full", O_WRONLY);
  ASSERT_GE(full, 0);
  EXPECT_THAT(error_of([&] { write_all(full, "x", "frame.vtp"); }),
              HasSubstr("frame.vtp: cannot be written: disk full"));
  ::close(full);
  EXPECT_THAT(system_reason(EACCES), HasSubstr("not writable"));
}

TEST_F(Disk, FailedWriteKeepsTheOldFile) {
  const fs::path file = folder() / "file";
  write_file_atomically(file, std::string_view("old"));
  {
    PendingFile pending(file);
    std::ofstream(pending.temporary()) << "new, but never committed";
  }
  EXPECT_EQ(text_of(file), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder()), {}), 1);
}

}  // namespace
}  // namespace geoprior::test
