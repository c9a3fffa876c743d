#include "experiments/sound/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "metrics/sound/bursts.h"
#include "metrics/sound/decay.h"
#include "metrics/sound/event_rates.h"
#include "metrics/sound/spectrum.h"
#include "metrics/sound/true_peak.h"
#include "testbed/formats/wav_file.h"
#include "testbed/runner/judgement/timing_statistics.h"

namespace geoprior::sound {
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

/// @throws Error  naming the event that has none of that name
double number_of(const Event& event, const std::string& name) {
  const auto found = event.numbers.find(name);
  if (found != event.numbers.end()) return found->second;
  throw Error("the " + event.kind + " at " + std::to_string(event.time_s) + " s has no number '" +
                  name + "'",
              "events");
}

/// Of a number of flaps and cracs; absent without any.
std::optional<double> median_of_snaps(const std::vector<Event>& events, const char* number) {
  std::vector<double> values;
  for (const Event& event : events) {
    if (event.kind == "flap" || event.kind == "crac") values.push_back(number_of(event, number));
  }
  if (values.empty()) return {};
  return median(values);
}

/// Of the octaves about 1000 x 10^(0.3 x) Hz, x = -3 ... 4, that `kOctaves` names.
std::vector<double> octave_levels(const PowerSpectrum& spectrum) {
  const auto edge = [](double x) { return 1000 * std::pow(10, 0.3 * x); };
  const double all = spectrum.power(edge(-3.5), edge(4.5));
  if (!(all > 0)) return {};
  std::vector<double> levels;
  for (int x = -3; x <= 4; ++x) {
    const double power = spectrum.power(edge(x - 0.5), edge(x + 0.5));
    levels.push_back(10 * std::log10(std::max(power / all, 1e-9)));
  }
  return levels;
}

/// A sound that was recorded alone.
struct PickedVoice {
  double time = 0;                                            ///< of its event (s)
  double resolved = std::numeric_limits<double>::infinity();  ///< of a reference (Hz)
  Eigen::VectorXd samples;
  int rate = 0;
};

std::optional<std::vector<PickedVoice>> picked_voices(const FrameSequence& frames) {
  const auto file = frames.artifact("voices.wav");
  if (!file) return {};
  const Sound all = wav_from_bytes(*file, "voices.wav");
  std::vector<PickedVoice> voices;
  for (const Event& event : frames.events()) {
    const auto start = event.numbers.find("voice_start_s");
    if (start == event.numbers.end()) continue;
    PickedVoice& voice = voices.emplace_back();
    voice.time = event.time_s;
    voice.rate = all.sample_rate;
    if (const auto resolved = event.numbers.find("resolved_hz"); resolved != event.numbers.end())
      voice.resolved = resolved->second;
    const Eigen::Index first = std::lround(start->second * voice.rate),
                       length = std::lround(number_of(event, "voice_length_s") * voice.rate);
    if (first < 0 || length < 0 || first + length > all.samples.rows()) {
      throw Error("ends before the sound of the event at " + std::to_string(event.time_s) + " s",
                  "voices.wav");
    }
    voice.samples = all.samples.col(0).segment(first, length);
  }
  return voices;
}

/// How many flaps and cracs there are, of which energy.
void count_snaps(const std::vector<Event>& events, SoundMeasures& out) {
  constexpr double kRoot = 3.1622776601683795;  // of ten
  constexpr std::array<double, kSnapEnergies.size()> kFrom{1e-6, kRoot * 1e-6, 1e-5, kRoot * 1e-5,
                                                           1e-4, kRoot * 1e-4, 1e-3};  // J
  static_assert(kFrom[2] == kLargeSnap);
  for (const Event& event : events) {
    if (event.kind != "flap" && event.kind != "crac") continue;
    const auto above = std::upper_bound(kFrom.begin(), kFrom.end(), event.energy_J);
    if (above != kFrom.begin()) {
      ++out.by_energy[static_cast<std::size_t>(above - kFrom.begin() - 1)];
    }
    if (event.energy_J < kLargeSnap) continue;
    ++out.large;
    out.large_energy += event.energy_J;
  }
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

std::optional<SoundMeasures> sound_measures(const FrameSequence& frames) {
  const auto file = frames.artifact("sound.wav");
  if (!file || frames.size() == 0) return {};
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
  out.area = median_of_snaps(frames.events(), "area_m2");
  out.ruling = median_of_snaps(frames.events(), "ruling_length_m");
  out.border = median_of_snaps(frames.events(), "free_border_m");
  out.latency = median_of_snaps(frames.events(), "latency_s");
  count_snaps(events, out);
  const auto bursts = sound_bursts(mono, sound.sample_rate, events);
  for (const auto& [kind, heard] : burst_statistics(bursts)) {
    SoundMeasures::Kind& of = out.kinds[kind];
    of.measured = heard.measured;
    if (heard.measured == 0) continue;
    of.duration = heard.duration_s;
    of.centroid = heard.centroid_hz;
  }
  double peak = 0;
  for (Eigen::Index c = 0; c < sound.samples.cols(); ++c) {
    peak = std::max(peak, true_peak(sound.samples.col(c)));
  }
  if (peak > 0) {
    out.peak = decibels_full_scale(peak);
    const PowerSpectrum spectrum = whole_spectrum(mono, sound.sample_rate, SoundWindow::none);
    out.centroid = spectral_centroid(spectrum);
    out.octaves = octave_levels(spectrum);
  }
  return out;
}

std::optional<VoiceDistance> voice_distance(const FrameSequence& frames) {
  if (frames.reference() == nullptr) return {};
  const auto own = picked_voices(frames), of = picked_voices(*frames.reference());
  if (!own || !of) return {};
  if (own->size() != of->size()) {
    throw Error("has picked " + std::to_string(own->size()) + " events", "voices.wav",
                std::to_string(of->size()) + ", as its reference");
  }
  std::vector<double> distances, decays;
  for (std::size_t i = 0; i < own->size(); ++i) {
    const PickedVoice &heard = (*own)[i], &wanted = (*of)[i];
    if (std::abs(heard.time - wanted.time) > 1e-9 || heard.rate != wanted.rate) {
      throw Error("picked event " + std::to_string(i) + " is another one than the reference's",
                  "voices.wav");
    }
    const auto difference =
        voice_difference(heard.samples, wanted.samples, wanted.rate, wanted.resolved);
    if (!difference) continue;
    distances.push_back(difference->distance_db);
    if (difference->decay) decays.push_back(*difference->decay);
  }
  if (distances.empty()) return {};
  const Interval spread = bootstrap_median(distances, 1);
  VoiceDistance out{spread.value, spread.low, spread.high, static_cast<int>(distances.size()), {}};
  if (!decays.empty()) out.decay = median(decays);
  return out;
}

EnergyExponent energy_exponent(const std::vector<Event>& events) {
  std::vector<Event> snaps;
  for (const Event& event : events) {
    if (event.kind == "flap" || event.kind == "crac") snaps.push_back(event);
  }
  const PowerLawFit fit = event_energy_exponent(snaps, "");
  EnergyExponent out;
  out.stated = fit.stated_exponent();
  out.count = fit.count;
  if (fit.count == 0) return out;
  out.fitted = fit.exponent;
  out.p_value = fit.p_value;
  return out;
}

}  // namespace geoprior::sound
