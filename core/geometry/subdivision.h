#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "core/inputs/rig.h"
#include "core/mesh.h"

namespace geoprior {

/// What a subdivision step did: the refined triangles, and the linear map from old to new vertices,
/// which positions, weights and any other vertex quantity follow.
struct Subdivision {
  Eigen::MatrixX3i F;
  /// New x old vertices; rows sum to 1. The first rows belong to the old vertices, in their order.
  Eigen::SparseMatrix<double, Eigen::RowMajor> stencil;
  std::vector<int> parent;      ///< of each new triangle: the old one it lies in
  std::vector<bool> quartered;  ///< of each new triangle: whether its parent was split in four
  /// The old edge that each new vertex was put on. New vertices are numbered after the old ones.
  std::vector<std::array<int, 2>> split_edge;
};

/// One step of Loop subdivision of the triangles marked in `refine` (empty: all of them).
///
/// Marked triangles are split in four; unmarked ones with two or more split edges too, until none
/// is left; the remaining ones with one split edge are halved, so that the mesh stays conforming
/// (red and green refinement). A vertex moves when all of its triangles are quartered, a new vertex
/// is smoothed when both triangles of its edge are; elsewhere old vertices stay and new ones lie on
/// the middle of their edge. So nothing outside the region changes shape. Border edges of an open
/// mesh follow the cubic B-spline rules (1/8, 3/4, 1/8 and 1/2, 1/2).
///
/// Halved triangles get worse when they are split again: for several steps on one region use
/// `loop_subdivide_region`, which keeps them apart.
///
/// @throws Error  for a non-manifold edge (names it), or marks of another size than the triangles
/// Source: Loop 1987 (weights 5/8 - (3/8 + cos(2 pi / n) / 4)^2); Bank et al. 1983 (red-green).
Subdivision loop_subdivision(const Eigen::MatrixX3i& F, int vertex_count,
                             const std::vector<bool>& refine = {});

/// Mesh and weights after one step of `loop_subdivision`; the skeleton stays.
RiggedMesh loop_subdivide(const RiggedMesh& rig, const std::vector<bool>& refine = {});

/// A rig refined by several steps, and how to carry other things along.
struct RefinedRig {
  RiggedMesh rig;
  std::vector<Subdivision> steps;
};

/// `steps` steps on a region. Step i refines the region grown by the remaining steps in rings of
/// triangles, so that the halved triangles of one step are never split in the next; they lie in
/// rings about the region (one of every size).
RefinedRig loop_subdivide_region(const RiggedMesh& rig, const std::vector<bool>& region, int steps);

/// A mesh that is split at seams follows the subdivision of its welded mesh: the same triangles are
/// split, seams stay seams.
struct SplitSubdivision {
  TriMesh mesh;
  std::vector<int> welded_of_split;            ///< for each new split vertex, the new welded vertex
  std::vector<std::array<int, 2>> split_edge;  ///< as in `Subdivision`, in old split vertices
};

/// @param split            triangles in the order of the welded mesh (none was dropped by the weld)
/// @param welded_of_split  for each split vertex, its welded vertex before the step
/// @param step             of the welded mesh
/// @param welded_positions of the welded vertices after the step
/// @throws Error  when the triangles do not correspond (names the first)
SplitSubdivision subdivide_split(const TriMesh& split, const std::vector<int>& welded_of_split,
                                 const Eigen::MatrixX3i& welded_triangles, const Subdivision& step,
                                 const Eigen::MatrixX3d& welded_positions);

}  // namespace geoprior
