#pragma once

#include <vector>

#include "core/mesh.h"
#include "models/embryo/body/day_state.h"
#include "models/embryo/surface/field.h"

/// The solids of one day as closed triangle meshes, one for each structure or fused group.
namespace geoprior::embryo {

struct SurfaceOptions {
  /// Of each structure, at least, but for one that others of its group leave less than 1/32 of.
  int triangles = 2000;
  /// Fused structures blend and cuts have rounded edges. Off: the sharp union.
  bool blend = true;
  double cell = 0.7;               ///< edge of a lattice box in smallest radii, at most
  int most_triangles = 4'000'000;  ///< of one mesh; more is an Error
};

/// The surface of a structure, or of the structures of a fused group.
struct StructureMesh {
  std::vector<int> structures;  ///< ascending
  TriMesh mesh;                 ///< closed, manifold, outward oriented (m)
  std::vector<int> structure_of_triangle;
  /// Largest distance of a vertex from the analytic surface (m), to first order.
  double deviation = 0;
};

/// One mesh of a field: the lattice chosen from its smallest radius, its area, its septa.
///
/// An ovoid alone is marched in its own axes, scaled by its radii, so that its triangles are those
/// of a ball; a structure in division in the axes of its septum, finer towards it and what is left
/// to divide; all else in the axes of the body, about its origin, so that left and right are mirror
/// images. Vertices lie on the surface, faces inside its bends: for the default cell 1 % of the
/// radius off on average and 6 % at worst on ducts and cylinders, 0.3 % and 1 % on ovoids; both go
/// with the square of the cell.
///
/// A neck that remains between a septum's tip and the far wall is followed down to 1/100 of the
/// structure's smallest radius; below, its rim may have holes, or it is cut through early.
/// @throws Error  as `march` does, and where a plane or a septum leaves nothing (names the first
///                structure)
StructureMesh solid_mesh(const SolidField& field, const SurfaceOptions& options);

/// The fields that a day's meshes are made of, ascending by their first structures. Points, lines
/// and planes have none; a structure in two fused groups belongs to both in one.
/// @throws Error  on what SolidField refuses
std::vector<SolidField> day_fields(const DayState& day, const SurfaceOptions& options);

/// The meshes of a day, in that order; in parallel over structures, the same bytes at any thread
/// count.
std::vector<StructureMesh> day_meshes(const DayState& day, const SurfaceOptions& options = {});

}  // namespace geoprior::embryo
