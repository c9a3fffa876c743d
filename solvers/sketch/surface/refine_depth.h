#pragma once

#include <Eigen/Core>

#include "core/options.h"
#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/drawing/depth_system.h"
#include "solvers/sketch/drawing/mirror_plane.h"

namespace geoprior::sketch {

/// Parameters of the refinement beside those of the linear system.
struct RefineOptions {
  int iterations = 60;
  double accuracy = 30;
  double right_angle = 10;
  double vector_ratio = 0;
  bool perspective = false;
  double flatness = 1e-4;  ///< weight of no perspective, when it is unknown
};
void describe(OptionVisitor& v, RefineOptions& options);

/// What a refinement found.
struct RefinedDepth {
  DepthSolution solution;   ///< condition: of the linear system, unchanged
  MirrorPlane plane;        ///< through the tail of sym-a at z = 0, like the drawn one
  double vector_ratio = 1;  ///< |sym-a| over |sym-b| in space
  double perspective = 0;   ///< growth of the image over one diagonal of depth
  int iterations = 0;
  /// Cost with the drawn vectors' lengths held to their ratio over the cost without it, where both
  /// were sought; the solution is the latter's when this is large.
  double ratio_gain = 1;
  double cost_before = 0, cost_after = 0;  ///< half the sum of weighted squares (m^2)
};

/// Positions and mirror plane together, from a linear solution on (non-linear least squares).
///
/// The residuals are those of `solve_depth` with the same weights, but true in space and with the
/// mirror plane unknown:
///
/// - pairs, dense: (I - n n')(P' - P) and the distance of the middle from the plane, n free;
/// - developability: D sin of the angle between the tangent planes at the two ends of a ruling,
///   D det(T1, r, T2) |r| / (|T1 x r| |T2 x r|), also near silhouettes, where the linear row has no
///   weight;
/// - planarity, parallel: with the x, y that are found;
/// - accuracy: the image of a node is where it was drawn. With `perspective` p the image of (x, y)
///   is c + (1 + p z / D) ((x, y) - c) about the middle c of the drawing: weak perspective. Matches
///   and rulings stay those of an orthographic picture, so that less of it is found than is there;
/// - vectors: sym-a and sym-b lie in the plane and are orthogonal in space; their lengths' ratio is
///   held to the given one with weight `vector_ratio`.
///
/// An orthographic picture of one mirror symmetric object leaves no freedom but that of the drawn
/// vectors: direction of pairs and right angle fix the plane, so that the ratio of lengths need not
/// be known. Without pairs well apart in direction the plane is as uncertain as they are.
///
/// In a flat view the right angle and the pairs hardly tell the plane, and the ratio of lengths
/// does: `refine_either` tries both.
///
/// Deterministic: one thread, fixed order.
/// @param start  of `solve_depth`
/// @throws Error when the solver fails
/// Source: thesis 2.1.4 names non-linear constraints as future work; the formulation is ours.
RefinedDepth refine_depth(const View& view, const DepthProblem& problem, const DepthSolution& start,
                          const DepthOptions& options, double vector_ratio,
                          const RefineOptions& refine);

}  // namespace geoprior::sketch
