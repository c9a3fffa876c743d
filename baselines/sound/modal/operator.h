#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "models/paper/shell/elements.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

/// How the border of a piece of paper is held while it rings. Border edges that are not named are
/// free.
struct ModalSupports {
  /// Border edges that neither move nor turn: creases stiff enough to be walls.
  std::vector<Edge> clamped = {};
  /// A vertex that does not move along a direction (any length but 0); it may be named up to three
  /// times. Slopes stay free: the normals of all border vertices make a plate simply supported.
  struct Hold {
    int vertex;
    Eigen::Vector3d direction;
  };
  std::vector<Hold> holds = {};
};

/// The edges as undirected ones, ascending.
std::vector<Edge> sorted_edges(const std::vector<Edge>& edges);

/// Small vibrations of the dense solver's own shell about a shape, K u = omega^2 M u.
///
/// K is the sum of the elements' material Hessians (ShellElements, Order::material_hessian),
/// M the lumped masses of the stepper. So the shape is taken for one free of stress, whether it is
/// bent elastically or creased: K does not depend on the rest curvature. What that leaves out of a
/// sheet bent elastically by the curvature kappa are the moments it holds, (kappa / k)^2 of the
/// stiffness of a wave k, and membrane tension, which in a simulated sheet is mostly error of its
/// mesh. A sheet near the point where it snaps is softer than K.
///
/// Clamped edges. The shell has no rotations, so a clamped edge gets a mirror triangle beyond it
/// whose third corner moves as the mirror image of the inner triangle's: u' = (I - 2 t t') u, t the
/// direction in the triangle's plane across the edge. The mirror triangles only bend the edges of
/// the inner ones; they have neither energy nor mass. (Holding a row of triangles instead clamps
/// the sheet half a cell beyond the edge.)
///
/// The unknowns are the free displacements times the roots of their masses, so that M is the unit
/// matrix.
struct ModalOperator {
  /// @throws Error  on a mesh without triangles or in several parts, arrays of other sizes than the
  ///                mesh, anything not finite, a clamped edge that is not on the border, a hold
  ///                without vertex or direction, a material out of range, and when nothing is left
  ///                to move
  ModalOperator(const PaperMaterial& material, const ShellState& state,
                const ModalSupports& supports, const paper::BendingLaw& law);

  /// Displacements (3 n x k; m, by vertices x0 y0 z0 x1 ...) of `unknowns` x k scaled unknowns.
  [[nodiscard]] Eigen::MatrixXd displacements(const Eigen::MatrixXd& scaled) const;
  /// Force (3 n, N) on the sheet when the rest curvature of its triangles changes by `change`
  /// (triangles x 3: S_uu, S_uv, S_vv; 1/m).
  [[nodiscard]] Eigen::VectorXd curvature_load(const Eigen::MatrixX3d& change) const;

  /// A vertex of the mesh or a mirror corner: it moves as `turn` times what its vertex does.
  struct Node {
    int vertex;
    Eigen::Matrix3d turn;
  };
  /// Of a vertex: its displacement is `basis` times `size` unknowns from `first` on, over the root
  /// of its mass.
  struct Freedom {
    int first = 0, size = 0;
    Eigen::Matrix3d basis;
  };

  std::vector<Node> nodes;
  ShellState state;  ///< mirror triangles and corners behind those of the sheet
  paper::ShellElements elements;
  int triangles = 0;              ///< of the sheet
  std::vector<Freedom> freedoms;  ///< of the sheet's vertices
  Eigen::VectorXd mass;           ///< of the sheet's vertices (kg)
  int unknowns = 0;
  Eigen::SparseMatrix<double> stiffness;  ///< M^-1/2 K M^-1/2 (1/s^2), lower triangle
  Eigen::MatrixXd rigid;  ///< rigid motions that the supports allow (unknowns x r, orthonormal)

 private:
  void free_vertices(const ModalSupports& supports);
  void assemble();
  void find_rigid_motions(const ModalSupports& supports);
};

}  // namespace geoprior::sound
