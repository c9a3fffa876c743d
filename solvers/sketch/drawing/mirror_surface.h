#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "solvers/sketch/drawing/mirror_plane.h"

namespace geoprior::sketch {

/// A surface with the place of every vertex in the picture.
struct TexturedSurface {
  TriMesh mesh;
  Eigen::MatrixX2d texture;        ///< of each vertex
  std::vector<int> patch;          ///< of each triangle
  std::vector<bool> mirror_image;  ///< of each triangle: made by mirroring
};

/// One half of a surface and its mirror image, exactly symmetric (thesis 2.1.3, third step).
///
/// Triangles are cut along the plane; vertices nearer to it than `near` are put onto it first, so
/// that no sliver is left. Vertices in the plane are shared by both halves, the others doubled; the
/// image keeps the texture of its source, since what is hidden looks like what is seen. Vertices of
/// edges across the plane are made once an edge: what was welded stays so.
///
/// @param positive  keeps the side to which the normal points
TexturedSurface mirror_half(const TexturedSurface& surface, const MirrorPlane& plane, bool positive,
                            double near);

}  // namespace geoprior::sketch
