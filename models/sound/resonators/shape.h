#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/state_bytes.h"
#include "models/sound/events/event.h"
#include "models/sound/resonators/grid.h"
#include "models/sound/resonators/resonator.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

/// A resonator as the piece of the sheet that it is, at one time: its cells in space, how each of
/// their sides is bounded, and what the event has changed. A solver of shells can mesh it.
struct ResonatorShape {
  enum class Side : char { inside, free, clamped };
  /// The sheet about the centre of a cell, to second order in (xi, eta), the offset in the pattern
  /// over the spacing: p + du xi + dv eta + duu xi^2 / 2 + dvv eta^2 / 2 + duv xi eta (m).
  struct Cell {
    int column = 0, row = 0;
    Eigen::Matrix<double, 3, 6> place;  ///< p, du, dv, duu, dvv, duv
    std::array<Side, 4> sides{};        ///< right, above, left, below
    /// By which the event has changed the shape operator (S_uu, S_uv, S_vv; 1/m).
    Eigen::RowVector3d change{0, 0, 0};
  };
  double spacing = 0;  ///< m
  std::vector<Cell> cells;

  [[nodiscard]] double area() const {
    return static_cast<double>(cells.size()) * spacing * spacing;
  }
  /// What a point of a cell is in space, `xi` and `eta` from -1/2 to 1/2.
  static Eigen::Vector3d at(const Cell& cell, double xi, double eta);
};

/// The resonator of an event as it is in `field`. Sides towards cells that are blocked or held are
/// clamped, those at the border of the sheet are free unless it is held there. Of a resonator that
/// has fallen apart the largest piece is taken.
/// @param event  with its cells; without any the shape is empty
ResonatorShape resonator_shape(const SoundGrid& grid, const SheetField& field,
                               const SoundEvent& event, const IsHeld& is_held);

/// A mesh of a resonator for a shell solver.
struct ResonatorMesh {
  ShellState state;           ///< at rest, without plastic curvature
  std::vector<Edge> clamped;  ///< of its border
  Eigen::MatrixX3d change;    ///< of the shape operator, by triangle (1/m)
};

/// Two triangles for each of `subdivision`^2 squares a cell, diagonals alternating.
/// @throws Error  on an empty shape or a subdivision below 1
ResonatorMesh mesh_of(const ResonatorShape& shape, int subdivision);

void save(const ResonatorShape& shape, StateWriter& out);
ResonatorShape load_resonator_shape(StateReader& in);

}  // namespace geoprior::sound
