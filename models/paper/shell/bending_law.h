#pragma once

namespace geoprior::paper {

enum class BendingModel { shape_operator, hinge };
/// How a mesh resists bending (ShellElements).
struct BendingLaw {
  BendingModel model = BendingModel::shape_operator;
  double hinge_calibration =
      4;  ///< D_hinge / D that makes equilateral hinges as stiff as the plate
  /// Stiffness against what the fitted curvature leaves of the angles at borders and folds,
  /// relative to what the plate opposes to the curvature that would give an edge that angle. It
  /// must be positive, or border edges hinge freely, and small, since it resists the variation of
  /// curvature, which the plate does not: a curvature that varies by a tenth over a patch gets 1e-3
  /// of its energy added.
  double fit_residual = 0.1;
};

}  // namespace geoprior::paper
