#include "metrics/sound/bursts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "metrics/sound/spectrum.h"
#include "metrics/sound/true_peak.h"
#include "metrics/tracks/weighted_quantile.h"

namespace geoprior {
namespace {

constexpr double kShareOutside = 0.01;  ///< of the energy, before the onset and after the end
constexpr double kBesideS = 0.005;      ///< looked at before the event and at the window's end

void require_bursts(const Eigen::Ref<const Eigen::VectorXd>& samples, int sample_rate,
                    std::span<const Event> events, const SoundBurstOptions& options) {
  if (sample_rate < 1000) {
    throw Error("sample rate " + std::to_string(sample_rate) + " Hz", "sound bursts",
                "at least 1000");
  }
  if (!(options.longest_s > 0) || !(options.clear_db > 0)) {
    throw Error("longest window " + std::to_string(options.longest_s) + " s, clear by " +
                    std::to_string(options.clear_db) + " dB",
                "sound bursts", "positive");
  }
  require_finite_samples(samples);
  const double length = static_cast<double>(samples.size()) / sample_rate;
  for (std::size_t e = 0; e < events.size(); ++e) {
    if (!(events[e].time_s >= 0) || !(events[e].time_s < length)) {
      throw Error("its time is " + std::to_string(events[e].time_s) + " s",
                  "event " + std::to_string(e),
                  "within the sound of " + std::to_string(length) + " s");
    }
  }
}

double mean_square(const Eigen::Ref<const Eigen::VectorXd>& samples) {
  return samples.size() == 0 ? 0 : samples.squaredNorm() / static_cast<double>(samples.size());
}

/// Mean square of the loudest of consecutive milliseconds, the last of which may be shorter.
double loudest_millisecond(const Eigen::Ref<const Eigen::VectorXd>& samples, int sample_rate) {
  const Eigen::Index block = sample_rate / 1000;
  double loudest = 0;
  for (Eigen::Index i = 0; i < samples.size(); i += block) {
    const Eigen::Index n = std::min(block, samples.size() - i);
    loudest = std::max(loudest, samples.segment(i, n).squaredNorm() / static_cast<double>(block));
  }
  return loudest;
}

/// Samples from the onset to the end of a window's energy.
struct HeardSpan {
  Eigen::Index begin = 0, end = 0;
};

HeardSpan heard_span(const Eigen::Ref<const Eigen::VectorXd>& window) {
  const double whole = window.squaredNorm();
  HeardSpan span;
  double passed = 0;
  for (Eigen::Index i = 0; i < window.size(); ++i) {
    passed += window(i) * window(i);
    if (passed < kShareOutside * whole) span.begin = i + 1;
    if (passed < (1 - kShareOutside) * whole) span.end = i + 1;
  }
  span.end = std::min(span.end + 1, window.size());
  return span;
}

/// The samples between an event and the next one or the end.
struct BurstWindow {
  Eigen::Index begin = 0, end = 0;
  bool next_comes = false;  ///< it ends with another event
  bool is_crowded = false;  ///< another event is too near for one to be heard alone
};

/// The window of the k-th of ascending times.
BurstWindow burst_window(const std::vector<double>& times, std::size_t k, Eigen::Index samples,
                         int sample_rate, double longest_s) {
  const auto index = [&](double t) {  // of the first sample at t or later
    return static_cast<Eigen::Index>(std::ceil(t * sample_rate - 1e-6));
  };
  const bool is_last = k + 1 == times.size();
  BurstWindow window;
  window.begin = std::min(index(times[k]), samples - 1);
  window.end = std::min(samples, index(times[k] + longest_s));
  window.next_comes = !is_last && index(times[k + 1]) < window.end;
  if (window.next_comes) window.end = index(times[k + 1]);
  window.is_crowded = (k > 0 && times[k] - times[k - 1] < kBesideS) ||
                      (!is_last && times[k + 1] - times[k] < kBesideS);
  return window;
}

void measure_burst(const Eigen::Ref<const Eigen::VectorXd>& samples, int sample_rate,
                   const BurstWindow& window, const SoundBurstOptions& options, SoundBurst& burst) {
  using State = SoundBurst::State;
  const auto heard = samples.segment(window.begin, window.end - window.begin);
  const double loudest = loudest_millisecond(heard, sample_rate);
  burst.peak_db = decibels_full_scale(std::sqrt(loudest));
  if (window.is_crowded) {
    burst.state = State::overlapped;
    return;
  }
  if (!(burst.peak_db >= options.silence_db)) return;  // silent
  const auto beside = static_cast<Eigen::Index>(kBesideS * sample_rate);
  const double clear = loudest * std::pow(10., -options.clear_db / 10);
  const Eigen::Index before = std::min(beside, window.begin);
  if (mean_square(samples.segment(window.begin - before, before)) > clear) {
    burst.state = State::overlapped;
    return;
  }
  if (mean_square(heard.tail(std::min(beside, heard.size()))) > clear) {
    burst.state = window.next_comes ? State::overlapped : State::cut_off;
    return;
  }
  const HeardSpan span = heard_span(heard);
  burst.state = State::measured;
  burst.onset_s = static_cast<double>(window.begin + span.begin) / sample_rate;
  burst.duration_s = static_cast<double>(span.end - span.begin) / sample_rate;
  const PowerSpectrum spectrum = whole_spectrum(heard.segment(span.begin, span.end - span.begin),
                                                sample_rate, SoundWindow::none);
  burst.centroid_hz = spectral_centroid(spectrum).value_or(0);
}

Quartiles quartiles_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const Eigen::Index n = values.size();
  const std::vector<double> q =
      weighted_quantiles(Eigen::Map<const Eigen::VectorXd>(values.data(), n),
                         Eigen::VectorXd::Ones(n), std::array{0.25, 0.5, 0.75});
  return {q[0], q[1], q[2]};
}

}  // namespace

