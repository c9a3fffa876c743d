#pragma once

#include <span>

#include "core/mesh.h"
#include "models/sketch/pattern/make_pattern.h"
#include "models/sketch/surface/cut_surface.h"

namespace geoprior::sketch {

/// What a pattern may lose to fair seams.
struct SlideLimits {
  double tolerance = 0.02;  ///< of stretch
  double share = 0.98;      ///< of the area within it that is enough
};

/// Makes seams fair (`fair_seams`) where the pattern allows it: one after the other slides, and
/// goes back when less of the area is within the tolerance than is enough, and by more than 1 % of
/// it than before all of them, or when the parts come to lie on each other. Seams on sharp edges go
/// back, since what slides off an edge cuts it off. Work is that of laying all flat once a seam and
/// once more.
/// @param seams  edges that may slide
/// @param kept   further edges that it is cut along, whose vertices stay
/// @return       the surface, as `fair_seams` gives it
/// @throws Error as `cut_surface` and `flatten`
TriMesh slide_seams(const TriMesh& surface, std::span<const SeamEdge> seams,
                    std::span<const SeamEdge> kept, const SlideLimits& limits,
                    const PatternOptions& pattern);

}  // namespace geoprior::sketch
