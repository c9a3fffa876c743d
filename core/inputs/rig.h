#pragma once

#include <Eigen/SparseCore>

#include "core/inputs/skeleton.h"
#include "core/mesh.h"

namespace geoprior {

/// Rows: vertices, columns: joints; each row non-negative with sum 1.
using SkinWeights = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Throws Error (naming the vertex) on a negative or non-finite weight or a row whose sum is not 1
/// within 1e-6.
void validate(const SkinWeights& weights, int vertex_count, int joint_count);

/// A mesh with skeleton and weights: what every skinning method takes. The mesh is welded.
struct RiggedMesh {
  TriMesh mesh;
  Skeleton skeleton;
  SkinWeights weights;
};

}  // namespace geoprior
