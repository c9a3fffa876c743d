#pragma once

namespace geoprior::embryo {

/// How values go from key to key: by monotone cubics of continuous velocity, or straight.
enum class Interpolation { monotone, linear };

/// Share of a process that is done, from 0 to 1 between two days: 3 u^2 - 2 u^3, which begins and
/// ends at rest, or u where motion is linear. 1 from `to` on where the two are one day.
inline double eased(double day, double from, double to, Interpolation interpolation) {
  if (day >= to) return 1;
  if (day <= from) return 0;
  const double u = (day - from) / (to - from);
  return interpolation == Interpolation::linear ? u : u * u * (3 - 2 * u);
}

}  // namespace geoprior::embryo
