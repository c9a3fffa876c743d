#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "solvers/paper/hybrid_options.h"
#include "solvers/paper/meshing/ruling_editor.h"
#include "solvers/paper/meshing/ruling_mesh.h"

namespace geoprior::paper {

/// What the simulated sheet asks for in one triangle.
struct Demand {
  double weight = 0;  ///< compressive strain, or that of the bending that has released it; 0: none
  double excess = 0;  ///< compressive strain over the admissible one
  Eigen::Vector2d direction{1, 0};  ///< d: of compression, or of the largest curvature, unit
  bool bent_ground = false;         ///< rulings of another direction are already there
  bool by_bending = false;          ///< the mesh has bent already; nothing is compressed
};

/// Triangles of similar demand that touch (thesis 3.2.1: the compressed area).
struct DemandGroup {
  std::vector<int> triangles;
  Eigen::Vector2d direction{1, 0};  ///< d, unit
  Eigen::Vector2d centre{0, 0};     ///< weighted by area and demand (m)
  double low = 0, high = 0;         ///< extent along d about the centre (m)
  double strength = 0;              ///< sum of area times weight (m^2)
  double excess = 0;                ///< largest of its triangles
  bool bent_ground = false;
  bool by_bending = false;  ///< on flat ground asks for rulings, but never for a singular point
};

/// Compression by the triangle's Green strain G = (F'F - I) / 2: eigenvalue g2 < 0 along d.
///
/// "euler": -g2 > factor (g_plate + g_shell), where a plate of span L along d buckles at g_plate =
/// 4 pi^2 D / (E h L^2), and a sheet already bent across d with curvature kappa at
/// g_shell = kappa h / sqrt(3 (1 - nu^2)) more (classical buckling of the compressed cylinder).
/// "threshold": -g2 > eps_c.
/// Euler's strain of a sheet of paper is tiny (1e-6 for 0.2 m), and so is the buckle that it makes:
/// the test also asks that its steepest slope, 2 sqrt(-g2), exceeds `least_slope_deg`.
/// Compression that the rulings there release by bending (d_perp within the group angle of them)
/// asks for nothing. Inside flat ground, bending of more than kappa_0 that the mesh has already
/// done counts as well, because at the stiffness of paper it releases compression within a step;
/// its weight is the shortening of an arc, (kappa L / 2 pi)^2.
/// A ruling that turns by more than the refinement angle at one of its vertices is straight no
/// longer and has released compression as well: the approach of its ends is judged like strain
/// along it, there. The sheet bends in two directions, and rulings of both meet. With "threshold"
/// any turn counts, and eps_c alone decides.
std::vector<Demand> find_demands(const Sheet& sheet, const ShellState& state,
                                 const Eigen::MatrixX3d& curvature, const RulingMesh& mesh,
                                 const RulingEditor& editor, const HybridOptions& options);

/// Connected groups of one direction, strongest first. On flat ground directions up to 45 degrees
/// apart are one.
std::vector<DemandGroup> group_demands(const std::vector<Demand>& demands, const ShellMesh& mesh,
                                       double group_angle_deg);

/// Strain -g of a triangle's map along its direction of strongest compression (negative when it is
/// stretched everywhere) and that direction.
struct Compression {
  double strain;
  Eigen::Vector2d direction;
};
Compression compression(const ShellState& state, int triangle);

}  // namespace geoprior::paper
