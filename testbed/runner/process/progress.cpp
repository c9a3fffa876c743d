#include "testbed/runner/process/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "testbed/streams.h"

namespace geoprior {

namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedraw{100};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::string duration_text(double seconds) {
  const long total = std::lround(std::clamp(seconds, 0.0, 1e9));
  char text[40];
  if (total >= 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld", total / 60, total % 60);
  }
  return text;
}

Progress::Progress(bool bar, std::size_t steps)
    : bar_(bar), steps_(std::max<std::size_t>(steps, 1)) {}

Progress::~Progress() { clear(); }

void Progress::begin(const std::string& what) {
  what_ = what;
  fraction_ = 0;
  step_start_ = Clock::now();
  draw(true);
}

void Progress::fraction(double done) {
  fraction_ = std::clamp(done, 0.0, 1.0);
  draw(false);
}

void Progress::end() {
  ++done_;
  fraction_ = 0;
  if (!bar_) {
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, ": %.1f s", seconds_since(step_start_));
    geoprior::say(what_ + seconds);
  }
  draw(true);
}

void Progress::skip() {
  ++done_;
  ++skipped_;
}

void Progress::say(const std::string& line) {
  clear();
  geoprior::say(line);
}

void Progress::draw(bool now) {
  if (!bar_ || (!now && Clock::now() - drawn_ < kRedraw)) return;
  drawn_ = Clock::now();
  const auto steps = static_cast<double>(steps_);
  const double share = std::min(1.0, (static_cast<double>(done_) + fraction_) / steps);
  const int filled = static_cast<int>(share * kBarWidth);
  std::string line = "[";
  line.append(filled, '=');
  line.append(kBarWidth - filled, ' ').append("] ");
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %% ", 100 * share);
  line.append(percent).append(printable(what_));
  // Steps of an earlier program cost this one nothing and say nothing of its speed.
  const double own = static_cast<double>(done_ - skipped_) + fraction_;
  const double left = steps - static_cast<double>(done_) - fraction_;
  if (own > 0 && left > 0) {
    line.append(", ").append(duration_text(seconds_since(start_) * left / own)).append(" left");
  }
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
  std::fflush(stderr);
  visible_ = true;
}

void Progress::clear() {
  if (!visible_) return;
  std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace geoprior
