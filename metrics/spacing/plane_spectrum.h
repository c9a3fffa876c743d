#pragma once

#include <span>

#include "core/geometry/surface_point.h"
#include "core/mesh.h"
#include "metrics/spacing/radial_spectrum.h"

namespace geoprior {

/// Whether a surface is a rectangle in a plane of constant z, with sides along x and y: what
/// `plane_spectrum` asks for. Flat to 1e-9 of its size, its area that of its bounding box to 1e-6.
bool fills_rectangle(const TriMesh& surface);

/// `radial_spectrum` of places on such a surface, in the rectangle that it fills.
///
/// @param surface  one of which `fills_rectangle` holds (m)
/// @param unit     spacing (m): that of the original pattern
/// @throws Error   as `radial_spectrum`
RadialSpectrum plane_spectrum(const TriMesh& surface, std::span<const SurfacePoint> places,
                              double unit);

}  // namespace geoprior
