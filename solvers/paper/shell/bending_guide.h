#pragma once

#include <Eigen/Core>

#include "models/paper/sheet/pattern_locator.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/stepper.h"

namespace geoprior::paper {

/// How a sheet wants to bend: the shape operator over its pattern, linear between vertices.
class BendingField {
 public:
  /// @param curvature  S_uu, S_uv, S_vv of every vertex (n x 3, 1/m)
  BendingField(ShellState sheet, Eigen::MatrixX3d curvature);

  [[nodiscard]] Eigen::Matrix2d at(const Eigen::Vector2d& p) const;
  [[nodiscard]] const ShellState& sheet() const { return sheet_; }
  /// Of the vertices of `sheet()`.
  [[nodiscard]] const Eigen::MatrixX3d& curvature() const { return curvature_; }

 private:
  ShellState sheet_;
  Eigen::MatrixX3d curvature_;
  PatternLocator locator_;
};

/// Finds out how the sheet would bend if its mesh let it.
///
/// A mesh whose edges are rulings bends about them and nothing else: asked for its curvature it
/// shows the directions that it was given. So its shape is carried over to an even mesh of plate
/// elements, which bends in every direction alike, and relaxed there by an implicit step from rest:
/// folds that oppose each other within an edge or two vanish in it, the shape that the handles
/// force on the sheet stays. The even mesh is coarse (`edge`) and would be a poor sheet; its
/// curvature is good enough to lay rulings by.
class BendingGuide {
 public:
  /// @param edge  length of the even mesh's edges (m)
  BendingGuide(const Sheet& sheet, const Pattern& pattern, double edge,
               const StepperOptions& options, std::uint64_t seed);

  [[nodiscard]] BendingField relaxed(const ShellState& sheet);

 private:
  ShellMesh mesh_;
  ShellStepper stepper_;
  bool analysed_ = false;
};

}  // namespace geoprior::paper
