#pragma once

namespace geoprior::paper {

/// Mechanical energies (J).
struct ShellEnergies {
  double membrane = 0, bending = 0, kinetic = 0, gravity = 0, contact = 0;
  double hands = 0;  ///< of hands that give
  /// What a sheet at rest makes small, weight and contact apart.
  [[nodiscard]] double strain() const { return membrane + bending + hands; }
};

}  // namespace geoprior::paper
