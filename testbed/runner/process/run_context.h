#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/context.h"

namespace geoprior {

/// The context that the runner hands to methods: reads the clock at phases, asks for a stop after
/// Ctrl-C.
class TimedContext final : public RunContext {
 public:
  explicit TimedContext(std::uint64_t seed, std::function<void(double)> on_progress = {})
      : RunContext(seed), on_progress_(std::move(on_progress)) {}

  void begin_phase(std::string_view name) override;
  void end_phase() override;
  [[nodiscard]] bool stop_requested() const override;
  void progress(double fraction) override;

  /// True once a method has been told to stop (it then may have left its work unfinished).
  [[nodiscard]] bool stop_was_told() const { return stop_was_told_; }
  /// Seconds of each phase since the last call, and starts anew.
  std::map<std::string, double> take_phases();
  /// Seconds of each phase since the last call, open phases up to now, which start anew as well:
  /// the times of one frame.
  std::map<std::string, double> lap();
  /// What `lap` would return, without starting anew.
  [[nodiscard]] std::map<std::string, double> phases() const;

  /// Stops the clock of the phases for as long as it lives: recording is no part of a method's
  /// time.
  class Pause {
   public:
    explicit Pause(TimedContext& context) : context_(context), begin_(Clock::now()) {}
    ~Pause() { context_.paused_ += Clock::now() - begin_; }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    TimedContext& context_;
    std::chrono::steady_clock::time_point begin_;
  };

 private:
  using Clock = std::chrono::steady_clock;
  /// The clock without the pauses.
  [[nodiscard]] Clock::time_point now() const { return Clock::now() - paused_; }

  std::function<void(double)> on_progress_;
  std::vector<std::pair<std::string, Clock::time_point>> open_;
  std::map<std::string, double> seconds_;
  Clock::duration paused_{};
  mutable bool stop_was_told_ = false;
};

}  // namespace geoprior
