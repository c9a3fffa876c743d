#pragma once

namespace geoprior::paper {

/// Air at 20 degrees.
inline constexpr double kSoundSpeed = 343;    // m/s
inline constexpr double kAirDensity = 1.204;  // kg/m^3

}  // namespace geoprior::paper
