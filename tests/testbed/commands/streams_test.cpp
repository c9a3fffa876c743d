// What the program does with its standard streams and with signals: nothing is lost, nothing is
// believed written that was not, and a stop acts at once.

#include "testbed/streams.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "testbed/commands/console.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/run_file.h"
#include "testbed/runner/run_folder.h"
#include "tests/testbed/await.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

/// Of what a stop has to end at once: what it interrupts would last far longer than any machine
/// takes to stop.
constexpr std::chrono::seconds kAtOnce{60};
const std::string kSlowToLoad = "load_delay_ms = 600000";

class Streams : public RunTest {
 protected:
  [[nodiscard]] fs::path out() const { return folder() / "out"; }
  [[nodiscard]] fs::path log() const { return folder() / "log"; }
  [[nodiscard]] std::vector<std::string> run_of(const fs::path& file) const {
    return {"run", file.string(), "--no-pictures", "--out", out().string()};
  }

  /// Waits until the file has the text.
  static void await(const fs::path& file, const std::string& text) {
    ASSERT_TRUE(test::await([&] { return text_of(file).find(text) != std::string::npos; }))
        << file << " has no " << text;
  }

  /// Exit code after a stop, which must come at once.
  static int stop(ToyProgram& program, int number = SIGTERM) {
    const auto told = std::chrono::steady_clock::now();
    program.signal(number);
    const int code = program.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - told, kAtOnce);
    return code;
  }

  [[nodiscard]] std::ptrdiff_t count_in(const fs::path& below) const {
    return std::distance(fs::directory_iterator(folder() / below), {});
  }
};

TEST_F(Streams, ClosedOnesAreNoFilesOfTheRun) {
  const auto file = pendulum("frames = 6\nframe_delay_ms = 20");
  for (const int stream : {0, 1, 2}) {
    ToyProgram program(run_of(file), log(), [stream] { ::close(stream); });
    await(out() / "journal.jsonl", "\"kind\":\"frame\"");
    program.signal(SIGKILL);
    EXPECT_EQ(program.wait(), -SIGKILL);
    const ExecuteResult resumed = run(load(file), out(), true);
    const ExecuteResult undisturbed = run(load(file), folder() / "undisturbed");
    EXPECT_EQ(lasting_files(out()), lasting_files(undisturbed.folder)) << stream;
    EXPECT_EQ(resumed.record.content_sha256, undisturbed.record.content_sha256);
    fs::remove_all(out());
    fs::remove_all(undisturbed.folder);
  }
}

TEST_F(Streams, ResultsThatCannotBeWrittenAreOneErrorWithItsReason) {
  const auto to_full_disk = [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  const auto to_nobody = [] {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) == 0) ::dup2(ends[1], STDOUT_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
  };
  const auto to_closed = [] { ::close(STDOUT_FILENO); };
  const std::vector<std::pair<std::function<void()>, std::string>> sinks{
      {to_full_disk, "disk full: No space left on device"},
      {to_nobody, "Broken pipe"},
      {to_closed, "Bad file descriptor"}};
  const std::vector<std::vector<std::string>> commands{
      {"list", "--json"}, {"describe", "polygon", "--markdown"}, {"--help"}, {"--version"}};
  for (const auto& [sink, reason] : sinks) {
    for (const auto& command : commands) {
      ToyProgram program(command, log(), sink);
      EXPECT_EQ(program.wait(), 2) << command.front();
      EXPECT_EQ(text_of(log()), "error: standard output: cannot be written: " + reason + "\n");
    }
  }
}

TEST_F(Streams, RunWhoseJsonCannotBeWrittenIsThereAndTheExitCodeIsTwo) {
  std::vector<std::string> command = run_of(circle());
  command.emplace_back("--json");
  ToyProgram program(command, log(), [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); });
  EXPECT_EQ(program.wait(), 2);
  EXPECT_THAT(text_of(log()), HasSubstr("error: standard output: cannot be written: disk full"));
  EXPECT_TRUE(fs::exists(out() / "run.h5"));
}

TEST_F(Streams, WordsThatNobodyReadsStopNothing) {
  ToyProgram program(run_of(circle()), log(), [] {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) == 0) ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
  });
  EXPECT_EQ(program.wait(), 0);
  EXPECT_TRUE(fs::exists(out() / "run.h5"));
}

