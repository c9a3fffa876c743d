#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"
#include "models/sketch/surface/path.h"

namespace geoprior::sketch {

/// A surface whose triangles were split along paths, so that these run along its edges.
struct SurfaceSplit {
  Eigen::MatrixX3i triangles;
  std::vector<EdgePoint> added;  ///< of each new vertex; numbered after the old ones
  std::vector<Edge> path;        ///< edges of the paths, lower vertex first, in their order
  /// Where vertices that stand in for crossings lie then: on the path, on an edge of theirs.
  std::vector<std::pair<int, EdgePoint>> moved;

  /// Values at the vertices where they lie then, with those of the new ones between the ends of
  /// their edges.
  [[nodiscard]] Eigen::MatrixX3d interpolated(const Eigen::MatrixX3d& values) const;
  /// Edges of the old triangles, lower vertex first, as they are now.
  /// @param first_new  number of the first new vertex
  [[nodiscard]] std::vector<Edge> split_edges(std::span<const Edge> edges, int first_new) const;
};

/// Splits triangles where paths cross them. Where a path passes nearer to a vertex than a sixth of
/// the edge, the vertex stands in for the crossing, since slivers would spoil what is solved on the
/// surface, and moves there: else every path would be as rough as the mesh. It stays where it lies
/// on the border or on an edge that is kept, where a path runs through it, and where a triangle
/// would lose nearly all of its area. So that they do not, what a path crosses right before and
/// behind such a vertex on edges of its own is left to it too. An edge is split once: a second path
/// joins the first one there. Where a path would run along two sides of a triangle by a vertex it
/// takes the third: nothing could make it straight otherwise.
///
/// New vertices are numbered along the paths, so that equal paths over two meshes of different
/// numbering split them alike; triangles do not depend on what is kept.
/// @param kept  edges whose vertices stay where they are
/// @return  nothing when paths cross each other inside a triangle
std::optional<SurfaceSplit> split_along(const TriMesh& mesh, std::span<const SurfacePath> paths,
                                        std::span<const Edge> kept = {});

}  // namespace geoprior::sketch
