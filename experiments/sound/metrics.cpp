#include <optional>
#include <string>
#include <vector>

#include "experiments/sound/measures.h"
#include "experiments/sound/scene/scene.h"
#include "experiments/sound/topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::sound {
namespace {

// Runs of one build are equal bit for bit; tolerances are for other compilers and processors.
// Smooth quantities follow round-off; a count changes when something crosses its threshold.
constexpr Tolerance kSmooth{1e-12, 1e-6};
constexpr Tolerance kCount{1, 0.02};
constexpr Tolerance kShare{0.01, 0};

constexpr Direction kLow = Direction::lower_is_better;
constexpr Direction kNone = Direction::none;

using Value = std::optional<double>;

/// A group of metrics of what was recorded: the scene has no say in them.
template <class Measures>
auto of_sound(Measures (*measure)(const FrameSequence&)) {
  return sequence_metrics<SoundScene>(
      [measure](const SoundScene& /*scene*/, const FrameSequence& frames) {
        return measure(frames);
      });
}

/// Duration and centroid of a kind of snap: a quartile of each.
template <class Rows>
void add_quartile(Rows& rows, const std::string& name, const std::string& suffix,
                  double Quartiles::*which, const std::string& of) {
  using M = const SoundMeasures&;
  using Kind = SoundMeasures::Kind;
  const auto read = [name, which](M m, auto member) -> Value {
    const std::optional<Quartiles> heard = m.of(name).*member;
    if (!heard) return std::nullopt;
    return (*heard).*which;
  };
  rows.row(name + "_duration" + suffix, "s",
           "time in which the energy of a " + name +
               ", as it is heard in the mix, falls by 20 dB (Schroeder): " + of +
               " of those that stand alone",
           kNone, {1e-4, 0.02}, [read](M m) { return read(m, &Kind::duration); })
      .row(name + "_centroid" + suffix, "Hz", "mean frequency by power of the same, " + of, kNone,
           {1, 0.02}, [read](M m) { return read(m, &Kind::centroid); });
}

template <class Rows>
void add_octaves(Rows& rows) {
  for (std::size_t i = 0; i < kOctaves.size(); ++i) {
    const std::string middle = std::to_string(kOctaves[i]);
    rows.row("octave_" + middle, "dB",
             "power of the mix in the octave about " + middle +
                 " Hz, re that of the octaves from 125 Hz to 16 kHz; -90 at least",
             kNone, {0.1, 0}, [i](const SoundMeasures& m) -> Value {
               if (m.octaves.empty()) return std::nullopt;
               return m.octaves[i];
             });
  }
}

template <class Rows>
void add_energies(Rows& rows) {
  for (std::size_t i = 0; i < kSnapEnergies.size(); ++i) {
    const std::string from = std::to_string(kSnapEnergies[i]);
    const bool last = i + 1 == kSnapEnergies.size();
    const std::string until =
        last ? " uJ or more" : " uJ to " + std::to_string(kSnapEnergies[i + 1]) + " uJ";
    rows.row("snaps_" + from + "uj", "1",
             "flaps and cracs of an energy of " + from + until + " (3: the root of 10)", kNone,
             kCount, [i](const SoundMeasures& m) { return static_cast<double>(m.by_energy[i]); });
  }
}

MetricGroup sound_group() {
  using M = const SoundMeasures&;
  auto rows = of_sound(sound_measures);
  rows.row("sound_events", "1", "events that were heard of the sheet", kNone, kCount,
           [](M m) { return static_cast<double>(m.all().count); })
      .row("sound_energy", "J", "energy that they set free", kNone, kSmooth,
           [](M m) { return m.all().energy; })
      .row("large_snaps", "1", "flaps and cracs of an energy of 10 uJ or more", kNone, kCount,
           [](M m) { return static_cast<double>(m.large); })
      .row("large_snap_energy", "J", "energy that these set free", kNone, kSmooth,
           [](M m) { return m.large_energy; })
      .row("sound_rate", "1/s", "events over the length of the sound", kNone, kSmooth,
           [](M m) { return m.rate; })
      .row("sound_fano", "1",
           "variance over mean of their counts in windows of 0.1 s: 1 for events that know "
           "nothing of each other, more for bursts",
           kNone, kSmooth, [](M m) { return m.fano; })
      .row("crac_share", "1", "cracs among the flaps and cracs; absent without either", kNone,
           kShare,
           [](M m) -> Value {
             const double cracs = m.of("crac").count, snaps = cracs + m.of("flap").count;
             if (snaps == 0) return std::nullopt;
             return cracs / snaps;
           })
      .row("resonator_area", "m^2", "area of the resonators of flaps and cracs, median", kNone,
           kSmooth, [](M m) { return m.area; })
      .row("resonator_ruling", "m", "mean length of their rulings, l_r, median", kNone, kSmooth,
           [](M m) { return m.ruling; })
      .row("resonator_border", "m", "length of their free border, l_c, median", kNone, kSmooth,
           [](M m) { return m.border; })
      .row("sound_latency", "s",
           "from a flap or crac to the frame in which it is known, median: what a listener waits",
           kLow, kSmooth, [](M m) { return m.latency; })
      .row("sound_peak", "dBFS",
           "true peak of the mixed sound, 8 times oversampled; absent for silence", kLow, {0.01, 0},
           [](M m) { return m.peak; })
      .row("sound_centroid", "Hz",
           "sum of f P(f) over sum of P(f) from 20 Hz to 20 kHz, P the squared spectrum of the "
           "whole mixed sound, mono, without a window",
           kNone, {1, 1e-3}, [](M m) { return m.centroid; });
  add_energies(rows);
  add_octaves(rows);
  for (const char* kind : {"flap", "crac", "friction", "tear"}) {
    const std::string name = kind;
    rows.row(name + "_events", "1", "events of the kind " + name, kNone, kCount,
             [name](M m) { return static_cast<double>(m.of(name).count); });
  }
  for (const char* kind : {"flap", "crac"}) {
    add_quartile(rows, kind, "", &Quartiles::median, "median");
    add_quartile(rows, kind, "_lower", &Quartiles::lower, "lower quartile");
    add_quartile(rows, kind, "_upper", &Quartiles::upper, "upper quartile");
  }
  return rows;
}

MetricGroup voice_distance_group() {
  using M = const VoiceDistance&;
  return of_sound(voice_distance)
      .row("voice_distance", "dB",
           "log-spectral distance per third octave of a picked event's sound from the reference "
           "variant's, from 100 Hz to where that one is resolved, 40 dB of range, gain left free: "
           "median over the events",
           kLow, {0.02, 1e-3}, [](M m) { return m.median; })
      .row("voice_distance_low", "dB", "lower end of the 95 % bootstrap interval of voice_distance",
           kNone, {0.1, 1e-2}, [](M m) { return m.low; })
      .row("voice_distance_high", "dB",
           "upper end of the 95 % bootstrap interval of voice_distance", kNone, {0.1, 1e-2},
           [](M m) { return m.high; })
      .row(
          "voice_decay", "1",
          "doublings between the reverberation times per octave of a picked event's sound and of "
          "the reference variant's, in octaves within 20 dB of its loudest: median over the events",
          kLow, {0.05, 1e-3}, [](M m) { return m.decay; })
      .row("voices_compared", "1", "events whose sounds were compared", kNone, kCount,
           [](M m) { return static_cast<double>(m.count); });
}

MetricGroup energy_exponent_group() {
  using M = const EnergyExponent&;
  return event_metrics(energy_exponent)
      .row("energy_exponent", "1",
           "exponent of the energies of flaps and cracs, by maximum likelihood; withheld unless a "
           "power law is told apart from log-normal and exponential energies",
           kNone, {0.02, 0}, [](M m) { return m.stated; })
      .row("energy_exponent_fitted", "1", "the same, whether it may be stated or not", kNone,
           {0.02, 0}, [](M m) { return m.fitted; })
      .row("energy_exponent_p_value", "1",
           "share of samples of the fitted law that lie as far from their fit (Clauset et al. "
           "2009): "
           "below a tenth the energies obey no power law",
           kNone, {0.05, 0}, [](M m) { return m.p_value; })
      .row("energy_exponent_count", "1", "energies in its tail", kNone, kCount,
           [](M m) { return m.count; });
}

}  // namespace

std::vector<MetricGroup> metrics() {
  return {sound_group(), voice_distance_group(), energy_exponent_group()};
}

}  // namespace geoprior::sound
