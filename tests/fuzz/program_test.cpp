// Mutated files of every kind that the program reads, given to the command that reads them.
//
// The number of mutations of all kinds together is about GEOPRIOR_FUZZ_PROGRAM, else 400, and of
// each kind at least five. A file that provokes a fault is kept in tests/fuzz/faults of the build
// folder.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <list>
#include <memory>
#include <thread>

#include "tests/fuzz/fuzzed_program.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/program_input.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::size_t mutations_asked() {
  const char* text = std::getenv("GEOPRIOR_FUZZ_PROGRAM");
  return text == nullptr ? 400 : std::strtoul(text, nullptr, 10);
}

/// Its part of all mutations, or the least that a kind gets.
std::size_t mutations_of(const InputKind& kind) {
  constexpr double kLeast = 5;
  double all = 0;
  for (const InputKind& each : input_kinds()) all += each.share;
  const double part = static_cast<double>(mutations_asked()) * kind.share / all;
  return static_cast<std::size_t>(std::ceil(std::max(part, kLeast)));
}

Files with(Files files, const std::string& name, const std::string& bytes) {
  files[name] = bytes;
  return files;
}

/// A command on a home of its own that has the mutated file.
class Attempt {
 public:
  Attempt(const ProgramInput& input, ReadingCommand command, std::string bytes)
      : command_(std::move(command)),
        bytes_(std::move(bytes)),
        home_(with(input.home, command_.file, bytes_)),
        process_([this] { return fuzzed_program(home_.path(), command_.arguments); },
                 home_.output()) {}

  /// What became of it, once it has ended; interrupts what takes long.
  std::optional<CommandEnd> poll() {
    if (takes_longer(kPatience) && !end_.interrupted) {
      end_.interrupted = true;
      process_.signal(SIGINT);
    }
    if (takes_longer(kHang) && !end_.hung) {
      end_.hung = true;
      process_.signal(SIGKILL);
    }
    const std::optional<int> code = process_.poll();
    if (!code) return std::nullopt;
    end_.code = *code;
    end_.text = text_of(home_.output());
    return end_;
  }

  /// Of the command's end and of what it left behind.
  [[nodiscard]] Fault fault(const CommandEnd& end) const {
    const Fault fault = fault_of(end);
    if (!fault.kind.empty()) return fault;
    if (const auto changed = home_.change_outside_results()) return {"wrote outside", *changed};
    if (end.code != 2 || end.interrupted) return {};
    const auto empty = home_.empty_run_folder();
    return empty ? Fault{"left an empty folder", *empty} : Fault{};
  }

  [[nodiscard]] const ReadingCommand& command() const { return command_; }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  /// Than so many seconds of its processor, or, where it waits for something, far more of the
  /// clock.
  [[nodiscard]] bool takes_longer(double seconds) const {
    constexpr double kOfClock = 30;
    const std::chrono::duration<double> passed = Clock::now() - start_;
    return process_.processor_seconds() > seconds || passed.count() > kOfClock * seconds;
  }

  ReadingCommand command_;
  std::string bytes_;
  ScratchHome home_;
  CommandEnd end_;
  Clock::time_point start_ = Clock::now();
  ProgramProcess process_;
};

std::string joined_words(const std::vector<std::string>& words) {
  std::string line = "geoprior";
  for (const std::string& word : words) line += " " + word;
  return line;
}

/// Keeps what provoked a fault; returns its name.
fs::path keep(const InputKind& kind, std::size_t number, const Attempt& attempt) {
  const fs::path folder = fs::path(GEOPRIOR_BINARY_DIR) / "tests/fuzz/faults";
  fs::create_directories(folder);
  const std::string extension = fs::path(attempt.command().file).extension().string();
  const fs::path file = folder / (kind.name + "-" + std::to_string(number) + extension);
  std::ofstream(file, std::ios::binary) << attempt.bytes();
  return file;
}

