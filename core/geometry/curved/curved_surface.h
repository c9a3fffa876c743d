#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// Unit normals of a smooth surface through a mesh, as each triangle sees them: row 3 t + k belongs
/// to the half-edge from corner k of triangle t to its next corner.
///
/// Where the triangles at an edge agree the surface is smooth across it; where they do not it is
/// creased there. Where the two edges of a triangle at a corner do not agree, the corner is the
/// apex of a cone, whose normal is that of each line from it.
struct EdgeNormals {
  Eigen::MatrixX3d origin;  ///< where the half-edge begins
  Eigen::MatrixX3d tip;     ///< where it ends

  [[nodiscard]] static EdgeNormals zero(Eigen::Index triangles);
};

/// How finely a curved surface is sampled.
struct CurvedSampling {
  double tolerance = 0;  ///< most that an edge may miss of its curve (m), and
  double angle = 0;      ///< most that its normal may turn (rad), but
  double shortest = 0;   ///< an edge as short as this is never divided (m)
  /// Farthest that the surface may leave the flat triangle (m). Absent: as far as it likes.
  std::optional<double> farthest;
};

/// Samples of a curved surface: a mesh whose vertices are there once for every normal they have.
struct CurvedSurface {
  TriMesh mesh;
  Eigen::MatrixX3d normals;  ///< of each vertex, unit
  std::vector<int> parent;   ///< of each triangle: the flat one it belongs to
  double distance = 0;  ///< farthest of a sample from the point of the flat triangle it is of (m)
};

/// The smooth surface through the vertices of a mesh that has the given normals there, as triangles
/// fine enough to be looked at.
///
/// An edge from a to b, d = b - a, with normals p and q at its ends is the cubic whose tangents
/// there are d projected along p and q (Vlachos et al. 2001). In its middle lies
///
///   m = (a + b) / 2 + f ((d.q) q - (d.p) p) / 8,    f = 2 / (cos h (1 + cos h)),   cos 2h = p.q
///
/// with f = 1 for the cubic; with this f an arc of a circle is met exactly, also by the
/// helix that a slanting edge of a cylinder is. The normal there is s - 3/2 e (e.s), e = d/|d|,
/// s = (p + q) / 2, which is that of the cubic for small slopes. A line whose ends have the very
/// same normal is straight, with that normal along it, also where it leans on it (then the cubic
/// would be an S). Edges that their chord misses are halved, all at once, and again; new edges
/// within a triangle are lines of the same kind between points that are there already.
///
/// There are no cracks: the middle of an edge follows from the edge alone; of a creased one it is
/// the mean of what its triangles say. With `farthest` = B a displacement u from the flat triangle
/// becomes u / (1 + (|u| / B)^8)^(1/8): shorter than B, and the same to 1/2000 up to B / 2.
///
/// @param mesh     any triangles; edges of one triangle are borders
/// @param normals  of its half-edges
/// @throws Error   for normals of another number than half-edges
CurvedSurface curved_surface(const TriMesh& mesh, const EdgeNormals& normals,
                             const CurvedSampling& sampling);

}  // namespace geoprior
