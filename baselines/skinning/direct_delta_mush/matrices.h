#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/inputs/rig.h"
#include "core/options.h"

namespace geoprior::skinning {

struct DirectDeltaMushOptions {
  int iterations = 20;  ///< p
  double lambda = 3;
  double kappa = 1;
  double alpha = 0.8;
  double smallest_influence = 1e-5;
};
void describe(OptionVisitor& v, DirectDeltaMushOptions& options);

/// One joint's part in the motion of one vertex: the symmetric matrix
///
///   Omega = [ shape   offset ]     of the rest skin around the vertex, relative to the vertex's
///           [ offset' share  ]     smoothed place p: ten numbers (m^2, m, 1)
///
/// At rest the shapes of a vertex sum to a covariance, the offsets to 0 and the shares to 1.
struct JointMatrix {
  int joint = 0;
  Eigen::Matrix3d shape = Eigen::Matrix3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  double share = 0;
};

/// What direct delta mush knows of a rig.
struct DirectDeltaMushMatrices {
  Eigen::MatrixX3d smoothed;        ///< p_i, n x 3 (m)
  std::vector<std::size_t> offset;  ///< n + 1: matrices of vertex i are [offset[i], offset[i + 1])
  std::vector<JointMatrix> matrices;  ///< of a vertex: the largest share first, then by joint
};

/// Precomputes the matrices of every vertex. With L the cotangent Laplacian, D its diagonal, u_k
/// the rest positions (homogeneous), w_kj the weights and T_i the translation by -p_i:
///
///   B = (I + lambda D^-1 L)^-p,  C = (I + kappa D^-1 L)^-p      (rows sum to 1)
///   Psi_ij   = sum_k B_ik w_kj u_k u_k',   p_i = sum_k B_ik u_k,   w'_ij = sum_k C_ik w_kj
///   Omega_ij = T_i ((1 - alpha) Psi_ij + alpha w'_ij [p_i; 1] [p_i; 1]') T_i'
///
/// (I + lambda D^-1 L) x = b is solved as (D + lambda L) x = D b, which is symmetric and positive
/// definite: one sparse Cholesky factorisation for all joints and steps. Edge weights of the
/// Laplacian are at least 1e-5, so that B and C have no negative entries.
///
/// Influences of which both smoothed weights, (B w)_ij and w'_ij, are below `smallest_influence`
/// are given to the vertex's strongest joint: sums over joints stay exact. Vertices move by up to
/// 0.02 % of the limb's radius for it at 115 degrees of flexion (1e-4: 0.15 %, 1e-3: 0.7 %).
///
/// To the shape of the strongest joint a millionth of the vertex's whole covariance is added in all
/// directions: a patch that degenerates to a line or a point turns with that joint.
///
/// @param rig  welded mesh of n vertices, skeleton of m joints, weights n x m
/// @throws Error  as require_skinnable(), and for options out of range
/// Source: Le and Lewis 2019, variant 0. Ours: matrices relative to p_i, the
/// clamped edge weights, what is done with small influences and degenerate patches.
DirectDeltaMushMatrices direct_delta_mush_matrices(const RiggedMesh& rig,
                                                   const DirectDeltaMushOptions& options = {});

}  // namespace geoprior::skinning
