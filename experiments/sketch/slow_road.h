#pragma once

#include "testbed/topic.h"

namespace geoprior::sketch {

/// `slow-road`: a whole way from a drawing to a pattern as geometry libraries offer it, the
/// iterations of several-views on a hull by exact Booleans and isotropic remeshing (`exact_hull`),
/// laid flat by CGAL's as-rigid-as-possible.
///
/// It does not repeat itself between builds and machines: corefinement numbers what it makes by
/// addresses.
MethodEntry slow_road_method();

}  // namespace geoprior::sketch
