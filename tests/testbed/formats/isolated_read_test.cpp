#include "testbed/formats/isolated_read.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Bytes = std::vector<std::byte>;

constexpr ChildLimits kSmall{.memory = std::size_t{256} << 20, .seconds = 20};

Bytes pattern(std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 7 + i / 251);
  return bytes;
}

std::string error_in_child(const std::function<Bytes()>& read, const ChildLimits& limits = kSmall) {
  return error_of([&] { (void)read_in_child("strange.file", limits, read); });
}

bool has_children() { return ::waitpid(-1, nullptr, WNOHANG) == 0 || errno != ECHILD; }

std::ptrdiff_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return std::distance(begin(all), end(all));
}

int at_depth(volatile int* place, int depth) {
  volatile int here[1024] = {depth};
  return depth == 0 ? *place : at_depth(&here[depth % 1024], depth + 1) + here[0];
}

class IsolatedRead : public RunTest {};

TEST_F(IsolatedRead, GivesBackTheBytesOfTheChild) {
  for (const std::size_t size : {0UL, 1UL, 65536UL, 5000001UL}) {
    EXPECT_EQ(read_in_child("f", kSmall, [&] { return pattern(size); }), pattern(size));
  }
}

TEST_F(IsolatedRead, ThrowsTheErrorOfTheChildInTheSameWords) {
  const Error error("is odd", "file.x: line 3", "even numbers");
  EXPECT_EQ(error_in_child([&]() -> Bytes { throw error; }), error.what());
}

TEST_F(IsolatedRead, OfACrashIsAnErrorThatNamesTheFile) {
  const auto crash = AllOf(HasSubstr("strange.file: is damaged, or made to crash"));
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGKILL}) {
    EXPECT_THAT(error_in_child([&]() -> Bytes {
                  std::raise(signal);
                  return {};
                }),
                crash);
  }
  EXPECT_THAT(error_in_child([]() -> Bytes { ::_exit(0); }), crash);
  EXPECT_THAT(error_in_child([]() -> Bytes { throw std::runtime_error("of a library"); }), crash);
  EXPECT_THAT(error_in_child([]() -> Bytes {
                int place = 0;
                return Bytes(at_depth(&place, 1));
              }),
              crash);
}

TEST_F(IsolatedRead, OfAnEndlessLoopEndsAfterItsTime) {
  for (const bool busy : {true, false}) {
    const auto loop = [&]() -> Bytes {
      for (;;) {
        if (!busy) ::pause();
      }
    };
    EXPECT_THAT(error_in_child(loop, {.seconds = 0.3}),
                AllOf(HasSubstr("strange.file: is damaged"), HasSubstr("hang")));
  }
}

TEST_F(IsolatedRead, HasNoMoreMemoryThanItsLimit) {
  const auto at_once = [] { return Bytes(std::size_t{100} << 30); };
  [[maybe_unused]] const auto bit_by_bit = [] {
    std::vector<Bytes> all;
    for (int i = 0; i < 10000; ++i) all.emplace_back(1 << 20, std::byte{1});
    return all.back();
  };
  EXPECT_THAT(error_in_child(at_once), HasSubstr("strange.file: is damaged"));
#ifndef __SANITIZE_ADDRESS__  // which has no limit of memory
  EXPECT_THAT(error_in_child(at_once), HasSubstr("needs more than 256 MB"));
  EXPECT_THAT(error_in_child(bit_by_bit), HasSubstr("needs more than 256 MB"));
#endif
  const ChildLimits none{.memory = 10};
  EXPECT_THAT(error_of([&] { (void)read_in_child("f", none, [] { return pattern(11); }); }),
              HasSubstr("memory"));
}

TEST_F(IsolatedRead, IsStoppedBySignalsAndByThoseWhoAsk) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const auto ours = std::signal(signal, [](int) {});
    EXPECT_EQ(error_in_child([&]() -> Bytes {
                std::raise(signal);
                return {};
              }),
              "strange.file: was not read: stopped");
    std::signal(signal, ours);
  }
  ChildLimits limits = kSmall;
  limits.stop_requested = [] { return true; };
  EXPECT_EQ(error_in_child([]() -> Bytes { return ::pause(), Bytes(); }, limits),
            "strange.file: was not read: stopped");
}

TEST_F(IsolatedRead, WritesNoFileAndNoBufferTwice) {
  const std::string buffered = (folder() / "buffered").string();
  std::FILE* out = std::fopen(buffered.c_str(), "w");
  std::fputs("once", out);
  (void)read_in_child("f", kSmall, [] { return Bytes(); });
  std::fclose(out);
  EXPECT_EQ(read_whole_file(buffered), "once");

#ifndef __SANITIZE_ADDRESS__  // which has no limit of files
  const auto file = folder() / "new";
  EXPECT_THAT(error_in_child([&] {
                std::ofstream(file) << "text" << std::flush;
                return Bytes();
              }),
              HasSubstr("strange.file"));
  EXPECT_TRUE(!std::filesystem::exists(file) || std::filesystem::file_size(file) == 0);
#endif
}

// flock belongs to what was opened: a fork shares it.
TEST_F(IsolatedRead, LeavesALockToItsParentAndHoldsNone) {
  const std::string file = (folder() / "lock").string();
  const int first = ::open(file.c_str(), O_RDWR | O_CREAT, 0666);
  const int second = ::open(file.c_str(), O_RDWR);
  ASSERT_EQ(::flock(first, LOCK_EX | LOCK_NB), 0);
  (void)read_in_child("f", kSmall, [] { return Bytes(); });
  EXPECT_NE(::flock(second, LOCK_EX | LOCK_NB), 0);
  // The child has none of our descriptors: its lowest free one is the first behind the streams and
  // the pipe.
  const Bytes lowest = read_in_child("f", kSmall, [] {
    const int next = ::open("/dev/null", O_RDONLY);
    return Bytes{static_cast<std::byte>(next)};
  });
  EXPECT_LE(static_cast<int>(lowest.at(0)), 5);
  ::close(first);
  EXPECT_EQ(::flock(second, LOCK_EX | LOCK_NB), 0);
  ::close(second);
}

TEST_F(IsolatedRead, LeavesNoProcessAndNoDescriptor) {
  const auto before = open_descriptors();
  for (int i = 0; i < 20; ++i) {
    (void)read_in_child("f", kSmall, [] { return pattern(100000); });
    (void)error_in_child([]() -> Bytes { throw Error("x"); });
    (void)error_in_child([]() -> Bytes { std::abort(); });
    (void)error_in_child([]() -> Bytes { return ::pause(), Bytes(); }, {.seconds = 0.01});
  }
  EXPECT_FALSE(has_children());
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(IsolatedRead, WorksFromSeveralThreads) {
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([t] {
      for (std::size_t i = 0; i < 50; ++i) {
        const Bytes bytes = read_in_child("f", kSmall, [&] { return pattern(1000 * t + i); });
        EXPECT_EQ(bytes, pattern(1000 * t + i));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace geoprior::test
