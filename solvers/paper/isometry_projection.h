#pragma once

#include <memory>
#include <vector>

#include "baselines/paper/shell_state.h"

namespace geoprior {

struct ProjectionOptions {
  int iterations = 4;    ///< most linear solves
  double strain = 1e-4;  ///< largest relative error of an edge length at which it stops
};

struct ProjectionReport {
  int iterations = 0;
  double strain_before = 0;  ///< largest relative error of an edge length
  double strain_after = 0;
};

/// Moves a sheet to a nearby isometric image of its pattern (the developability of thesis 3.2.1).
///
/// Levenberg-Marquardt on the relative errors r_e = |x_i - x_j| / l_e - 1 of all edge lengths,
/// weighted by the areas beside the edges, and the distance moved, weighted by mass:
///   min_dx  sum_e A_e (r_e + J_e dx)^2 + mu sum_i A_i |dx_i|^2.
/// Held vertices do not move. Where the held vertices leave no isometric image it ends at a least
/// squares fit. Velocities lose what would stretch the edges (the same system, least change of
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

/// Largest relative error of an edge length.
double largest_edge_strain(const ShellState& state);

}  // namespace geoprior
