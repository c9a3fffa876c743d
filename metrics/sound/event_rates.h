#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "core/frame.h"
#include "metrics/sound/power_law.h"

namespace geoprior {

/// Events of one kind in an interval of time.
struct EventRate {
  int count = 0;
  double rate_per_s = 0;                    ///< count over the interval's length
  double energy_J = 0;                      ///< sum
  std::optional<double> median_interval_s;  ///< between successive events; absent below 2 events
  /// Variance over mean of the counts in whole windows of the interval: 1 for events that know
  /// nothing of each other (Poisson), 0 for a clock's, more for those that come in bursts (Fano
  /// 1947). Absent with fewer than 2 windows or no event in them.
  std::optional<double> fano_factor;
};

/// Of each kind that occurs, and of all events together under the name "".
///
/// @param duration_s  length of the interval, which begins at 0
/// @param window_s    of the Fano factor; long against the frame step, on which events fall
/// @throws Error  on an event that is not in [0, duration_s] or whose energy is negative or not
///                finite (names it), or a length that is not positive
std::map<std::string, EventRate> event_rates(std::span<const Event> events, double duration_s,
                                             double window_s = 0.1);

/// Exponent of the energies, in the order of time, of the events of one kind, or, with `kind` "",
/// of all.
/// @throws Error  as `fit_power_law`
PowerLawFit event_energy_exponent(std::span<const Event> events, const std::string& kind,
                                  const PowerLawOptions& options = {});

}  // namespace geoprior
