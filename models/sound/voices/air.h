#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace geoprior::sound {

/// Air at 20 degrees.
inline constexpr double kSoundSpeed = 343;    // m/s
inline constexpr double kAirDensity = 1.204;  // kg/m^3

/// By how much the pressures on both sides of a sheet differ where it swings by 1 m at the angular
/// frequency omega (Pa/m), far below coincidence: 2 rho omega^2 / sqrt(k_w^2 - k^2), the air beside
/// an endless plate with waves of the number k_w.
///
/// A mode has no single wave: k_w^2 is the integral of |grad w|^2 over that of w^2. Where it swings
/// as one, all of its air moves along, as beside a stiff disc of the same area, whose force
/// 8/3 rho a^3 omega^2 (Lamb 1932, section 102) is met by k_w = 3 pi / (4 a): the least that is
/// taken.
/// @param wave_square  k_w^2 of the mode (1/m^2)
/// @param area         of what swings (m^2)
inline double pressure_jump(double omega, double wave_square, double area) {
  constexpr double kPi = std::numbers::pi;
  const double least = 9 * kPi * kPi * kPi / (16 * area);
  const double k = omega / kSoundSpeed, square = std::max(wave_square, least);
  // Near coincidence, which paper does not come to, it stays finite.
  return 2 * kAirDensity * omega * omega / std::sqrt(std::max(square - k * k, square / 4));
}

}  // namespace geoprior::sound
