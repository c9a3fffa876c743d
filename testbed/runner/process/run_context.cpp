#include "testbed/runner/process/run_context.h"

#include "testbed/runner/process/stop.h"

namespace geoprior {

void TimedContext::begin_phase(std::string_view name) { open_.emplace_back(name, now()); }

void TimedContext::end_phase() {
  if (open_.empty()) return;
  const auto& [name, begin] = open_.back();
  seconds_[name] += std::chrono::duration<double>(now() - begin).count();
  open_.pop_back();
}

bool TimedContext::stop_requested() const {
  if (geoprior::stop_requested()) stop_was_told_ = true;
  return stop_was_told_;
}

void TimedContext::progress(double fraction) {
  if (on_progress_) on_progress_(fraction);
}

std::map<std::string, double> TimedContext::phases() const {
  std::map<std::string, double> seconds = seconds_;
  for (const auto& [name, begin] : open_) {
    seconds[name] += std::chrono::duration<double>(now() - begin).count();
  }
  return seconds;
}

std::map<std::string, double> TimedContext::lap() {
  const Clock::time_point at = now();
  for (auto& [name, begin] : open_) {
    seconds_[name] += std::chrono::duration<double>(at - begin).count();
    begin = at;
  }
  return take_phases();
}

std::map<std::string, double> TimedContext::take_phases() { return std::exchange(seconds_, {}); }

}  // namespace geoprior
