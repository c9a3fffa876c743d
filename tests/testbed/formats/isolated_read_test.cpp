#include "testbed/formats/isolated_read.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
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

Bytes bytes_of(const std::string& text) {
  Bytes bytes(text.size());
  std::transform(text.begin(), text.end(), bytes.begin(), [](char c) { return std::byte(c); });
  return bytes;
}

std::string text_of(const Bytes& bytes) {
  std::string text;
  for (const std::byte b : bytes) text += static_cast<char>(b);
  return text;
}

/// Does what the request says.
Bytes obey(const Bytes& asked) {
  const std::string request = text_of(asked);
  static int calls = 0;
  ++calls;
  if (request == "child") return bytes_of(std::to_string(::getpid()));
  if (request == "calls") return bytes_of(std::to_string(calls));
  if (request == "complain") throw Error("is odd", "file.x: line 3", "even numbers");
  if (request == "crash") std::raise(SIGSEGV);
  if (request == "throw") throw std::runtime_error("of a library");
  if (request == "hang") ::pause();
  if (request == "grow") return Bytes(std::size_t{100} << 30);
  return asked;
}

std::string answer(ParsingChild& child, const std::string& request,
                   const ChildLimits& limits = kSmall) {
  return text_of(child.parse("strange.file", limits, bytes_of(request)));
}

std::string error_of_child(ParsingChild& child, const std::string& request,
                           const ChildLimits& limits = kSmall) {
  return error_of([&] { (void)child.parse("strange.file", limits, bytes_of(request)); });
}

using ParsingChildTest = IsolatedRead;

TEST_F(ParsingChildTest, OneChildParsesFileAfterFile) {
  ParsingChild child(obey);
  const std::string first = answer(child, "child");
  EXPECT_NE(first, std::to_string(::getpid()));
  for (const std::size_t size : {0UL, 1UL, 65536UL, 5000001UL}) {
    const std::string request(size, 'x');
    EXPECT_EQ(answer(child, request), request);
  }
  EXPECT_EQ(answer(child, "child"), first);
  EXPECT_EQ(answer(child, "calls"), "7");
}

TEST_F(ParsingChildTest, AfterWhateverWentWrongTheNextFileHasAChildOfItsOwn) {
  ParsingChild child(obey);
  const auto crashed = AllOf(HasSubstr("strange.file: is damaged, or made to crash"));
  const ChildLimits short_time{.memory = kSmall.memory, .seconds = 0.3};
  const auto fresh = [&] { EXPECT_EQ(answer(child, "calls"), "1"); };
  fresh();
  EXPECT_EQ(error_of_child(child, "complain"),
            Error("is odd", "file.x: line 3", "even numbers").what());
  fresh();
  EXPECT_THAT(error_of_child(child, "crash"), crashed);
  fresh();
  EXPECT_THAT(error_of_child(child, "throw"), crashed);
  fresh();
  EXPECT_THAT(error_of_child(child, "hang", short_time), HasSubstr("hang"));
  fresh();
  EXPECT_THAT(error_of_child(child, "grow"), HasSubstr("strange.file: is damaged"));
  fresh();
  ChildLimits stopped = kSmall;
  stopped.stop_requested = [] { return true; };
  EXPECT_EQ(error_of_child(child, "hang", stopped), "strange.file: was not read: stopped");
  fresh();
}

TEST_F(ParsingChildTest, AChildThatDiedInBetweenIsNotMissed) {
  ParsingChild child(obey);
  const pid_t first = std::stoi(answer(child, "child"));
  ASSERT_EQ(::kill(first, SIGKILL), 0);
  siginfo_t dead{};
  ASSERT_EQ(::waitid(P_PID, first, &dead, WEXITED | WNOWAIT), 0);
  EXPECT_NE(answer(child, "child"), std::to_string(first));
}

TEST_F(ParsingChildTest, LimitsAreThoseOfEachFile) {
  ParsingChild child(obey);
  const std::string long_one(std::size_t{20} << 20, 'x');
  EXPECT_THAT(error_of_child(child, long_one, {.memory = std::size_t{1} << 20, .seconds = 20}),
              HasSubstr("memory"));
  const std::string first = answer(child, "child", {.memory = std::size_t{64} << 20});
  EXPECT_EQ(answer(child, long_one), long_one);
  EXPECT_EQ(answer(child, "child"), first);
}

TEST_F(ParsingChildTest, AForkHasAChildOfItsOwn) {
  ParsingChild child(obey);
  const std::string ours = answer(child, "child");
  const Bytes theirs = read_in_child(
      "f", kSmall, [&] { return child.parse("strange.file", kSmall, bytes_of("child")); });
  EXPECT_NE(theirs, bytes_of(ours));
  EXPECT_EQ(answer(child, "child"), ours);
}

TEST_F(ParsingChildTest, LeavesNoProcessAndNoDescriptor) {
  const auto before = open_descriptors();
  for (int i = 0; i < 10; ++i) {
    ParsingChild child(obey);
    (void)answer(child, "calls");
    (void)error_of_child(child, i % 2 == 0 ? "crash" : "complain");
    (void)answer(child, "calls");
  }
  EXPECT_FALSE(has_children());
  EXPECT_EQ(open_descriptors(), before);
}

}  // namespace
}  // namespace geoprior::test
