#pragma once

#include <vector>

#include "core/angles.h"
#include "core/mesh.h"

namespace geoprior {

/// Angle between the normals of two triangles, beyond what the bend around explains, above which
/// their edge is a crease (rad): 6 degrees.
inline constexpr double kCreaseTurn = 6 * kDegree;

/// Creases of a surface that nobody asked for.
struct CreaseMeasures {
  double turning = 0;       ///< integral of the excess angle along the edges of creases (rad m)
  double length = 0;        ///< of all edges of creases (m)
  double clean_length = 0;  ///< of those that run on smoothly in lines (m)
  double saw_share = 0;     ///< share of `turning` in the others: teeth; 0 without creases
  double rest_p95 = 0;      ///< what 95 % of the length of all edges that count stay under, of the
                            ///< excess angle (rad)
};

/// Turning of edges beyond that of the surface around them.
///
/// An edge of length l turns by theta. What a bend of local radius R explains of it is w / R, w the
/// mean height of its two triangles over it; the excess is e = max(0, |theta| - w / R), and the
/// edge is a crease's when e > `crease`. The radius is that of the strips beside the edge: on
/// either side of it, over triangles whose centroids are within 2.5 mean edge lengths of its
/// middle, the slope of the normals' angle across the edge is fitted, and the greater slope of the
/// edge's own sign is 1 / R. So the edges of a cylinder of any number of sides explain each other;
/// the flat strips beside a fold explain nothing; teeth, whose neighbours turn the other way,
/// explain nothing of each other either.
///
/// A crease is clean where at least four of its edges follow each other in a line that turns by at
/// most 35 degrees from one to the next and keeps its sign, between branches, where a further edge
/// of a crease meets it. All else is a saw, whose teeth are branches or turns at every edge or two.
///
/// What it misjudges: a fillet of less than about five edges across is partly a crease (a bend of
/// 90 degrees over n strips: see the test); on a bend whose triangles stand across it irregularly
/// the turning is uneven, which the excess sees.
///
/// @param left_out  a value a vertex, or empty: edges between two such vertices do not count, and
///                  strips end there (seams and folds that were drawn)
/// @throws Error    on a threshold that is not positive, or a mask of another length
/// Source: ours.
CreaseMeasures crease_measures(const TriMesh& mesh, double crease = kCreaseTurn,
                               const std::vector<bool>& left_out = {});

/// The signed angle and the excess of every edge of `EdgeConnectivity`; 0 where it does not count.
struct EdgeTurn {
  double angle = 0;   ///< rad, positive where the surface is convex
  double excess = 0;  ///< rad
};
std::vector<EdgeTurn> edge_turns(const TriMesh& mesh, const std::vector<bool>& left_out = {});

}  // namespace geoprior