TEST_F(Streams, TextForPeopleIsPrintable) {
  EXPECT_EQ(printable("90°, naïve, 漢字 𝄞\n\tend"), "90°, naïve, 漢字 𝄞\n\tend");
  EXPECT_EQ(printable("a\xff\xfe\x62"), "a\\xff\\xfe\x62");
  EXPECT_EQ(printable("\xc3"), "\\xc3") << "cut off";
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf") << "overlong";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "surrogate";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond U+10FFFF";
  EXPECT_EQ(printable("bell\x07, back\b, \r, \x7f, \xc2\x9b"),
            "bell\\x07, back\\x08, \\x0d, \\x7f, \\xc2\\x9b");
  EXPECT_EQ(printable("\033[31;1mred\033[0m"), "\\x1b[31;1mred\\x1b[0m");
  EXPECT_EQ(printable("\033]0;title\007\033[2J"), "\\x1b]0;title\\x07\\x1b[2J");
  EXPECT_EQ(printable("a \u202e b \u2066\u200f\u2029"),
            "a \\xe2\\x80\\xae b \\xe2\\x81\\xa6\\xe2\\x80\\x8f\\xe2\\x80\\xa9")
      << "would be read from right to left, or on another line";
  EXPECT_EQ(printable_length("\u202e"), 0U);
  EXPECT_EQ(printable_length("\u2027"), 3U);
}

TEST_F(Streams, LinesForPeopleHaveOurColoursAndNoOthers) {
  ::testing::internal::CaptureStderr();
  say("\033[31;1mfailed\033[0m \033[32mok\033[0m, \033[8mhidden\033[30;40m \u202e");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "\033[31;1mfailed\033[0m \033[32mok\033[0m, \\x1b[8mhidden\\x1b[30;40m "
            "\\xe2\\x80\\xae\n");
}

TEST_F(Streams, JsonIsTheSameInAsciiWhereATerminalWouldObeyIt) {
  const auto printed = [](const std::string& text) {
    ::testing::internal::CaptureStdout();
    print_json({{"text", text}});
    return ::testing::internal::GetCapturedStdout();
  };
  EXPECT_EQ(printed("90°\033"), "{\n  \"text\": \"90°\\u001b\"\n}\n");
  EXPECT_EQ(printed("90° \u202e \u0085"), "{\n  \"text\": \"90\\u00b0 \\u202e \\u0085\"\n}\n");
}

TEST_F(Streams, PrintableTextGivesTheBytesBack) {
  for (const std::string bytes :
       {"", "90°", "a\xff\xfe\x62", "\x07\xc2\x9b", "\u202e", "\\x", "\\xg1"}) {
    EXPECT_EQ(from_printable(printable(bytes)), bytes);
  }
}

TEST_F(Streams, NamesThatAreNoUtf8AreNamesLikeOthers) {
  const fs::path strange = folder() / "caf\xe9 \xff\xfe";
  fs::create_directories(strange);
  std::ofstream(strange / "disc\xe9.toml") << "id = \"toy-circle/disc\"\n" << text_of(circle());
  const fs::path run_folder = strange / "run\x80";
  ToyProgram program({"run", (strange / "disc\xe9.toml").string(), "--out", run_folder.string(),
                      "--no-pictures", "--json"},
                     log());
  ASSERT_EQ(program.wait(), 0) << text_of(log());
  EXPECT_TRUE(fs::exists(run_folder / "run.h5"));
  const std::string text = text_of(log());
  EXPECT_THAT(text, HasSubstr("caf\\xe9 \\xff\\xfe")) << "on stderr";
  EXPECT_EQ(printable(text), text) << "all of it is UTF-8";
  EXPECT_TRUE(nlohmann::json::accept(text.substr(text.find("{\n")))) << text;
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"report", run_folder.string()},
                                             {"export", run_folder.string(), "--format", "obj"},
                                             {"run", (strange / "disc\xe9.toml").string(), "--out",
                                              run_folder.string(), "--resume", "--no-pictures"}}) {
    ToyProgram view(command, log());
    EXPECT_EQ(view.wait(), 0) << command.front() << ": " << text_of(log());
    EXPECT_EQ(printable(text_of(log())), text_of(log()));
  }
  EXPECT_TRUE(fs::exists(run_folder / "report.html"));
}

