#include "experiments/paper/sound_measures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "metrics/event_rates.h"
#include "metrics/sound_bursts.h"
#include "metrics/sound_spectrum.h"
#include "metrics/true_peak.h"
#include "testbed/formats/wav_file.h"

namespace geoprior::paper {
namespace {

/// Times from the start of the sound, in order; an event before it or after it has no place in it.
std::vector<Event> within(const std::vector<Event>& events, double start, double duration) {
  std::vector<Event> kept;
  for (Event event : events) {
    event.time_s -= start;
    if (event.time_s >= 0 && event.time_s < duration) kept.push_back(std::move(event));
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [](const Event& a, const Event& b) { return a.time_s < b.time_s; });
  return kept;
}

}  // namespace

SoundMeasures::Kind SoundMeasures::all() const {
  Kind sum;
  for (const auto& entry : kinds) {
    sum.count += entry.second.count;
    sum.energy += entry.second.energy;
  }
  return sum;
}

std::optional<SoundMeasures> sound_measures(const PaperScene& scene, const FrameSequence& frames) {
  const auto file = frames.artifact("sound.wav");
  if (!scene.animation || !file || frames.size() == 0) return {};
  const Sound sound = wav_from_bytes(*file, "sound.wav");
  const Eigen::VectorXd mono = sound.samples.rowwise().mean();
  const double length = static_cast<double>(mono.size()) / sound.sample_rate;
  const std::vector<Event> events =
      within(frames.events(), std::min(0.0, frames.parameter(0)), length);
  SoundMeasures out;
  for (const auto& [kind, rate] : event_rates(events, length)) {
    if (kind.empty()) {
      out.rate = rate.rate_per_s;
      out.fano = rate.fano_factor;
    } else {
      out.kinds[kind] = {rate.count, rate.energy_J, {}, {}, 0};
    }
  }
  const auto bursts = sound_bursts(mono, sound.sample_rate, events);
  for (const auto& [kind, heard] : burst_statistics(bursts)) {
    SoundMeasures::Kind& of = out.kinds[kind];
    of.measured = heard.measured;
    if (heard.measured == 0) continue;
    of.duration = heard.duration_s.median;
    of.centroid = heard.centroid_hz.median;
  }
  double peak = 0;
  for (Eigen::Index c = 0; c < sound.samples.cols(); ++c) {
    peak = std::max(peak, true_peak(sound.samples.col(c)));
  }
  if (peak > 0) {
    out.peak = decibels_full_scale(peak);
    out.centroid = spectral_centroid(whole_spectrum(mono, sound.sample_rate, SoundWindow::none));
  }
  return out;
}

std::optional<EnergyExponent> energy_exponent(const PaperScene& scene,
                                              const FrameSequence& frames) {
  if (!scene.animation) return {};
  std::vector<Event> snaps;
  for (const Event& event : frames.events()) {
    if (event.kind == "flap" || event.kind == "crac") snaps.push_back(event);
  }
  std::stable_sort(snaps.begin(), snaps.end(),
                   [](const Event& a, const Event& b) { return a.time_s < b.time_s; });
  const PowerLawFit fit = event_energy_exponent(snaps, "");
  EnergyExponent out;
  out.stated = fit.stated_exponent();
  out.count = fit.count;
  if (fit.count == 0) return out;
  out.fitted = fit.exponent;
  out.standard_error = fit.standard_error;
  out.decades = fit.decades;
  return out;
}

}  // namespace geoprior::paper
