#pragma once

#include <memory>

#include "baselines/details/shared/density_moves.h"
#include "models/details/process.h"

namespace geoprior::details {

/// Delaunay refinement (Chew 1989; farthest-point insertion): details stay where they are; new ones
/// come at circumcentres of triangles of M_d - the points farthest from all details around -,
/// walked to over M_d and put on the surface, largest circumradius first.
///
/// A density rho asks for the equilateral lattice of edge 1.075 / sqrt(rho) and circumradius
/// 0.620 / sqrt(rho). A detail comes where the circumradius exceeds `circumradius` times that one
/// and its patch of the surface has fewer details than the density at rest times its area; in a
/// patch with more, one end of an edge shorter than `shortest_edge` times the lattice's fades, the
/// shortest edges first. Patches and their numbers are those of the thesis' method (`AreaBudget`):
/// the two differ in where details come and which ones go. No two changes of a kind share a vertex
/// in a frame. Details come with weight 0 and leave at weight 0.
///
/// What it cannot do: it knows distances alone; every gap that the pattern had on purpose (between
/// clusters) is filled first once its patch is stretched.
struct DelaunayRefinementOptions : DensityMoveOptions {};

/// The method frame by frame. Phases inside a step: "move", "budget", "merge", "insert",
/// "weights". Diagnostics: inserted, revived, fading (started in the frame), flips, refused_flips,
/// max_weight_change.
std::unique_ptr<DetailMethod> make_delaunay_refinement(const DetailScene& scene,
                                                       const DelaunayRefinementOptions& options);

/// The method as a process: `make_detail_process` around it.
std::unique_ptr<Process> make_delaunay_refinement_process(const DetailScene& scene,
                                                          const DelaunayRefinementOptions& options);

}  // namespace geoprior::details