TEST_F(Streams, ArgumentsThatAreNoUtf8AreNamedEscaped) {
  const std::string file = circle().string();
  const std::vector<std::vector<std::string>> commands{
      {"run", "no\xff/experiment"},
      {"run", file, "--variant", "poly\xffgon"},
      {"run", file, "--set", "scene.radius_m=\"\xff\""},
      {"run", file, "--set", "sc\xff=1"},
      {"run", file, "--set", "title=\xff"},
      {"describe", "\xff"},
      {"report", "\xff"},
      {"list", "--\xff"}};
  for (const auto& command : commands) {
    ToyProgram program(command, log());
    EXPECT_EQ(program.wait(), 2) << text_of(log());
    EXPECT_THAT(text_of(log()), HasSubstr("\\xff"));
    EXPECT_EQ(printable(text_of(log())), text_of(log()));
  }
  ToyProgram turned({"run", file, "--set", "title=\u202eb"}, log());
  EXPECT_EQ(turned.wait(), 2);
  EXPECT_THAT(text_of(log()), HasSubstr("is no printable UTF-8: \\xe2\\x80\\xaeb"));
}

class Stop : public Streams {
 protected:
  /// A Python that has everything and draws for a minute; `on_term`: what the shell does then.
  void use_slow_python(const std::string& on_term) {
    const fs::path python = folder() / "python";
    const std::string drawing = "echo half > '" + (folder() / "half").string() + "'\n" + on_term +
                                "\necho $$ > '" + pid_file().string() + "'\n" +
                                "i=0; while [ $i -lt 6000 ]; do sleep 0.1; i=$((i+1)); done\n";
    write_file_atomically(python,
                          "#!/bin/sh\nfor a; do [ \"$a\" = -c ] && exit 0; done\n" + drawing);
    fs::permissions(python, fs::perms::owner_all);
    ::setenv("GEOPRIOR_PYTHON", python.c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("GEOPRIOR_PYTHON");
    Streams::TearDown();
  }
  [[nodiscard]] fs::path pid_file() const { return folder() / "pid"; }
  /// Whether the child still runs; one that nobody has waited for yet (a zombie) does not.
  [[nodiscard]] bool child_runs() const {
    const std::string pid = text_of(pid_file());
    const std::string status = text_of("/proc/" + pid.substr(0, pid.find('\n')) + "/status");
    return !status.empty() && status.find("State:\tZ") == std::string::npos;
  }
};

TEST_F(Stop, WhileLoadingActsAtOnceAndTheRunGoesOn) {
  const auto file = pendulum(kSlowToLoad);
  for (const bool resumed : {false, true}) {
    std::vector<std::string> command = run_of(file);
    if (resumed) command.emplace_back("--resume");
    ToyProgram program(command, log());
    await(log(), "loading");
    EXPECT_EQ(stop(program, resumed ? SIGINT : SIGTERM), 2);
    EXPECT_THAT(text_of(log()),
                AllOf(HasSubstr("stopped; go on with:  geoprior run"), HasSubstr("--resume\n")));
  }
  EXPECT_THAT(text_of(out() / "journal.jsonl"), Not(HasSubstr("\"kind\":\"case\"")));
}

TEST_F(Stop, TellsTheCommandThatGoesOnAsAShellReadsIt) {
  const fs::path file = folder() / "d\xe9j\\a 'vu.toml";
  fs::copy_file(pendulum(kSlowToLoad), file);
  ToyProgram program(run_of(file), log());
  await(log(), "loading");
  EXPECT_EQ(stop(program), 2);
  EXPECT_THAT(text_of(log()), HasSubstr(R"(/d\xe9j\\a \'vu.toml' --no-pictures --out)"));
}

TEST_F(Stop, WhileLoadingAnInputTellsOfTheRunThatNeedsIt) {
  write_experiment("toy-pendulum/base",
                   "title = \"b\"\ntopic = \"toy-pendulum\"\n[scene]\n" + kSlowToLoad +
                       "\n[[variant]]\nname = \"v\"\nmethod = \"closed-form\"\n");
  const auto file = pendulum("input = \"run:toy-pendulum/base/v\"");
  ToyProgram program(run_of(file), log());
  await(log(), "loading");
  EXPECT_EQ(stop(program), 2);
  EXPECT_THAT(text_of(log()), HasSubstr("--out " + out().string() + " --resume\n"));
}

TEST_F(Stop, WhileDrawingTellsTheChildAndLeavesNoHalfFile) {
  ToyProgram whole(run_of(circle()), log());
  ASSERT_EQ(whole.wait(), 0);
  const auto files = lasting_files(out());
  use_slow_python("trap 'rm -f \"" + (folder() / "half").string() + "\"; exit 143' TERM");
  ToyProgram program({"report", out().string()}, log());
  await(pid_file(), "\n");
  EXPECT_EQ(stop(program), 2);
  EXPECT_EQ(text_of(log()), "stopped\n");
  EXPECT_FALSE(fs::exists(folder() / "half")) << "the child was not waited for";
  EXPECT_FALSE(child_runs());
  EXPECT_EQ(lasting_files(out()), files);
}

TEST_F(Stop, WhileThePicturesOfARunAreDrawnTheRunIsComplete) {
  use_slow_python("exec 2>&-  # waited for although it says nothing more");
  const auto file = circle(  // one plain panel: drawing it is most of what this costs
      "motion = { frames = 1 }\n[figure_view]\nshading = \"flat\"\nvariants = [\"polygon\"]");
  ToyProgram program({"run", file.string(), "--out", out().string()}, log());
  await(pid_file(), "\n");
  EXPECT_EQ(stop(program), 2);
  EXPECT_THAT(text_of(log()), HasSubstr("stopped; go on with:"));
  EXPECT_TRUE(fs::exists(out() / "run.h5"));
  for (const auto& entry : fs::recursive_directory_iterator(out())) {
    EXPECT_FALSE(is_temporary_file(entry.path())) << entry.path();
  }
}

TEST_F(Stop, ForTheSecondTimeEndsAtOnceWithTheChild) {
  ToyProgram whole(run_of(circle()), log());
  ASSERT_EQ(whole.wait(), 0);
  const fs::path told = folder() / "told";
  use_slow_python("trap 'echo > \"" + told.string() + "\"' TERM");  // and goes on
  ToyProgram program({"report", out().string()}, log());
  await(pid_file(), "\n");
  program.signal(SIGTERM);
  await(told, "\n");
  EXPECT_EQ(stop(program), -SIGTERM);
  EXPECT_TRUE(test::await([&] { return !child_runs(); }));
}

class SharedInput : public Streams {
 protected:
  void SetUp() override {
    Streams::SetUp();
    base_ = pendulum("frames = 20\nframe_delay_ms = 50");
  }
  /// An experiment that needs the pendulum.
  [[nodiscard]] fs::path needy(const std::string& name) const {
    return write_experiment("toy-pendulum/" + name,
                            "title = \"n\"\ntopic = \"toy-pendulum\"\n[scene]\n"
                            "input = \"run:toy-pendulum/swing/exact\"\n"
                            "[[variant]]\nname = \"v\"\nmethod = \"closed-form\"\n");
  }
  [[nodiscard]] std::vector<std::string> run_of_needy(const std::string& name) const {
    return {"run", needy(name).string(), "--no-pictures", "--out", (folder() / name).string()};
  }
  [[nodiscard]] fs::path log_of(const std::string& name) const {
    return folder() / (name + ".log");
  }
  [[nodiscard]] fs::path base() const { return base_; }
  [[nodiscard]] std::string input_of(const std::string& name) const {
    const RunRecord record = read_run_file(folder() / name / "run.h5");
    return record.inputs.at(0).sha256;
  }

