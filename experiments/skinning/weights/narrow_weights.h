#pragma once

#include "core/inputs/rig.h"
#include "core/options.h"

namespace geoprior::skinning {

struct NarrowWeightsOptions {
  double width = 1.0;
  int max_influences = 4;
};
void describe(OptionVisitor& v, NarrowWeightsOptions& options);

/// Skin weights as a hand paints them: every part of the skin follows the bone nearest to it
/// through the volume, and where two bones meet the weight passes from one to the other by a
/// smoothstep over a band of stated width.
///
///   ((A + K) u_b)_i = integral of phi_i over the skin of bone b
///   |d_b| = -l ln(2 min(u_b, 1 - u_b)),  positive where u_b > 1/2,  l = width R / 3
///   w_b = smoothstep(1/2 + d_b / (width R))
///
/// normalised over the bones. The skin of a bone is what is nearest to it among the bones that are
/// seen through the inside of the mesh; where two bones meet, what is equally near to both (the
/// outer side of a bent joint) is parted by the bisector plane of the joint. A holds the areas (of
/// the skin that sees a bone; the rest is filled from around it) and K is the cotangent Laplacian
/// with conductivity l^2. The solution u_b of this screened Poisson equation is a bone's skin
/// blurred over l: it rounds the ragged border where many bones meet, and its logarithm is the
/// signed distance from that border along the surface, exactly so across a straight border (u = 1 -
/// exp(-x/l) / 2), so that the band has the width asked for. R is the local radius: the distance to
/// the nearest bone averaged along the surface (screened, over twice itself).
///
/// A weight is positive only within half the width of the bone's skin. With more influences than
/// are kept, the largest one left out is subtracted from the others, so that weights stay
/// continuous where influences change places.
///
/// @param mesh      n vertices; closed for nearness through the volume to mean anything, but any
///                  triangle mesh is accepted
/// @param skeleton  m joints (validated)
/// @return          n x m weights that pass `validate`
/// @throws Error    without any bone, for an invalid skeleton, a position that is not finite, a
///                  mesh without area, or options out of range
/// Source: logarithm of a screened Poisson solution as distance: Varadhan 1967; Crane, Weischedel
/// and Wardetzky 2013, section 2.
SkinWeights narrow_weights(const TriMesh& mesh, const Skeleton& skeleton,
                           const NarrowWeightsOptions& options = {});

}  // namespace geoprior::skinning
