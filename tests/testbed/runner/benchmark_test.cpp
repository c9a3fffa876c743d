#include "testbed/runner/benchmark.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/random.h"
#include "testbed/runner/judgement/timing_statistics.h"
#include "testbed/runner/process/stop.h"

namespace geoprior {
namespace {

// numpy.quantile([1, 2, 3, 4], [0, 0.25, 0.5, 0.75, 1]) = 1, 1.75, 2.5, 3.25, 4
TEST(Quantile, InterpolatesOrderStatistics) {
  const std::vector<double> values{4, 1, std::nan(""), 3, 2};
  EXPECT_DOUBLE_EQ(quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(median(values), 2.5);
  EXPECT_DOUBLE_EQ(interquartile_range(values), 1.5);
  EXPECT_DOUBLE_EQ(quantile(values, 1), 4);
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(BootstrapMedian, OfEqualValuesIsAPoint) {
  const std::vector<double> values(17, 2.5);
  const Interval interval = bootstrap_median(values, 1);
  EXPECT_EQ(interval.low, 2.5);
  EXPECT_EQ(interval.value, 2.5);
  EXPECT_EQ(interval.high, 2.5);
}

TEST(BootstrapMedian, SameValuesAndSeedGiveTheSameInterval) {
  RandomStream random(5, "sample");
  std::vector<double> values(40);
  for (double& x : values) x = random.normal();
  const Interval a = bootstrap_median(values, 1);
  const Interval b = bootstrap_median(values, 1);
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_LT(a.low, a.value);
  EXPECT_GT(a.high, a.value);
}

// 300 samples of 41 normal numbers: the count of intervals that hold the true median 0 is binomial;
// at the nominal 95 % its standard deviation is 1.3 %. The percentile bootstrap of a median is
// known to come a little short or long of it, hence 90 … 99 %.
TEST(BootstrapMedian, CoversTheTrueMedianAboutNinetyFiveTimesInAHundred) {
  RandomStream random(7, "coverage");
  int covered = 0;
  for (int s = 0; s < 300; ++s) {
    std::vector<double> values(41);
    for (double& x : values) x = random.normal();
    const Interval interval = bootstrap_median(values, static_cast<std::uint64_t>(s));
    covered += interval.low <= 0 && 0 <= interval.high ? 1 : 0;
  }
  EXPECT_GE(covered, 270);
  EXPECT_LE(covered, 297);
}

// Pairs share their disturbance: a machine that slows down by the same factor for both leaves every
// ratio at 2, though the times spread over two decades.
TEST(PairedRatios, CancelWhatBothSuffer) {
  RandomStream random(3, "slow");
  std::vector<double> a, b;
  for (int i = 0; i < 50; ++i) {
    const double slow = std::exp(4 * random.uniform());
    a.push_back(2 * slow);
    b.push_back(slow);
  }
  const Interval ratio = median_of_paired_ratios(a, b, 1);
  EXPECT_NEAR(ratio.value, 2, 1e-15);
  EXPECT_NEAR(ratio.high - ratio.low, 0, 1e-15);
}

TEST(PairedRatios, OfOnePairHaveNoInterval) {
  const std::vector<double> a{3}, b{2};
  const Interval ratio = median_of_paired_ratios(a, b, 1);
  EXPECT_EQ(ratio.value, 1.5);
  EXPECT_TRUE(std::isnan(ratio.low));
  EXPECT_TRUE(std::isnan(ratio.high));
}

TEST(PairedRatios, OfNothingAreAnError) {
  EXPECT_THROW((void)median_of_paired_ratios(std::vector<double>{1}, std::vector<double>{0}, 1),
               Error);
  EXPECT_THROW((void)median_of_paired_ratios(std::vector<double>{1}, std::vector<double>{}, 1),
               Error);
}

struct Call {
  std::string name;
  double parameter;
};

/// Logs its calls and marks the phase "inner" at parameter 2 only.
class Logged final : public PoseMethod {
 public:
  Logged(std::string name, std::vector<Call>& log) : name_(std::move(name)), log_(log) {}
  void solve(double parameter, RunContext& context) override {
    log_.push_back({name_, parameter});
    if (parameter == 2) const Phase inner(context, "inner");
  }
  [[nodiscard]] Frame frame() const override { return {}; }

 private:
  std::string name_;
  std::vector<Call>& log_;
};

/// Logs its runs; makes `frames` frames, marks the phase "inner" before the second one only, and
/// "outer" across all of them.
class LoggedProcess final : public Process {
 public:
  LoggedProcess(std::string name, int frames, std::string& log)
      : name_(std::move(name)), frames_(frames), log_(log) {}
  void run(FrameSink& sink, RunContext& context, const std::optional<State>&) override {
    log_ += name_;
    const Phase outer(context, "outer");
    for (int i = 0; i < frames_; ++i) {
      if (context.stop_requested()) return;
      if (i == 1) const Phase inner(context, "inner");
      Frame frame;
      frame.parameter = i;
      sink.frame(std::move(frame));
    }
  }

 private:
  std::string name_;
  int frames_;
  std::string& log_;
};

class ProcessBenchmark : public ::testing::Test {
 protected:
  void TearDown() override { clear_stop(); }
  [[nodiscard]] std::vector<ProcessEntry> entries() {
    const Timing recorded{{"run", {{1}, {2}, {3}}}, {"finish", {{0.5}}}};
    return {{"a", &a, recorded, 3}, {"b", &b, recorded, 3}, {"c", &c, recorded, 3}};
  }
  std::map<std::string, Timing> run(int repetitions, int warm_up) {
    return benchmark_processes(entries(), {repetitions, warm_up}, 1, [](double) {});
  }
  std::string log;
  LoggedProcess a{"a", 3, log}, b{"b", 3, log}, c{"c", 3, log};
};

TEST_F(ProcessBenchmark, CountsTheRecordedRunAsTheFirstRepetition) {
  const auto timing = run(3, 0);
  EXPECT_EQ(log, "bcacab");  // rotated every round, the recorded runs were the first
  const auto& whole = timing.at("b").at("run");
  ASSERT_EQ(whole.size(), 3U);
  for (std::size_t frame = 0; frame < 3; ++frame) {
    ASSERT_EQ(whole[frame].size(), 3U);
    EXPECT_EQ(whole[frame][0], static_cast<double>(frame + 1));
    EXPECT_LT(whole[frame][1], 1) << "an empty frame";
  }
  EXPECT_EQ(timing.at("b").at("finish").front().at(0), 0.5);
}

TEST_F(ProcessBenchmark, CountsTheRecordedRunAsTheFirstWarmUp) {
  const auto timing = run(1, 2);
  EXPECT_EQ(log, "bcacab");
  ASSERT_EQ(timing.at("a").at("run").front().size(), 1U);
  EXPECT_LT(timing.at("a").at("run")[2][0], 3);
}

TEST_F(ProcessBenchmark, GivesEachFrameTheTimeSinceTheOneBefore) {
  const auto timing = run(1, 1);
  const Timing& times = timing.at("a");
  for (std::size_t frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(std::isnan(times.contains("inner") ? times.at("inner")[frame][0] : 0), frame != 1);
    EXPECT_LE(times.at("outer")[frame][0], times.at("run")[frame][0]);
  }
  EXPECT_GE(times.at("finish").front().front(), times.at("finish:outer").front().front());
}

TEST_F(ProcessBenchmark, OfOneRepetitionRunsNothingAgain) {
  const auto timing = run(1, 0);
  EXPECT_EQ(log, "");
  EXPECT_EQ(timing.at("c").at("run")[1][0], 2);
}

TEST_F(ProcessBenchmark, StopsWhenAsked) {
  request_stop();
  EXPECT_TRUE(run(5, 0).empty());
  EXPECT_EQ(log, "b");
}

TEST_F(ProcessBenchmark, RefusesARepetitionOfOtherFrames) {
  auto all = entries();
  all[2].frames = 4;
  EXPECT_THROW((void)benchmark_processes(all, {2, 0}, 1, [](double) {}), Error);
}

/// Two processes of two frames and two repetitions, the method four times as fast at each.
std::vector<TimingRatio> ratios_of(std::vector<double> own_parameters, const std::string& status,
                                   bool by_frames = true) {
  std::vector<VariantRecord> variants(2);
  variants[0].name = "ours";
  variants[0].role = "method";
  variants[0].status = status;
  for (const double t : own_parameters) variants[0].frames.push_back({t, {}});
  variants[1].name = "dense";
  variants[1].role = "baseline";
  variants[1].frames = {{0, {}}, {1, {}}};
  std::map<std::string, Timing> timing;
  timing["ours"] = {{"run", {{1, 2}, {3, 4}}}, {"finish", {{0, 6}}}};
  timing["dense"] = {{"run", {{4, 8}, {12, 16}}}, {"finish", {{0, 0}}}};
  return timing_ratios(variants, timing, by_frames, 1);
}

TEST(TimingRatios, OfProcessesWithTheSameFramesArePairedByFrame) {
  const TimingRatio ratio = ratios_of({0, 1}, "done").at(0);
  EXPECT_EQ(ratio.paired, "frame");
  EXPECT_EQ(ratio.median_ratio, 0.25);
  EXPECT_EQ(ratio.high, 0.25) << "every pair has it";
}

TEST(TimingRatios, OfProcessesWithOtherFramesArePairedByWholeRuns) {
  const TimingRatio ratio = ratios_of({0, 0.5}, "done").at(0);
  EXPECT_EQ(ratio.paired, "run");
  // 4 s over 16 s, and 12 s (6 of them after the last frame) over 24 s.
  EXPECT_EQ(ratio.median_ratio, (0.25 + 0.5) / 2);
  EXPECT_EQ(ratio.low, 0.25);
}

TEST(TimingRatios, OfFramesThatShareNoWorkArePairedByWholeRuns) {
  const TimingRatio ratio = ratios_of({0, 1}, "done", false).at(0);
  EXPECT_EQ(ratio.paired, "run");
  EXPECT_EQ(ratio.median_ratio, (0.25 + 0.5) / 2);
}

TEST(TimingRatios, AVariantThatFailedHasNone) { EXPECT_TRUE(ratios_of({0, 1}, "failed").empty()); }

class Benchmark : public ::testing::Test {
 protected:
  void TearDown() override { clear_stop(); }
  std::vector<Call> log;
  Logged a{"a", log}, b{"b", log}, c{"c", log};
  TimedContext context{1};
};

TEST_F(Benchmark, InterleavesMethodsAndRotatesTheirOrder) {
  const auto timing =
      benchmark_poses({{"a", &a}, {"b", &b}, {"c", &c}}, {1, 2}, {2, 1}, context, [](double) {});
  std::string order;
  for (const Call& call : log)
    order += call.name + std::to_string(static_cast<int>(call.parameter));
  // warm-up from a, first repetition from b, second from c; all methods at one frame, then the next
  EXPECT_EQ(order,
            "a1b1c1a2b2c2"
            "b1c1a1b2c2a2"
            "c1a1b1c2a2b2");
  ASSERT_EQ(timing.size(), 3U);
  const auto& solve = timing.at("b").at("solve");
  ASSERT_EQ(solve.size(), 2U);
  ASSERT_EQ(solve[0].size(), 2U);  // the warm-up is not among the repetitions
  for (const auto& row : solve) {
    for (const double seconds : row) EXPECT_GE(seconds, 0);
  }
}

/// Begins each path with the call "restart".
class LoggedPath final : public PoseMethod {
 public:
  explicit LoggedPath(std::string& log) : log_(log) {}
  void solve(double parameter, RunContext&) override {
    log_ += std::to_string(static_cast<int>(parameter));
  }
  [[nodiscard]] bool path_dependent() const override { return true; }
  void restart() override { log_ += "restart"; }
  [[nodiscard]] Frame frame() const override { return {}; }

 private:
  std::string& log_;
};

TEST_F(Benchmark, TimesWholeSweepsOfAMethodThatDependsOnItsPath) {
  std::string order;
  LoggedPath path(order);
  benchmark_poses({{"a", &a}, {"path", &path}}, {0, 1, 2}, {1, 1}, context, [](double) {});
  EXPECT_EQ(order, "restart012restart012");
}

TEST_F(Benchmark, PhaseThatAFrameDidNotEnterHasNoTimeThere) {
  const auto timing = benchmark_poses({{"a", &a}}, {1, 2}, {1, 0}, context, [](double) {});
  const auto& inner = timing.at("a").at("inner");
  EXPECT_TRUE(std::isnan(inner[0][0]));
  EXPECT_GE(inner[1][0], 0);
  EXPECT_LE(inner[1][0], timing.at("a").at("solve")[1][0]);
}

TEST_F(Benchmark, StopsWhenAsked) {
  request_stop();
  EXPECT_TRUE(
      benchmark_poses({{"a", &a}, {"b", &b}}, {1, 2}, {5, 1}, context, [](double) {}).empty());
  EXPECT_EQ(log.size(), 1U);
}

TEST_F(Benchmark, RatiosAreOfEveryMethodAndAblationOverEveryBaseline) {
  std::vector<VariantRecord> variants(4);
  const char* names[] = {"ours", "without", "linear", "dual"};
  const char* roles[] = {"method", "ablation", "baseline", "baseline"};
  std::map<std::string, Timing> timing;
  for (std::size_t v = 0; v < 4; ++v) {
    variants[v].name = names[v];
    variants[v].role = roles[v];
    timing[names[v]]["solve"] = {{1.0 * static_cast<double>(v + 1)}};
  }
  const auto ratios = timing_ratios(variants, timing, true, 1);
  ASSERT_EQ(ratios.size(), 4U);
  EXPECT_EQ(ratios[3].variant, "without");
  EXPECT_EQ(ratios[3].of, "dual");
  EXPECT_DOUBLE_EQ(ratios[3].median_ratio, 0.5);
}

// Whatever the machine's load: a phase cannot have lasted longer than all of it less the pause.
TEST(TimedContext, PausesStopTheClockOfEveryOpenPhase) {
  using Clock = std::chrono::steady_clock;
  TimedContext context(1);
  const auto begin = Clock::now();
  {
    const Phase outer(context, "outer");
    const Phase inner(context, "inner");
    const TimedContext::Pause pause(context);
    const auto paused = Clock::now();
    while (Clock::now() - paused < std::chrono::milliseconds(20)) {
    }
  }
  const double all = std::chrono::duration<double>(Clock::now() - begin).count();
  const auto seconds = context.take_phases();
  EXPECT_LE(seconds.at("inner"), seconds.at("outer"));
  EXPECT_LE(seconds.at("outer"), all - 0.02);
  EXPECT_TRUE(context.take_phases().empty());
}

// Laps cut one clock into pieces: none is lost, none is counted twice.
TEST(TimedContext, LapsOfAnOpenPhaseAddUpToItsTime) {
  using Clock = std::chrono::steady_clock;
  TimedContext context(1);
  const auto begin = Clock::now();
  double laps = 0;
  context.begin_phase("open");
  for (int i = 0; i < 3; ++i) {
    const auto wait = Clock::now();
    while (Clock::now() - wait < std::chrono::milliseconds(5)) {
    }
    const double lap = context.lap().at("open");
    EXPECT_GE(lap, 0.005);
    laps += lap;
  }
  context.end_phase();
  laps += context.take_phases().at("open");
  const double all = std::chrono::duration<double>(Clock::now() - begin).count();
  EXPECT_GE(laps, 0.015);
  EXPECT_LE(laps, all);
}

}  // namespace
}  // namespace geoprior
