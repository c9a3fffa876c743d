#pragma once

#include <Eigen/Core>

#include "core/inputs/rig.h"

namespace geoprior::skinning {

/// Weights spread over the skin as by diffusion, over a share of a length at each vertex (its local
/// radius): solves (A R^-2 + c L) W' = A R^-2 W several times, A vertex areas, R lengths, L the
/// cotangent Laplacian, c = width^2 over the number of times. They blend over about the same part
/// of a limb then, however narrow they were painted and however fine the mesh. Weights of less than
/// 1e-3 are dropped (but the largest of a vertex); those that are kept sum to 1.
///
/// @param rig     welded mesh of n vertices, weights n x m
/// @param length  at each vertex (m), positive
/// @param width   in such lengths; positive
SkinWeights spread_weights(const RiggedMesh& rig, const Eigen::VectorXd& length, double width);

}  // namespace geoprior::skinning
