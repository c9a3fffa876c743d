#pragma once

#include <memory>

#include "baselines/details/shared/density_moves.h"
#include "models/details/process.h"

namespace geoprior::details {

/// Lloyd relaxation on the surface (Lloyd 1982; Du, Faber, Gunzburger 1999): details come at
/// circumcentres and fade at short edges as in Delaunay refinement, and in every frame in which the
/// surface moves, all details then go to the centroids of their Voronoi cells on the surface, a few
/// times over: the even pattern at the price of details that slide.
///
/// The cell of a detail is cut out of its tangent plane by the bisectors to its neighbours in M_d
/// (`CellChart`), its centroid weighted by the density at rest squared, so that the relaxed pattern
/// has that density; the detail goes to the point of the surface under the centroid, by no more
/// than a quarter of the smallest height of the triangles around (none of them turns over). Details
/// next to a bare part of the surface (cells that reach farther than three mean edges) stay.
///
/// What it cannot do: details do not stay where they were on the surface; a pattern at random
/// becomes a lattice with faults, whose mean edge is shorter than that of the original at equal
/// density; clusters dissolve. Nothing slides while the surface stands still.
struct LloydOptions : DensityMoveOptions {
  /// A detail that slides over the rim of a patch changes two by one: a wider dead band.
  LloydOptions() { dead_band = 0.5; }

  int iterations = 4;
  double relaxation = 1;
};
void describe(OptionVisitor& v, LloydOptions& options);

/// The method frame by frame. Phases inside a step: "move", "budget", "merge", "insert", "relax",
/// "weights". Diagnostics: inserted, revived, fading (started in the frame), flips, refused_flips,
/// max_weight_change, and of the last frame mean_slide and max_slide: what the relaxation moved
/// details by, summed over iterations [m].
std::unique_ptr<DetailMethod> make_lloyd(const DetailScene& scene, const LloydOptions& options);

/// The method as a process: `make_detail_process` around it.
std::unique_ptr<Process> make_lloyd_process(const DetailScene& scene, const LloydOptions& options);

}  // namespace geoprior::details
