#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/embryo/shape/curve.h"
#include "models/embryo/shape/shape.h"

namespace geoprior::embryo {

/// A short, nearly straight piece of a duct: a cubic centre line p(t), t in [0, 1], and a radius
/// r(t) = r0 + t (r1 - r0).
struct DuctPiece {
  CubicSpan line;
  double start_radius = 0, end_radius = 0;
  Eigen::Vector3d start, chord;  ///< the chord runs from start to start + chord
  double chord_squared = 0;
  double largest_radius = 0;
  double sagitta = 0;  ///< no point of the centre line is farther from the chord
};

/// The pieces of a duct, each of which turns by little more than a fifth of a right angle. The
/// radius is linear in the arc of the whole centre line at the pieces' ends.
/// @throws Error  on a duct without control points
std::vector<DuctPiece> duct_pieces(const Shape& duct);

/// min over t of |x - p(t)| - r(t): the signed distance to the union of the balls that run along
/// the centre line. It changes by no more than x moves.
///
/// By Newton steps on (p - x).p' = r' |x - p| from the foot on the chord. Exact where x is closer
/// to the line than the centres of its curvature are, and an upper bound elsewhere.
double piece_distance(const DuctPiece& piece, const Eigen::Vector3d& x);

/// A lower bound of it, from the chord alone.
double piece_bound(const DuctPiece& piece, const Eigen::Vector3d& x);

}  // namespace geoprior::embryo
