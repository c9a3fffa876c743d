#pragma once

#include "core/options.h"

namespace geoprior::paper {

/// What the size of triangles answers to; an edge is as long as the shortest of these allows.
///
/// The defaults are those that came nearest to the dense sheet for the least time in
/// paper/square-compress: at an angle of 0.3 (cloth) the sheet kinks where it should bend, at an
/// aspect of 0.1 it takes a third more triangles for the same shape. But for `size_max`: edges of
/// 0.2 m, for that sheet of a metre, are as long as the other sheets, which cannot bend at all then
/// when hands begin to move; with 0.03 m forces at hands are those of the dense sheet.
struct SizingOptions {
  double size_min = 0.01;      ///< m
  double size_max = 0.03;      ///< m
  double refine_angle = 0.15;  ///< rad
  /// Edge length times the root of the compressive strain along it (m): up to a factor 2 / pi the
  /// height of the wrinkle that the edge would hide.
  double refine_compression = 5e-4;
  double refine_velocity = 0.5;  ///< m/s
  double aspect_min = 0.05;
};
void describe(OptionVisitor& v, SizingOptions& options);

}  // namespace geoprior::paper
