#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>

namespace geoprior::paper {

/// What it takes to tear a sheet (thesis 3.2.2): fracture energy E_f = K T(p) at a point p of the
/// pattern, T a seeded noise texture in (0, 1]; with a grain, K depends on the direction of the
/// tear:
///
///   K(d) = K (cos^2 phi + across sin^2 phi),   phi the angle of d to the grain.
struct Toughness {
  double energy = 0;  ///< K: of a unit of area of the torn section (J/m^2); 0: does not tear
  double noise = 0;   ///< depth of the texture: T lies between 1 - noise and 1
  double noise_length = 3e-3;       ///< of its waves (m)
  std::uint64_t seed = 1;           ///< of the texture
  std::optional<double> grain_deg;  ///< direction of the fibres in the pattern, from u towards v
  double across = 1;                ///< K across the fibres over K along them

  [[nodiscard]] bool tears() const { return energy > 0; }
  /// T(p): smooth noise, a function of the point and the seed alone.
  [[nodiscard]] double texture(const Eigen::Vector2d& p) const;
  /// Under every E_f (J/m^2).
  [[nodiscard]] double least() const { return energy * (1 - noise) * std::min(1.0, across); }
  /// E_f of a tear at p in the direction d (unit) (J/m^2).
  [[nodiscard]] double at(const Eigen::Vector2d& p, const Eigen::Vector2d& d) const;
};

}  // namespace geoprior::paper
