#pragma once

#include "core/inputs/rig.h"
#include "core/options.h"

namespace geoprior::skinning {

struct HeatWeightsOptions {
  double heat = 1.0;  ///< c
  int max_influences = 4;
  double smallest_weight = 1e-4;
};
void describe(OptionVisitor& v, HeatWeightsOptions& options);

/// Skin weights by bone heat equilibrium (Baran and Popović 2007, section 4): every bone j keeps
/// the skin that is nearest to it at temperature 1, the rest at 0, and the weights w_j are the
/// temperatures when heat also flows along the surface:
///
///   (L + A H) w_j = A H p_j
///
/// L is the cotangent Laplacian (positive semi-definite), A the vertex areas (a third of the
/// triangles around), H_ii = k c / d_i^2 with d_i the distance to the nearest *visible* bone and k
/// the number of bones at that distance, and p_ij = 1/k for those, 0 else. The weights of a vertex
/// sum to 1 because constants solve the system. One factorisation serves all bones.
///
/// A bone point is visible when the segment from the vertex to it starts into the mesh and meets no
/// triangle. A vertex that sees no bone gets H = 0: heat reaches it along the surface only. When a
/// connected component has no vertex that sees a bone, its vertices use the nearest bone, seen or
/// not. Negative cotangent weights of an edge (opposite angles of more than 180 degrees together)
/// are raised to 1e-5, so that all weights lie in [0, 1] on any mesh.
///
/// Joints without a tail have no bone and get no weight; a bone that is nobody's nearest gets none
/// either.
///
/// @param mesh      n vertices; closed for the visibility to mean anything, but any triangle mesh
/// is
///                  accepted
/// @param skeleton  m joints (validated)
/// @return          n x m weights that pass `validate`
/// @throws Error    without any bone, for an invalid skeleton, a position that is not finite, or
///                  options out of range
SkinWeights heat_weights(const TriMesh& mesh, const Skeleton& skeleton,
                         const HeatWeightsOptions& options = {});

}  // namespace geoprior::skinning
