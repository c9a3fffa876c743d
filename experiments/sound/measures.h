#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "metrics/sound/bursts.h"
#include "testbed/frame_sequence.h"

namespace geoprior::sound {

/// Energy of a snap that stands out: ten times the floor of detection, what 5 cm^2 of office paper
/// hold that are bent to a radius of 10 cm (J).
inline constexpr double kLargeSnap = 1e-5;

/// Energies that snaps are counted from, two a decade (uJ, nominal: 3 stands for the root of 10).
inline constexpr std::array<int, 7> kSnapEnergies{1, 3, 10, 30, 100, 300, 1000};

/// Nominal middles of octave bands (IEC 61260-1; Hz).
inline constexpr std::array<int, 8> kOctaves{125, 250, 500, 1000, 2000, 4000, 8000, 16000};

/// What was recorded of a sound: its events, and the file "sound.wav" that was mixed of them.
struct SoundMeasures {
  struct Kind {
    int count = 0;
    double energy = 0;                  ///< J
    std::optional<Quartiles> duration;  ///< of the bursts heard in the mix (s)
    std::optional<Quartiles> centroid;  ///< likewise (Hz)
    double measured = 0;                ///< bursts that could be measured
  };
  std::map<std::string, Kind> kinds;  ///< "flap", "crac", "friction", "tear"
  double rate = 0;                    ///< of all events (1/s)
  std::optional<double> fano;         ///< factor of their counts in windows of 0.1 s
  std::optional<double> area;         ///< of the resonators of flaps and cracs, median (m^2)
  std::optional<double> ruling;       ///< their l_r (m)
  std::optional<double> border;       ///< their l_c (m)
  int large = 0;                      ///< flaps and cracs of `kLargeSnap` or more
  double large_energy = 0;            ///< of these (J)
  /// Flaps and cracs from each of `kSnapEnergies` up to the next.
  std::array<int, kSnapEnergies.size()> by_energy{};
  std::optional<double> latency;   ///< median of flaps and cracs (s)
  std::optional<double> peak;      ///< true peak of the mix (dBFS); absent for silence
  std::optional<double> centroid;  ///< of the whole mix (Hz)

  /// Power of the mix in the octaves about `kOctaves`, in dB below that of all of them; none for
  /// silence.
  std::vector<double> octaves;

  [[nodiscard]] Kind of(const std::string& kind) const {
    const auto found = kinds.find(kind);
    return found == kinds.end() ? Kind{} : found->second;
  }
  [[nodiscard]] Kind all() const;
};
std::optional<SoundMeasures> sound_measures(const FrameSequence& frames);

/// How far the sounds of picked events ("voices.wav") are from those of the reference variant, up
/// to where that knows its modes (metrics/sound/decay.h). Absent where one of both has
/// no such file.
struct VoiceDistance {
  double median = 0, low = 0, high = 0;  ///< over the events, with its 95 % bootstrap interval (dB)
  int count = 0;                         ///< events that were compared
  /// Median of the differences of reverberation times, in doublings.
  std::optional<double> decay;
};
/// @throws Error  when the two have picked other events
std::optional<VoiceDistance> voice_distance(const FrameSequence& frames);

/// Power law of the energies of flaps and cracs (metrics/sound/power_law.h). Absent where no
/// animation was listened to.
struct EnergyExponent {
  std::optional<double> stated;   ///< absent: withheld
  std::optional<double> fitted;   ///< whether it may be stated or not
  std::optional<double> p_value;  ///< of the fit
  double count = 0;               ///< energies in the tail
};
EnergyExponent energy_exponent(const std::vector<Event>& events);

}  // namespace geoprior::sound
