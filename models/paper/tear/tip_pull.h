#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/connectivity.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/stepper.h"

namespace geoprior::paper {

/// How the forces about a point are gathered and grouped.
struct PullOptions {
  double reach = 0.08;  ///< m
  int lines = 64;
  /// Smallest angle between the two resultants in space: pulls that point the same way tear
  /// nothing.
  double least_opposition_deg = 90;
};
void describe(OptionVisitor& v, PullOptions& options);

/// What pulls the sheet apart at a point C (thesis 3.2.2, Figure 3.13): all forces on a piece of
/// the sheet about C as two resultants, and their images in the pattern.
struct TipPull {
  Eigen::Vector3d left_force, right_force;  ///< N
  Eigen::Vector2d left, right;              ///< their images (N)
  double force = 0;                         ///< F: mean of both norms (N)
  double angle = 0;                         ///< theta: between the images (rad)

  Eigen::Vector2d release{0, 0};    ///< J integral about C (N)
  Eigen::Vector2d line{0, 0};       ///< in the pattern: `left_force` acts on its left (unit)
  Eigen::Vector3d normal{0, 0, 0};  ///< mean one of the sheet about C

  /// Energy that a unit of area of a tear releases that goes on in direction d (unit), J . d / e.
  /// Of a sheet that hardly stretches that is -d . (left + right) / e, and 2 F cos(theta / 2) / e
  /// along the bisector of images as long as F (thesis; O'Keefe 1994). What only passes through the
  /// piece, from left to right, adds to both images and to F, but not to their sum. (J/m^2)
  [[nodiscard]] double released(const Eigen::Vector2d& d, double thickness) const {
    return release.dot(d) / thickness;
  }
  /// Direction in which a tear releases most: away from both images, along their bisector when they
  /// are equally long.
  [[nodiscard]] Eigen::Vector2d away() const { return release.normalized(); }
  /// What the two resultants alone would release: 2 F cos(theta / 2) along the bisector of their
  /// images (thesis). (N)
  [[nodiscard]] Eigen::Vector2d of_resultants() const {
    return -force * (left.normalized() + right.normalized());
  }
  /// Out of the plane, of a tear in direction d (unit): 1 when the left of it is only pulled up the
  /// normal and the right of it down, -1 the other way round, 0 when both stay in the plane.
  [[nodiscard]] double shear(const Eigen::Vector2d& d) const {
    return d.dot(line) * normal.dot(left_force - right_force) / (2 * force);
  }
};

/// Who lies beside whom on a mesh.
struct MeshNeighbours {
  explicit MeshNeighbours(const ShellMesh& mesh)
      : triangles(mesh.triangles), edges(triangles), corners(triangles, mesh.vertex_count()) {}
  Eigen::MatrixX3i triangles;
  EdgeConnectivity edges;
  VertexCorners corners;
};

/// The pull at a vertex of the sheet. The piece has the triangles about it, and those reached over
/// edges whose centres lie within `reach`. The outside pulls at the vertices that have triangles
/// beyond it, and where the sheet is held, with the derivative of the piece's elastic energy by
/// their places; what the membrane contributes has the image A F'F S grad N_v, S the second
/// Piola-Kirchhoff stress. A line through C parts the forces; of all directions that with the
/// largest sum of both resultants' norms is taken. The J integral about C is what the outline of
/// the piece encloses of energy, less the images (Rice 1968; Eshelby).
///
/// @param least_release  of no use under it (J/m^2): the pull is then not worked out
/// Absent when the resultants do not oppose, or push the sheet together, or release too little.
std::optional<TipPull> pull_at(const Sheet& sheet, const ShellStepper& stepper,
                               const ShellState& state, const MeshNeighbours& neighbours,
                               int vertex, const PullOptions& options, double least_release = 0);

/// Second Piola-Kirchhoff stress of the membrane of a triangle, times the thickness (N/m).
Eigen::Matrix2d membrane_tension(const Sheet& sheet, const ShellState& state, int triangle);

/// The pull at a vertex where nothing concentrates the stress, on a flaw of the sheet there: a slit
/// across the largest tension s that the mean membrane stress of the triangles about the vertex has
/// in any direction. It releases G = q^2 pi a s^2 / E a unit of area, with a the slit's length from
/// a border (q = 1.12) or half its length inside (q = 1), E Young's modulus (Irwin 1957); both
/// images are opposite, each the tension over a length a. Going on into the sheet.
/// Absent when the sheet is under no tension there.
std::optional<TipPull> pull_on_flaw(const Sheet& sheet, const ShellState& state,
                                    const MeshNeighbours& neighbours, int vertex, double flaw);

}  // namespace geoprior::paper
