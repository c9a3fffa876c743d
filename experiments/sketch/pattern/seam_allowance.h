#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/sketch/surface/positive_winding.h"

namespace geoprior::sketch {

/// One closed border of a piece, the material on its left: the outer one counter-clockwise, those
/// of holes clockwise.
struct AllowanceBorder {
  PlaneLoop points;
  std::vector<double> allowance;  ///< of the segment from point i to point i + 1; not negative
};

/// The lines along which a piece is cut when material is left standing outside its borders.
///
/// The cut piece is the union of the piece, of a strip as wide as its allowance outside every
/// segment, and of a cap at every convex corner, where the strips' outer lines are prolonged until
/// they meet (mitre). A mitre that reaches further than `miter_limit` times the wider allowance is
/// cut straight across there: never nearer to the corner than either allowance. Between nearly
/// straight segments of different allowance the outline steps. Where allowances of different
/// segments overlap, as in a dart or a notch, the outline goes round both; a hole narrower than
/// its allowances, or of which less than 1 mm² is left, is filled.
///
/// @param borders      the outer one first; simple and not crossing each other
/// @param miter_limit  at least 1; 1 / sin(half the angle of the sharpest corner that keeps its
///                     point)
/// @param where        for errors: the piece
/// @return             the outer line counter-clockwise first, then holes clockwise. Without any
///                     allowance the borders themselves, point for point.
/// @throws Error       a border of less than three points, borders that cross or run the wrong way,
///                     an allowance that is negative or no number, a limit below 1
std::vector<PlaneLoop> cut_lines(const std::vector<AllowanceBorder>& borders, double miter_limit,
                                 const std::string& where);

}  // namespace geoprior::sketch
