#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "baselines/paper/shell_state.h"
#include "baselines/paper/stepper.h"

namespace geoprior {

/// Elastic energy of a thin shell, one element a triangle: St. Venant-Kirchhoff membrane and plate
/// bending of the shape operator that the dihedral angles about the triangle give
/// (core/curvature_fit.h), or hinges.
///
///   membrane  E = A h/2 * 4 mu... see elements.cpp; bending  E = A D/2 [(1-nu) |S-S_p|^2 + nu
///   tr(S-S_p)^2]
class ShellElements {
 public:
  static constexpr int kMostNodes = 12;

  ShellElements(const ShellMesh& mesh, const PaperMaterial& material, BendingModel bending,
                double hinge_calibration);

  [[nodiscard]] int size() const;
  /// Vertices that an element depends on; the first three are those of its triangle.
  [[nodiscard]] std::span<const int> nodes(int element) const;

  /// Energy and derivatives of one element; rows 3k … 3k+2 belong to nodes(element)[k].
  struct Local {
    double membrane = 0;  ///< J
    double bending = 0;   ///< J
    Eigen::Matrix<double, 3 * kMostNodes, 1> gradient;
    Eigen::Matrix<double, 3 * kMostNodes, 3 * kMostNodes> hessian;  ///< positive semidefinite
  };
  enum class Order { energy, gradient, hessian };
  void evaluate(int element, const ShellState& state, const Eigen::MatrixX3d& x, Order order,
                Local& out) const;
  /// Elastic part of the shape operator, S - S_p, of an element (S_uu, S_uv, S_vv; 1/m).
  [[nodiscard]] Eigen::Vector3d elastic_curvature(int element, const ShellState& state,
                                                  const Eigen::MatrixX3d& x) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace geoprior
