#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace geoprior {

/// Tells a person on stderr how far a run is: a bar with the remaining time, or one line a variant.
class Progress {
 public:
  /// `steps` is how many variants (and benchmarks) the run has; `bar` wants a terminal.
  Progress(bool bar, std::size_t steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void begin(const std::string& what);
  /// Shows how much of the current step is done, 0 … 1.
  void fraction(double done);
  void end();
  /// A step that an earlier, interrupted run has done.
  void skip();
  /// A line for the person; the bar stays below it.
  void say(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(bool now);
  void clear();

  bool bar_;
  std::size_t steps_;
  std::size_t skipped_ = 0;
  std::size_t done_ = 0;
  double fraction_ = 0;
  std::string what_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point step_start_ = Clock::now();
  Clock::time_point drawn_{};
  bool visible_ = false;
};

/// "0:07", "12:30", "1:02:03"
std::string duration_text(double seconds);

}  // namespace geoprior
