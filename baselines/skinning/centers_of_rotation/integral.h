#pragma once

#include <Eigen/Core>

#include "core/inputs/rig.h"
#include "core/options.h"

namespace geoprior::skinning {

struct CentersOfRotationOptions {
  double similarity_width = 0.1;  ///< sigma
  double weight_step = 0.1;
  double weight_cell = 0.005;
};
void describe(OptionVisitor& v, CentersOfRotationOptions& options);

/// How alike two places of the skin are blended, by their weights a and b (one entry a joint):
///
///   s(a, b) = sum over j != k of a_j a_k b_j b_k exp(-(a_j b_k - a_k b_j)^2 / sigma^2)
///
/// Zero where the two share fewer than two joints, largest along the curves of equal weights.
/// @throws Error  unless both have the same size and sigma > 0
/// Source: Le and Hodgins 2016.
double weight_similarity(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double sigma);

/// Optimised center of rotation of every vertex: the mean place of the skin whose weights are
/// similar to its own,
///
///   p*_i = integral of s(w_i, w(x)) x dx / integral of s(w_i, w(x)) dx   over the rest surface.
///
/// Weights are linear on a triangle. It is cut into k^2 equal ones so that no weight changes by
/// more than `weight_step` over a piece, and each piece counts with its area, centroid and weights
/// there. A vertex that is not blended (one influence, or no piece like it) keeps its own place.
///
/// s is a sum over pairs of joints: pieces are listed by pair, and a vertex visits the lists of its
/// own pairs. In a list, pieces whose two weights fall in one cell of width `weight_cell` are
/// replaced by their mean, so that a list is no longer than there are cells. With a cell of 1/20
/// sigma this moves centers by less than a thousandth of the length over which weights change
/// (tested); with `weight_cell = 0` every piece is summed.
///
/// @param rig  welded mesh of n vertices, skeleton of m joints, weights n x m
/// @return     n x 3 (m)
/// @throws Error  as require_skinnable(), and for options out of range
/// Source: Le and Hodgins 2016; the paper subdivides where weights differ by more than
/// 0.1 and restricts the sum to neighbours in weight space, where this has cells.
Eigen::MatrixX3d centers_of_rotation(const RiggedMesh& rig,
                                     const CentersOfRotationOptions& options = {});

}  // namespace geoprior::skinning
