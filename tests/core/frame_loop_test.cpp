#include "core/frame_loop.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

/// Writes down what it is asked, and what it pushes, in the order of the calls.
struct Log {
  std::vector<std::string> lines;
  std::vector<State> states;
  int stop_after = 1000;  ///< frames
  int frames = 0;
};

class LogSink final : public FrameSink {
 public:
  explicit LogSink(Log& log) : log_(log) {}
  void frame(Frame frame) override {
    ++log_.frames;
    log_.lines.push_back("frame " + std::to_string(static_cast<int>(frame.parameter)));
  }
  void event(const Event& event) override { log_.lines.push_back("event " + event.kind); }
  void artifact(Artifact artifact) override { log_.lines.push_back("file " + artifact.name); }
  void checkpoint(const State& state) override {
    log_.lines.emplace_back("checkpoint");
    log_.states.push_back(state);
  }

 private:
  Log& log_;
};

class LogContext final : public RunContext {
 public:
  explicit LogContext(Log& log) : log_(log) {}
  void progress(double fraction) override {
    log_.lines.push_back("progress " + std::to_string(static_cast<int>(100 * fraction)));
  }
  [[nodiscard]] bool stop_requested() const override { return log_.frames >= log_.stop_after; }

 private:
  Log& log_;
};

/// Frame k has the parameter 0 + 1 + … + k, summed up frame by frame.
class Sums final : public FrameModel {
 public:
  explicit Sums(Log& log, bool can_resume = true) : log_(log), can_resume_(can_resume) {}
  [[nodiscard]] int frame_count() const override { return 4; }
  void start(RunContext& /*context*/) override { log_.lines.emplace_back("start"); }
  void load(StateReader& in, int next_frame) override {
    log_.lines.push_back("load " + std::to_string(next_frame));
    sum_ = in.number<int>();
    told_ = in.text();
  }
  void begin(FrameSink& /*sink*/, RunContext& /*context*/) override {
    log_.lines.emplace_back("begin");
  }
  void advance(int frame, FrameSink& sink, RunContext& /*context*/) override {
    sum_ += frame;
    told_ = "sum is " + std::to_string(sum_);
    sink.event({.kind = told_});
  }
  void record(int /*number*/, FrameSink& sink, RunContext& /*context*/) override {
    Frame frame;
    frame.parameter = sum_;
    sink.frame(std::move(frame));
  }
  void save(StateWriter& out) const override {
    out.number(sum_);
    out.text(told_);
  }
  [[nodiscard]] bool can_resume() const override { return can_resume_; }

 private:
  Log& log_;
  bool can_resume_;
  int sum_ = 0;
  std::string told_;
};

void run(Log& log, const std::optional<State>& from = {}, bool can_resume = true) {
  Sums model(log, can_resume);
  LogSink sink(log);
  LogContext context(log);
  run_frames(model, sink, context, from);
}

using Lines = std::vector<std::string>;

TEST(FrameLoop, AdvancesRecordsAndSavesInThisOrder) {
  Log log;
  run(log);
  EXPECT_EQ(log.lines, (Lines{"start", "begin",                                          //
                              "frame 0", "progress 25", "checkpoint",                    //
                              "event sum is 1", "frame 1", "progress 50", "checkpoint",  //
                              "event sum is 3", "frame 3", "progress 75", "checkpoint",  //
                              "event sum is 6", "frame 6", "progress 100", "checkpoint"}));
}

TEST(FrameLoop, ResumedRunMakesTheFramesThatAreMissing) {
  Log whole;
  run(whole);
  Log rest;
  run(rest, whole.states[1]);
  EXPECT_EQ(rest.lines, (Lines{"load 2", "begin",                                         //
                               "event sum is 3", "frame 3", "progress 75", "checkpoint",  //
                               "event sum is 6", "frame 6", "progress 100", "checkpoint"}));
  EXPECT_EQ(rest.states.back(), whole.states.back());
  Log none;
  run(none, whole.states.back());
  EXPECT_EQ(none.lines, (Lines{"load 4", "begin"}));
}

TEST(FrameLoop, StopsBetweenTwoFrames) {
  Log log;
  log.stop_after = 2;
  run(log);
  EXPECT_EQ(log.frames, 2);
  EXPECT_EQ(log.states.size(), 2U);
}

TEST(FrameLoop, LeavesNoCheckpointOfAModelThatCannotResume) {
  Log log;
  run(log, {}, false);
  EXPECT_EQ(log.frames, 4);
  EXPECT_TRUE(log.states.empty());
}

TEST(FrameLoop, RefusesBytesThatNoRunLeft) {
  Log log;
  run(log);
  const State good = log.states[1];
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_THROW(run(log, State(good.begin(), good.begin() + size)), Error)
        << size << " of " << good.size() << " bytes";
  }
  State longer = good;
  longer.push_back(std::byte{0});
  EXPECT_THROW(run(log, longer), Error);
  State beyond = good;
  beyond[0] = std::byte{5};  // of 4 frames
  EXPECT_THROW(run(log, beyond), Error);
}

TEST(FrameLoop, ProcessMakesItsModelAnewForEveryRun) {
  Log log;
  const auto process =
      frame_process([&](RunContext& /*context*/) { return std::make_unique<Sums>(log); });
  RunContext context;
  LogSink sink(log);
  process->run(sink, context, {});
  const Lines first = log.lines;
  log.lines.clear();
  process->run(sink, context, {});
  EXPECT_EQ(log.lines, first);
}

TEST(StateBytes, ComeBackAsTheyWere) {
  StateWriter out;
  out.number(2.5);
  out.matrix(Eigen::MatrixXd(Eigen::Matrix2d::Identity()));
  out.matrix(Eigen::Vector3d(1, 2, 3));
  out.items(std::vector<int>{4, 5});
  out.text("waves");
  out.bytes({std::byte{6}});
  const State state = out.take();
  StateReader in(state);
  EXPECT_EQ(in.number<double>(), 2.5);
  Eigen::MatrixXd square;
  in.matrix(square);
  EXPECT_EQ(square, Eigen::MatrixXd(Eigen::Matrix2d::Identity()));
  Eigen::Vector3d point;
  in.matrix(point);
  EXPECT_EQ(point, Eigen::Vector3d(1, 2, 3));
  std::vector<int> numbers;
  in.items(numbers);
  EXPECT_EQ(numbers, (std::vector<int>{4, 5}));
  EXPECT_EQ(in.text(), "waves");
  EXPECT_THROW(in.require_end(), Error);
  EXPECT_EQ(in.bytes(), State{std::byte{6}});
  in.require_end();
}

TEST(StateBytes, AskForNoMemoryThatTheBytesCannotFill) {
  StateWriter out;
  out.number(std::size_t{1} << 60);  // rows, or a count
  out.number(std::size_t{1} << 60);  // columns
  const State state = out.take();
  std::vector<double> list;
  EXPECT_THROW(StateReader(state).items(list), Error);
  EXPECT_THROW(static_cast<void>(StateReader(state).text()), Error);
  EXPECT_THROW(static_cast<void>(StateReader(state).bytes()), Error);
  Eigen::MatrixXd matrix;
  EXPECT_THROW(StateReader(state).matrix(matrix), Error);
  Eigen::Vector3d point;
  EXPECT_THROW(StateReader(state).matrix(point), Error);
}

}  // namespace
}  // namespace geoprior
