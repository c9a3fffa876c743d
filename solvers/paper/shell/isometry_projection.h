#pragma once

#include <memory>
#include <vector>

#include "models/paper/shell/state.h"

namespace geoprior::paper {

struct ProjectionOptions {
  int iterations = 4;    ///< most linear solves
  double strain = 1e-4;  ///< largest principal strain at which it stops
};

struct ProjectionReport {
  int iterations = 0;
  double strain_before = 0;  ///< largest principal Green strain of a triangle, in modulus
  double strain_after = 0;
};

/// Moves a sheet to a nearby isometric image of its pattern (the developability of thesis 3.2.1).
///
/// Levenberg-Marquardt on the Green strains G = (F'F - I) / 2 of the triangles, weighted by area,
/// and the distance moved, weighted by mass:
///   min_dx  sum_T A_T |G_T + dG_T dx|^2 + mu sum_i A_i |dx_i|^2.
/// Strains and not edge lengths, because in a narrow triangle small errors of the lengths are large
/// strains. Held vertices do not move. Where they leave no isometric image it ends at a least
/// squares fit. Velocities lose what would strain the triangles (the same system, least change of
/// momentum), so that kinetic energy does not grow except by what is held.
class IsometryProjector {
 public:
  /// @param held  vertices that do not move
  IsometryProjector(const ShellMesh& mesh, const std::vector<bool>& held);
  ~IsometryProjector();
  IsometryProjector(IsometryProjector&&) noexcept;
  IsometryProjector& operator=(IsometryProjector&&) noexcept;

  ProjectionReport project(ShellState& state, const ProjectionOptions& options);
  [[nodiscard]] const std::vector<bool>& held() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace geoprior::paper
