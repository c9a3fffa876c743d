#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "baselines/fluid/liquid/tank/tank.h"

namespace geoprior::fluid {

/// Side of the domain that `open_top` opens: the one that gravity points away from (+z without
/// gravity).
struct DomainSide {
  int axis = 2;
  bool upper = true;
};
DomainSide top_side(const Eigen::Vector3d& gravity);

/// Distances at nodes and open area fractions of faces (marching squares on the face's four node
/// distances), walls of the domain included. Fractions below 1 % are closed.
///
/// Distances are exact up to four cells from a body and no smaller than that beyond. A node within
/// 1e-4 cells of a body counts as inside, so that a box along the grid closes its faces.
/// Source: Batty, Bertails and Bridson 2007.
void solid_fractions(const Tank& tank, std::span<const PlacedSolid> solids, const GridShape& shape,
                     SolidFractions& out);

/// `solid_fractions` for a simulation: bodies that stand still are sampled once, bodies that move
/// only in the box where they are and were. Keeps no reference to the tank.
class SolidSampler {
 public:
  SolidSampler(const Tank& tank, const GridShape& shape);
  /// @param solids  as many as the tank has, in its order, where they are now
  /// @param out  of the last call, or empty at the first
  void sample(std::span<const PlacedSolid> solids, SolidFractions& out);

 private:
  using NodeBox = Eigen::AlignedBox3i;  ///< nodes, both ends included
  void sample_solid(const PlacedSolid& solid, int index, const NodeBox& box, SolidFractions& out);
  void update_faces(std::span<const PlacedSolid> solids, const NodeBox& box, SolidFractions& out);
  void restore(const NodeBox& box, SolidFractions& out);
  [[nodiscard]] NodeBox box_of(const PlacedSolid& solid) const;

  GridShape shape_;
  bool open_top_ = true;
  DomainSide top_;
  std::vector<bool> moves_;
  bool started_ = false;
  ScalarGrid still_distance_;        ///< of bodies that stand still, without walls
  ScalarGrid distance_;              ///< of all bodies, without walls
  std::vector<std::int16_t> owner_;  ///< nearest body of a node, -1: none near
  std::vector<std::int16_t> still_owner_;
  std::vector<NodeBox> moved_boxes_;  ///< of the last call
};

/// Particles stay half a cell off a solid, so that cells which the solid cuts may look empty: cells
/// whose centre lies in a solid become liquid (distance -h/2) where liquid is within half a cell.
/// For distances made of particles; an exact level set needs none of it.
/// Source: Batty 2008, Fluid3D, extrapolation of phi into solids.
void extend_into_solids(const SolidFractions& solids, const GridShape& shape,
                        ScalarGrid& liquid_distance);

}  // namespace geoprior::fluid
