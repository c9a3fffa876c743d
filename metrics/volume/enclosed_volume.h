#pragma once

#include <optional>
#include <vector>

#include "core/mesh.h"
#include "metrics/volume/closedness.h"

namespace geoprior {

/// Volume that a surface encloses (m^3): `signed_volume` of a closed 2-manifold. Absent for other
/// surfaces, whose integral means nothing, and without triangles.
/// @param closed  the surface's own closedness, when it is known already
std::optional<double> enclosed_volume(const TriMesh& mesh, const Closedness& closed);
std::optional<double> enclosed_volume(const TriMesh& mesh);

/// Largest |V - V0| / |V0| of volumes over time, V0 the first. Absent when one is absent, V0 is 0
/// or there is none. Blind to a volume that is lost and comes back between two of them.
std::optional<double> largest_drift(const std::vector<std::optional<double>>& volumes);

}  // namespace geoprior
