#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/options.h"
#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/drawing/dense_matches.h"
#include "solvers/sketch/drawing/mirror_plane.h"
#include "solvers/sketch/drawing/symmetric_pairs.h"
#include "solvers/sketch/surface/ruled_patches.h"

namespace geoprior::sketch {

/// Weights of the quadratic energy. All residuals are lengths: slopes are multiplied by the
/// drawing's diagonal D and second derivatives by its square, and every sum is divided by the
/// number of its rows, so that the weights depend neither on the unit nor on the sampling.
struct DepthOptions {
  double accuracy = 1;
  double variation = 1e-8;
  double pairs = 10;
  double dense = 1;
  double developability = 1;
  double planarity = 1;
  double parallel_planes = 0;
  double copied_planes = 1;
  int tangent_half_width = 4;
  double end_angle_deg = 1;  ///< rulings whose end angles differ by more are not trusted
};
void describe(OptionVisitor& v, DepthOptions& options);

/// Terms of the energy, as they are reported.
enum class DepthTerm { accuracy, variation, pairs, dense, developability, planarity, parallel };
constexpr int kDepthTerms = 7;
/// Name of a term in tables.
const char* depth_term_name(DepthTerm term);

/// What is known of a drawing before its depth.
struct DepthProblem {
  const CurveNet& net;
  MirrorPlane plane;
  std::vector<SymmetricPair> pairs;
  std::vector<DenseMatch> matches;
  std::vector<RuledPatch> ruled;
  std::vector<std::vector<int>> planar;  ///< nodes of each flat panel's border
  std::vector<bool> copied =
      {};  ///< ruled patches of which one border is the other's parallel copy

  /// Weight of the parallel planes of a ruled patch; 0: none.
  [[nodiscard]] double parallel_weight(std::size_t patch, const DepthOptions& options) const;
};

struct DepthSolution {
  Eigen::MatrixX3d nodes;                 ///< one row a node (m)
  std::array<double, kDepthTerms> rms{};  ///< of the residuals of each term (m)
  std::array<int, kDepthTerms> rows{};    ///< number of residuals
  double condition = 0;                   ///< greatest over least eigenvalue of the normal matrix
};

/// Tangents at the two ends of a ruling, and the ruling, as forms over the nodes.
struct RulingForms {
  NodeForm t1, t2, r;
};

/// The rulings of a patch that tell something of depth (see `solve_depth`, developability).
/// @param near_silhouettes  those too whose images of tangents and ruling are nearly parallel
std::vector<RulingForms> trusted_rulings(const CurveNet& net, const RuledPatch& patch,
                                         const DepthOptions& options,
                                         bool near_silhouettes = false);

/// Positions of all nodes in space: the minimum of one quadratic energy (thesis 2.1.3, second
/// step), by sparse Cholesky on its normal equations with one step of refinement. Terms:
///
/// - accuracy: x, y of a node are those drawn.
/// - variation: along a curve z varies evenly with the drawn length,
///   D^2 ((z_{i+1} - z_i) / l_i - (z_i - z_{i-1}) / l_{i-1}) / l.
/// - pairs, dense: P' - P is parallel to the normal, and the middle lies in the plane (drawn pairs;
///   matches between them).
/// - developability: the tangent plane is the same at both ends of a ruling r. The tangents T1, T2
///   and r are then dependent in space, with the coefficients that make their images dependent.
///   For images of unit length t1, t2, r that is D ((t2 x r) T1z + (r x t1) T2z + (t1 x t2) rz),
///   the triple product, linear in depth. The coefficients are not normalised: their error is that
///   of the drawn angles, whatever their size, so that a row counts as much as it is sure of.
///   Nothing follows where the images are parallel, at a silhouette, since the tangent plane is
///   seen edge on; rulings that were held while others were sought are left out too, since they end
///   at the nearest nodes, and so are those whose end angles differ by more than `end_angle_deg`:
///   the warping was led astray, most often by a silhouette drawn beside where it touches.
/// - planarity: the border of a flat panel, z = a x + b y + c with unknown a, b, c.
/// - parallel: both borders of a ruled patch are plane and parallel, z = a x + b y + c1 and
///   z = a x + b y + c2. The thesis assumes it of cones but does not list it as a term: weight 0,
///   but where one border is the parallel copy of the other in the picture (`copied_planes`; see
///   `complete_borders`).
///
/// @throws Error  when the depth of curves is not determined: the normal matrix has an eigenvalue
///                below 1e-13 times the greatest (names the curves that can move)
DepthSolution solve_depth(const DepthProblem& problem, const DepthOptions& options);

}  // namespace geoprior::sketch
