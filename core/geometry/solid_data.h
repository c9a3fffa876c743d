#pragma once

// For the sources that work on solids: brings CGAL.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

namespace geoprior {

/// What a Solid (core/geometry/solid.h) holds.
struct SolidData {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::Surface_mesh<Kernel::Point_3> mesh;
};

}  // namespace geoprior