std::vector<SoundBurst> sound_bursts(const Eigen::Ref<const Eigen::VectorXd>& samples,
                                     int sample_rate, std::span<const Event> events,
                                     const SoundBurstOptions& options) {
  require_bursts(samples, sample_rate, events, options);
  std::vector<std::size_t> order(events.size());
  for (std::size_t e = 0; e < order.size(); ++e) order[e] = e;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return events[a].time_s < events[b].time_s;
  });
  std::vector<double> times;
  for (const std::size_t e : order) times.push_back(events[e].time_s);
  std::vector<SoundBurst> bursts(events.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    SoundBurst& burst = bursts[order[k]];
    burst.kind = events[order[k]].kind;
    burst.time_s = times[k];
    measure_burst(samples, sample_rate,
                  burst_window(times, k, samples.size(), sample_rate, options.longest_s), options,
                  burst);
  }
  return bursts;
}

std::map<std::string, BurstStatistics> burst_statistics(std::span<const SoundBurst> bursts) {
  std::map<std::string, BurstStatistics> statistics;
  std::map<std::string, std::vector<double>> durations, centroids;
  for (const SoundBurst& burst : bursts) {
    BurstStatistics& of_kind = statistics[burst.kind];
    ++of_kind.events;
    switch (burst.state) {
      case SoundBurst::State::silent:
        ++of_kind.silent;
        break;
      case SoundBurst::State::overlapped:
        ++of_kind.overlapped;
        break;
      case SoundBurst::State::cut_off:
        ++of_kind.cut_off;
        break;
      case SoundBurst::State::measured:
        ++of_kind.measured;
        durations[burst.kind].push_back(burst.duration_s);
        centroids[burst.kind].push_back(burst.centroid_hz);
    }
  }
  for (auto& [kind, of_kind] : statistics) {
    of_kind.duration_s = quartiles_of(durations[kind]);
    of_kind.centroid_hz = quartiles_of(centroids[kind]);
  }
  return statistics;
}

}  // namespace geoprior
