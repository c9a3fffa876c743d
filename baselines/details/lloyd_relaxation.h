#pragma once

#include <memory>

#include "baselines/details/detail_process.h"
#include "core/options.h"

namespace geoprior {

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
struct LloydRelaxationOptions {
  int iterations = 4;        ///< of a frame in which the surface moves
  double relaxation = 1;     ///< part of the way to the centroid
  double circumradius = 1;   ///< least circumradius filled, in units of the lattice's
  double shortest_edge = 1;  ///< edges below may lose an end, in units of the lattice's
  int patch_details = 48;    ///< details of a patch at rest
  /// A patch acts when off by more than 1/2 + this; a detail that slides over its rim changes two
  /// by one.
  double dead_band = 0.5;
  bool anticipate = true;    ///< patches ask ahead, as `ReplicationOptions::anticipate`
  double weight_rate = 0.1;  ///< largest change of a weight in a frame
  LengthRule lengths = LengthRule::chord;
};
void describe(OptionVisitor& v, LloydRelaxationOptions& options);

/// The method frame by frame. Phases inside a step: "move", "budget", "merge", "insert", "relax",
/// "weights". Diagnostics: inserted, revived, fading (started in the frame), flips, refused_flips,
/// max_weight_change, and of the last frame mean_slide and max_slide: what the relaxation moved
/// details by, summed over iterations [m].
std::unique_ptr<DetailMethod> make_lloyd_relaxation(const DetailScene& scene,
                                                    const LloydRelaxationOptions& options);

/// As a process: `make_detail_process` around it.
std::unique_ptr<Process> make_lloyd_relaxation_process(const DetailScene& scene,
                                                       const LloydRelaxationOptions& options);

}  // namespace geoprior
