#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/curvature_fit.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/bending_law.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Elastic energy of a thin shell, one element a triangle: St. Venant-Kirchhoff membrane and plate
/// bending of the shape operator S that the dihedral angles about the triangle give
/// (core/geometry/curvature_fit.h), or hinges.
///
///   G = (F'F - I) / 2, F the map from the pattern (3 x 2), A the pattern's area
///   membrane  E = A Y/2 [(1-nu) |G|^2 + nu tr(G)^2],            Y = E h / (1 - nu^2)
///   bending   E = A D/2 [(1-nu) |S-S_p|^2 + nu tr(S-S_p)^2] / (1 + weakening damage)
///   hinge     E = sum over edges, k D/4 l^2/(A1+A2) (theta - theta_p)^2 / 2
///                 / (1 + weakening damage), k = hinge_calibration, theta_p the angle that S_p
///                 would give; half of it in each triangle
///
/// Where the mesh names rulings, triangles at one also resist the folds of their edges that are
/// none, as the plate does that is bent by the angle over the two triangles beside the edge: D/2
/// l^2 (theta - theta_p)^2 / (A1 + A2), half of it each. A cylinder over its rulings has no such
/// folds.
///
/// Triangles at the border and folds also resist the residual theta - jump . S of their own edges,
/// `fit_residual` times as much as S; it is zero for constant curvature. So every interior edge is
/// resisted.
///
/// An element has 6 nodes where every hinge about it is point symmetric (grids with parallel
/// diagonals, equilateral meshes), up to 12 elsewhere inside, at borders a few more.
///
/// Hessians are positive semidefinite: the membrane's keeps the tensile part of the stress, that of
/// bending is Gauss-Newton in the angles. Both are exact at rest and differ from the true ones by
/// stress times second derivatives.
class ShellElements {
 public:
  static constexpr int kMostNodes = 16;

  /// @throws Error  from `fit_curvature`
  ShellElements(const ShellMesh& mesh, const PaperMaterial& material, const BendingLaw& law);

  [[nodiscard]] int size() const;
  /// The fit of shape operators from which bending is computed.
  [[nodiscard]] const CurvatureFit& curvature_fit() const;
  /// Vertices that an element depends on; the first three are those of its triangle.
  [[nodiscard]] std::span<const int> nodes(int element) const;

  /// Energy and derivatives of one element; rows 3k … 3k+2 belong to nodes(element)[k]. Rows and
  /// columns beyond its nodes are not written.
  struct Local {
    double membrane = 0;  ///< J
    double bending = 0;   ///< J
    Eigen::Matrix<double, 3 * kMostNodes, 1> gradient;
    Eigen::Matrix<double, 3 * kMostNodes, 3 * kMostNodes> hessian;  ///< positive semidefinite
  };
  /// `material_hessian` leaves out what the membrane's stress adds to the Hessian: the stiffness
  /// about places that are taken to be free of stress.
  enum class Order { energy, gradient, hessian, material_hessian };
  void evaluate(int element, const ShellState& state, const Eigen::MatrixX3d& x, Order order,
                Local& out) const;
  /// Elastic part of the shape operator, S - S_p, of an element (S_uu, S_uv, S_vv; 1/m).
  [[nodiscard]] Eigen::Vector3d elastic_curvature(int element, const ShellState& state,
                                                  const Eigen::MatrixX3d& x) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace geoprior::paper
