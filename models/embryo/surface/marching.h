#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "models/embryo/surface/field.h"

namespace geoprior::embryo {

/// A body-centred lattice: the corners and the centres of boxes in rows. The corner (0, 0, 0) is
/// the origin, so that the lattice is its own mirror image in the planes of its axes.
struct Lattice {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns; a rotation
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d spacing = Eigen::Vector3d::Ones();  ///< edges of a box along the axes (m)
  /// How edges grow away from the origin: at a distance x along an axis to
  /// sqrt(spacing^2 + (growth x)^2). 0: all alike.
  Eigen::Vector3d growth = Eigen::Vector3d::Zero();

  /// Along an axis, halves of boxes from the origin to metres, and back.
  [[nodiscard]] double place(int axis, double halves) const;
  [[nodiscard]] double halves(int axis, double place) const;
};

/// A surface that `march` made.
struct MarchedSurface {
  TriMesh mesh;
  std::vector<int> member_of_triangle;  ///< index into the field's solids
  /// Largest distance of a vertex from the surface (m), to first order: |f| over the larger of its
  /// mean slope along the vertex's edge of the lattice and its least slope on the surface.
  double deviation = 0;
  int evaluations = 0;  ///< of the field
};

struct MarchOptions {
  /// Leaves out boxes that the field's bound rules out. Off, every box is looked at with the plain
  /// formula: slow, and the same surface bit for bit.
  bool skip = true;
  int most_triangles = 4'000'000;
};

/// The zero surface of the field by marching tetrahedra on a body-centred lattice.
///
/// Each tetrahedron has two centres of neighbouring boxes and an edge of the face between them; all
/// are alike, and they fill space. Where the field changes sign along an edge stands one vertex;
/// each tetrahedron joins its three or four vertices in one or two triangles that lie inside it. So
/// whatever the field, the surface is closed, a 2-manifold, outward oriented, and never crosses
/// itself: the pieces in a tetrahedron separate its corners, and neighbours agree on their common
/// face. Vertices keep 1e-5 of an edge off the lattice's points, lest triangles degenerate.
///
/// A quadrilateral is split along its shorter diagonal; equal ones are decided by the corners'
/// places without regard to sign, so that a mirrored field gives the mirrored mesh.
///
/// Boxes are visited in an octree whose nodes' centres are points of the lattice; a node is left
/// out when |f| at its centre exceeds what f can change within it. Every sheet of the surface that
/// changes the sign of f at some point of the lattice is found, and no other: parts thinner than
/// half a box may have none.
///
/// @throws Error  when there are too many triangles or boxes (names `where`)
/// Source: Doi and Koide 1991 (marching tetrahedra); Labelle and Shewchuk 2007 (the lattice).
MarchedSurface march(const SolidField& field, const Lattice& lattice, const MarchOptions& options,
                     const std::string& where);

}  // namespace geoprior::embryo
