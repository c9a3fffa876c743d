#pragma once

#include "core/geometry/solid.h"

namespace geoprior {

/// Moves, splits and collapses edges in `passes` passes until they are about equally long. Creases
/// stay curves, but their edges too are split and collapsed: where two of them meet, a Boolean
/// leaves edges far shorter than wanted, and slivers would stay there.
///
/// @param crease_deg  edges at which the surface turns by more are creases
/// Source: Botsch and Kobbelt 2004a; CGAL 5.5, Polygon Mesh Processing.
void remesh(Solid& solid, double edge_length, double crease_deg, int passes);

}  // namespace geoprior