 private:
  fs::path base_;
};

TEST_F(SharedInput, IsMadeOnceForTwoProgramsThatNeedItTogether) {
  ToyProgram first(run_of_needy("first"), log_of("first"));
  ToyProgram second(run_of_needy("second"), log_of("second"));
  EXPECT_EQ(first.wait(), 0) << text_of(log_of("first"));
  EXPECT_EQ(second.wait(), 0) << text_of(log_of("second"));
  EXPECT_EQ(count_in("runs/toy-pendulum/swing"), 1);
  EXPECT_EQ(input_of("first"), input_of("second"));
  const std::string words = text_of(log_of("first")) + text_of(log_of("second"));
  const std::size_t made = words.find("toy-pendulum/swing is needed first");
  EXPECT_NE(made, std::string::npos);
  EXPECT_EQ(words.find("toy-pendulum/swing is needed first", made + 1), std::string::npos);
  EXPECT_THAT(words, HasSubstr("waiting for "));
}

TEST_F(SharedInput, IsWaitedForWhereItIsARunOfItsOwn) {
  ToyProgram own({"run", base().string(), "--no-pictures"}, log_of("own"));
  while (!find_unfinished_run(load(base()))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  await(*find_unfinished_run(load(base())) / "journal.jsonl", "\"kind\":\"frame\"");
  ToyProgram second(run_of_needy("second"), log_of("second"));
  EXPECT_EQ(own.wait(), 0);
  EXPECT_EQ(second.wait(), 0) << text_of(log_of("second"));
  EXPECT_THAT(text_of(log_of("second")),
              AllOf(HasSubstr("waiting for " + (folder() / "runs/toy-pendulum/swing").string()),
                    HasSubstr("another program is making"), Not(HasSubstr("needed first"))));
  EXPECT_EQ(count_in("runs/toy-pendulum/swing"), 1);
}

TEST_F(SharedInput, IsTakenOverFromAProgramThatWasKilled) {
  ToyProgram first(run_of_needy("first"), log_of("first"));
  await(log_of("first"), "needed first");
  ToyProgram second(run_of_needy("second"), log_of("second"));
  await(log_of("second"), "waiting for ");
  first.signal(SIGKILL);
  EXPECT_EQ(first.wait(), -SIGKILL);
  EXPECT_EQ(second.wait(), 0) << text_of(log_of("second"));
  EXPECT_EQ(count_in("runs/toy-pendulum/swing"), 1);
}

TEST_F(SharedInput, IsNoLongerWaitedForAfterAStop) {
  ToyProgram first(run_of_needy("first"), log_of("first"));
  await(log_of("first"), "needed first");
  ToyProgram second(run_of_needy("second"), log_of("second"));
  await(log_of("second"), "waiting for ");
  EXPECT_EQ(stop(second), 2);
  EXPECT_THAT(text_of(log_of("second")), HasSubstr("stopped; go on with:"));
  EXPECT_EQ(first.wait(), 0);
}

TEST_F(Streams, ChainOfInputsHasALimit) {
  constexpr int kFiles = 120;
  const auto link = [&](int i) {
    return write_experiment(
        "toy-pendulum/link-" + std::to_string(i),
        "title = \"l\"\ntopic = \"toy-pendulum\"\n[scene]\ninput = \"run:toy-pendulum/link-" +
            std::to_string(i + 1) + "/v\"\n[[variant]]\nname = \"v\"\nmethod = \"closed-form\"\n");
  };
  for (int i = 1; i < kFiles; ++i) (void)link(i);
  ToyProgram program(run_of(link(0)), log());
  EXPECT_EQ(program.wait(), 2);
  EXPECT_THAT(text_of(log()),
              AllOf(HasSubstr("link-100.toml: more runs wait"), HasSubstr("at most 100")));
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Streams, CircleOfInputsWithOtherIdentifiersIsCalledACircle) {
  const auto needing = [&](const std::string& name, const std::string& id,
                           const std::string& input) {
    return write_experiment("toy-pendulum/" + name,
                            "title = \"c\"\nid = \"" + id +
                                "\"\ntopic = \"toy-pendulum\"\n[scene]\ninput = \"run:" + input +
                                "/v\"\n[[variant]]\nname = \"v\"\nmethod = \"closed-form\"\n");
  };
  const auto a = needing("a", "toy/one", "toy-pendulum/b");
  needing("b", "toy/two", "toy-pendulum/c");
  needing("c", "toy/three", "toy-pendulum/a");
  const auto self = needing("self", "toy/other", "toy-pendulum/self");
  for (const auto& [file, circle] : {std::pair{a, "toy/one -> toy/two -> toy/three -> toy/one"},
                                     std::pair{self, "toy/other -> toy/other"}}) {
    ToyProgram program(run_of(file), log());
    EXPECT_EQ(program.wait(), 2);
    EXPECT_THAT(text_of(log()), AllOf(HasSubstr("runs need each other in a circle: "),
                                      HasSubstr(circle), HasSubstr(".toml: ")));
    EXPECT_FALSE(fs::exists(out()));
    EXPECT_FALSE(fs::exists(folder() / "runs")) << "nothing is begun";
  }
}

}  // namespace
}  // namespace geoprior::test