class LongProgramFuzz : public ::testing::TestWithParam<InputKind> {
 protected:
  /// Two commands at a time.
  void run_mutations(const ProgramInput& input, std::size_t count) {
    std::size_t next = 0;
    while (next < count || !running_.empty()) {
      while (next < count && running_.size() < kAtATime) start(input, next++);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      running_.remove_if([this](Running& each) { return judge(each); });
    }
  }

  /// How often each exit code came, with Ctrl-C apart, and each fault.
  [[nodiscard]] std::string tally() const {
    std::string text;
    for (const auto& counts : {ends_, faults_}) {
      for (const auto& [what, count] : counts) text += ", " + what + " " + std::to_string(count);
    }
    return text;
  }

 private:
  struct Running {
    std::size_t number;
    std::unique_ptr<Attempt> attempt;
  };
  static constexpr std::size_t kAtATime = 2;
  static constexpr std::size_t kShownFaults = 3;  ///< of a kind

  void start(const ProgramInput& input, std::size_t number) {
    RandomStream random(number, "program " + GetParam().name);
    const ReadingCommand& command = input.commands[below(random, input.commands.size())];
    running_.push_back(
        {number, std::make_unique<Attempt>(input, command, mutated(input.seeds, random))});
  }

  /// Whether it has ended.
  bool judge(Running& running) {
    const std::optional<CommandEnd> end = running.attempt->poll();
    if (!end) return false;
    ++ends_[end->interrupted ? "interrupted" : "exit " + std::to_string(end->code)];
    const Fault fault = running.attempt->fault(*end);
    if (!fault.kind.empty() && ++faults_[fault.kind] <= kShownFaults) tell(fault, *end, running);
    return true;
  }

  static void tell(const Fault& fault, const CommandEnd& end, const Running& running) {
    const Attempt& attempt = *running.attempt;
    constexpr std::size_t kShown = 1500;
    ADD_FAILURE() << fault.kind << ": " << fault.detail << "\n  mutation " << running.number
                  << " of " << attempt.command().file << "\n  "
                  << joined_words(attempt.command().arguments) << "\n  file kept as "
                  << keep(GetParam(), running.number, attempt) << "\n"
                  << end.text.substr(0, kShown);
  }

  std::list<Running> running_;
  std::map<std::string, std::size_t> ends_, faults_;
};

TEST_P(LongProgramFuzz, EndsInOrderWhateverIsInTheFile) {
  const ProgramInput input = GetParam().make();
  run_mutations(input, mutations_of(GetParam()));
  std::printf("%s%s\n", GetParam().name.c_str(), tally().c_str());
}

// What the harness runs is what the program does: with the files as they are every command
// succeeds, in a fork of this process and, the first, as a program of its own.
TEST_P(LongProgramFuzz, ReadsTheFileAsItIs) {
  const ProgramInput input = GetParam().make();
  const auto expect_success = [&](const ReadingCommand& command, const auto& body) {
    Files files = input.home;
    files.emplace(command.file, input.seeds.front());  // where it is not there yet
    const ScratchHome home(files);
    ProgramProcess process([&] { return body(home.path()); }, home.output());
    EXPECT_EQ(process.wait(), 0) << joined_words(command.arguments) << "\n"
                                 << text_of(home.output());
    EXPECT_EQ(home.change_outside_results(), std::nullopt);
  };
  std::set<std::vector<std::string>> done;
  for (const ReadingCommand& command : input.commands) {
    // Files that are there already are all read by one call.
    if (input.home.contains(command.file) && !done.insert(command.arguments).second) continue;
    expect_success(command,
                   [&](const fs::path& home) { return fuzzed_program(home, command.arguments); });
  }
  const ReadingCommand& first = input.commands.front();
  expect_success(first, [&](const fs::path& home) {
    enter(home);
    return become_program(first.program, first.arguments);
  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, LongProgramFuzz, ::testing::ValuesIn(input_kinds()),
                         [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace geoprior::test
