#pragma once

#include <span>

#include "metrics/volume/liquid_columns.h"

namespace geoprior {

/// A collapsing column of water of width a and height 2 a (Martin and Moyce 1952, n^2 = 2).
struct DamBreakPoint {
  double time;   ///< front: T = t sqrt(2 g / a); height: tau = t sqrt(g / a)
  double value;  ///< front: Z = x / a; height: H = h / (2 a)
};

/// Measured surge front and remaining height of the column: tables 2 and 6 of Martin and Moyce, "An
/// experimental study of the collapse of liquid columns on a rigid horizontal plane", 1952, for a =
/// 2.25 in.
std::span<const DamBreakPoint> measured_dam_front();
std::span<const DamBreakPoint> measured_dam_height();

/// Value at a time, linear between the points; NaN outside.
double interpolate(std::span<const DamBreakPoint> points, double time);

/// Place of the front (m): the largest x at which the column of a closed surface, averaged over the
/// rows of the grid, is deeper than `threshold`. NaN when no probe's column is.
///
/// Bracketed by the grid's probes, then bisected to a thousandth of its spacing: a block's upright
/// face lies where it is, not half a spacing beside it.
double dam_front(const TriMesh& mesh, const Columns& columns, const ColumnGrid& grid,
                 double threshold);

/// Depth of the column in the row of probes of smallest x, averaged over y (m).
double dam_height(const Columns& columns, const ColumnGrid& grid);

}  // namespace geoprior
