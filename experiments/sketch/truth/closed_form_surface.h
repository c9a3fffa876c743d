#pragma once

#include "core/mesh.h"
#include "core/options.h"

namespace geoprior::sketch {

enum class ClosedFormShape {
  sphere_cap,   ///< curved the same everywhere: no pattern of it is isometric
  cone_sector,  ///< a sector of a ring, rolled up: its pattern is that sector
};

/// A disc whose best pattern is known.
struct ClosedFormOptions {
  ClosedFormShape shape = ClosedFormShape::sphere_cap;
  double radius = 0.1;
  double angle_deg = 40;
  double inner_share = 0.4;
  double wrap_deg = 250;
  int rings = 40;
};
void describe(OptionVisitor& v, ClosedFormOptions& options);

/// The surface about the y axis, upwards, all of whose vertices lie on the shape.
///
/// Cap: rings of 6 k vertices about the pole. Cone: a grid of rings by columns, about square.
///
/// @throws Error  on a sector that is wider when flat than rolled up
TriMesh closed_form_surface(const ClosedFormOptions& options);

}  // namespace geoprior::sketch
