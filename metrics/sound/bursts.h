#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"

namespace geoprior {

struct SoundBurstOptions {
  double longest_s = 2;  ///< of the window that is heard after an event
  double clear_db = 30;  ///< levels this far below a burst's loudest millisecond are of no weight
  double silence_db = -90;  ///< of full scale: a loudest millisecond below is none
};

/// What is heard after an event.
struct SoundBurst {
  enum class State {
    measured,
    silent,      ///< nothing is heard before the next event
    overlapped,  ///< older sound is not gone when it begins, or it is not when the next event comes
    cut_off,     ///< it has not died away at the end of the sound or of the longest window
  };
  State state = State::silent;
  std::string kind;        ///< the event's
  double time_s = 0;       ///< the event's
  double peak_db = 0;      ///< of full scale: RMS of the loudest ms; -infinity without any sound
  double onset_s = 0;      ///< measured: when 1 % of its energy has come
  double duration_s = 0;   ///< measured: from then until 99 % have come
  double centroid_hz = 0;  ///< measured: mean frequency by power in between, 20 Hz to 20 kHz
};

/// Bursts of a mixed sound, one an event, in the order of the events.
///
/// A burst has the window from its event to the next one of any kind. Its duration is the time in
/// which its energy has fallen by 20 dB by backward integration (Schroeder 1965, as in ISO 3382-1),
/// counted from 1 % on, so that the way of the sound to the ear does not count. For an amplitude
/// exp(-t / tau) that is tau ln(99) / 2 = 2.298 tau, and a third (0.3326) of the reverberation time
/// T60 = 6.908 tau. Integration needs no smoothing, which would lengthen bursts of few ms, and the
/// zeros of a low tone do not end it.
///
/// A burst is left out, and its state says so, when another event is less than 5 ms away, or when
/// the 5 ms before its event or the last 5 ms of its window are less than `clear_db` below its
/// loudest millisecond: with 30 dB, what is cut off makes the duration up to 2 % short. Bursts that
/// steady noise lies under are therefore overlapped.
///
/// @param samples  mono, full scale = 1
/// @param events   in any order
/// @throws Error   on a sample rate below 1000, a sample that is not finite, an event that is not
///                 within the sound (names it), or options that are not positive
std::vector<SoundBurst> sound_bursts(const Eigen::Ref<const Eigen::VectorXd>& samples,
                                     int sample_rate, std::span<const Event> events,
                                     const SoundBurstOptions& options = {});

/// Lower quartile, median and upper quartile; 0 without values.
struct Quartiles {
  double lower = 0, median = 0, upper = 0;
};
struct BurstStatistics {
  int events = 0, measured = 0, silent = 0, overlapped = 0, cut_off = 0;
  Quartiles duration_s, centroid_hz;  ///< of those measured
};
std::map<std::string, BurstStatistics> burst_statistics(std::span<const SoundBurst> bursts);

}  // namespace geoprior
