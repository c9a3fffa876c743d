#pragma once

#include <array>

#include "solvers/torus/jets/jet.h"

namespace geoprior::torus {

/// First positive zero of J_0: no loop of a corrugation opens wider.
constexpr double kFirstZero = 2.404825557695773;
/// Harmonics of a loop that are summed: what is left of J_n(2.405) / n is below 4e-12, also after
/// as many derivatives along it as the jet has.
constexpr int harmonics_of(int order) { return 14 + 2 * order; }

/// J_0, J_1, … of amplitudes in (0, 2.405], by Miller's downward recurrence
/// J_{n-1} = 2n/a J_n - J_{n+1}, scaled by J_0 + 2 J_2 + 2 J_4 + … = 1.
template <std::size_t Count>
std::array<Lane, Count> bessel_functions(const Lane& amplitude) {
  constexpr int kLast = static_cast<int>(Count) - 1;
  constexpr int kBeyond = 6;  // orders in which the recurrence forgets how it began
  std::array<Lane, Count> j;
  const Lane twice = 2 / amplitude;
  Lane above = Lane::Zero(), here = Lane::Constant(1e-280), even = Lane::Zero();
  for (int n = kLast + kBeyond; n >= 0; --n) {
    if (n <= kLast) j[n] = here;
    if (n % 2 == 0 && n > 0) even += here;
    const Lane below = n * twice * here - above;
    above = here;
    here = below;
  }
  const Lane scale = (j[0] + 2 * even).inverse();
  for (Lane& value : j) value *= scale;
  return j;
}

/// The amplitude whose J_0 is `value`, in (0, 1]; not below 1e-6.
Lane inverse_bessel(const Lane& value);

/// Taylor coefficients of J_n about an amplitude: [n][k] is the k-th derivative over k!.
template <int Order>
using BesselSeries = std::array<Series<Order>, harmonics_of(Order) + 1>;

template <int Order>
BesselSeries<Order> bessel_series(const Lane& amplitude) {
  constexpr int kHarmonics = harmonics_of(Order);
  auto derivative = bessel_functions<kHarmonics + Order + 1>(amplitude);
  BesselSeries<Order> out;
  double factorial = 1;
  for (int k = 0; k <= Order; ++k) {
    if (k > 0) {  // J_0' = -J_1, 2 J_n' = J_{n-1} - J_{n+1}
      Lane before = derivative[0];
      derivative[0] = -derivative[1];
      for (int n = 1; n <= kHarmonics + Order - k; ++n) {
        const Lane here = derivative[n];
        derivative[n] = 0.5 * (before - derivative[n + 1]);
        before = here;
      }
      factorial *= k;
    }
    for (int n = 0; n <= kHarmonics; ++n) out[n][k] = derivative[n] / factorial;
  }
  return out;
}

}  // namespace geoprior::torus
