#include "metrics/sound/event_rates.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "metrics/tracks/weighted_quantile.h"
#include "metrics/volume/wave_modes.h"

namespace geoprior {
namespace {

std::optional<double> median_interval(const std::vector<double>& sorted_times) {
  if (sorted_times.size() < 2) return {};
  const Eigen::Index n = sorted_times.size();
  const Eigen::Map<const Eigen::VectorXd> times(sorted_times.data(), n);
  return weighted_quantile(times.tail(n - 1) - times.head(n - 1), Eigen::VectorXd::Ones(n - 1),
                           0.5);
}

std::optional<double> fano_factor(const std::vector<double>& times, double duration_s,
                                  double window_s) {
  const double windows = std::floor(duration_s / window_s * (1 + 1e-12));
  if (windows < 2) return {};
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(windows));
  for (const double time : times) {
    const double window = std::floor(time / window_s);
    if (window < windows) counts(static_cast<Eigen::Index>(window)) += 1;
  }
  const Moments of_counts = moments(counts);
  if (!(of_counts.mean > 0)) return {};
  return of_counts.variance / of_counts.mean;
}

void require_events(std::span<const Event> events, double duration_s, double window_s) {
  if (!(duration_s > 0) || !std::isfinite(duration_s) || !(window_s > 0)) {
    throw Error("interval of " + std::to_string(duration_s) + " s, windows of " +
                    std::to_string(window_s) + " s",
                "event rates", "positive");
  }
  if (duration_s / window_s > 1e8) {
    throw Error(std::to_string(duration_s / window_s) + " windows", "event rates", "at most 1e8");
  }
  for (std::size_t e = 0; e < events.size(); ++e) {
    const Event& event = events[e];
    const bool in_time = event.time_s >= 0 && event.time_s <= duration_s;
    if (!in_time || !(event.energy_J >= 0) || !std::isfinite(event.energy_J)) {
      throw Error("time " + std::to_string(event.time_s) + " s, energy " +
                      std::to_string(event.energy_J) + " J",
                  "event " + std::to_string(e),
                  "within 0 and " + std::to_string(duration_s) + " s, not negative");
    }
  }
}

}  // namespace

std::map<std::string, EventRate> event_rates(std::span<const Event> events, double duration_s,
                                             double window_s) {
  require_events(events, duration_s, window_s);
  std::map<std::string, EventRate> rates{{"", {}}};
  std::map<std::string, std::vector<double>> times;
  for (const Event& event : events) {
    for (const std::string& kind : {event.kind, std::string()}) {
      ++rates[kind].count;
      rates[kind].energy_J += event.energy_J;
      times[kind].push_back(event.time_s);
    }
  }
  for (auto& [kind, rate] : rates) {
    std::vector<double>& of_kind = times[kind];
    std::sort(of_kind.begin(), of_kind.end());
    rate.rate_per_s = rate.count / duration_s;
    rate.median_interval_s = median_interval(of_kind);
    rate.fano_factor = fano_factor(of_kind, duration_s, window_s);
  }
  return rates;
}

PowerLawFit event_energy_exponent(std::span<const Event> events, const std::string& kind,
                                  const PowerLawOptions& options) {
  std::vector<Event> chosen;
  for (const Event& event : events) {
    if (kind.empty() || event.kind == kind) chosen.push_back(event);
  }
  std::stable_sort(chosen.begin(), chosen.end(),
                   [](const Event& a, const Event& b) { return a.time_s < b.time_s; });
  std::vector<double> energies;
  for (const Event& event : chosen) energies.push_back(event.energy_J);
  return fit_power_law(Eigen::Map<const Eigen::VectorXd>(energies.data(), energies.size()),
                       options);
}

}  // namespace geoprior
