#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/connectivity.h"
#include "core/geometry/surface_point.h"
#include "core/mesh.h"

namespace geoprior {

/// A surface with each of its triangles laid out in a plane: corner 0 at the origin, corner 1 on
/// the positive x axis, corner 2 above it.
class UnfoldedSurface {
 public:
  /// @throws Error  on a triangle without its vertices or a vertex that is not finite
  explicit UnfoldedSurface(TriMesh surface);

  [[nodiscard]] const TriMesh& mesh() const { return mesh_; }
  struct Triangle {
    std::array<Eigen::Vector2d, 3> corner;
    std::array<double, 3> length;  ///< of edge (c, c + 1) (m)
    std::array<double, 3> cosine;  ///< of the angle at corner c
  };
  [[nodiscard]] const Triangle& triangle(int face) const { return triangles_[face]; }
  [[nodiscard]] Eigen::Vector2d layout(const SurfacePoint& place) const;
  [[nodiscard]] Eigen::Vector3d position(const SurfacePoint& place) const;
  /// Corners 3 f + c of the triangles around a vertex, ascending.
  [[nodiscard]] std::span<const int> corners_of(int vertex) const { return corners_.of(vertex); }
  /// Longest edge of the triangles around a vertex (m).
  [[nodiscard]] double longest_edge(int vertex) const { return longest_edge_[vertex]; }
  /// @throws Error  on a place that is on no triangle
  void require(const SurfacePoint& place) const;

 private:
  TriMesh mesh_;
  std::vector<Triangle> triangles_;
  VertexCorners corners_;
  std::vector<double> longest_edge_;  ///< of the vertices
};

/// Distances along a surface from one place, up to a reach.
///
/// A front crosses an edge (a, b) into the triangle behind it as the circle whose centre lies at
/// the distances of a and b before the edge (the spherical wave of Novotni and Klein 2002); a path
/// that would miss the edge goes through a corner. Vertices are visited in order of distance
/// (Dijkstra 1959), again when one turns out nearer.
///
/// In the plane, and wherever the surface unfolds into one, distances are exact unless something
/// stands in the way: behind a corner that is gone around they are a few percent long (a circle
/// about the corner is not one about the source), and triangles in which two ways round meet are
/// off by a part of their size. On a curved surface the error falls with the square of the edge
/// length. No distance of a vertex is shorter than the chord.
///
/// Reusable: a new source costs what it reaches.
class SurfaceFront {
 public:
  explicit SurfaceFront(const UnfoldedSurface& surface);

  /// @throws Error  on a place that is on no triangle or a reach that is not positive
  void spread(const SurfacePoint& source, double reach);
  /// Triangles that may have a point within the reach, in the order they were found.
  [[nodiscard]] std::span<const int> faces() const { return reached_; }

  /// The front within one triangle.
  class Within {
   public:
    /// Distance of a point of the triangle's layout (m).
    [[nodiscard]] double distance(const Eigen::Vector2d& point) const;

   private:
    friend class SurfaceFront;
    static constexpr double kFar = std::numeric_limits<double>::infinity();
    std::array<Eigen::Vector2d, 3> corner_, centre_;  ///< centre c: for edge (c, c + 1)
    std::array<double, 3> at_corner_{};
    std::array<bool, 3> crosses_{};  ///< whether edge (c, c + 1) has a centre
    bool has_source_ = false;
    Eigen::Vector2d source_;
  };
  /// Whether no point of a triangle is nearer than `distance` (m), by its corners; a triangle that
  /// was not reached is.
  [[nodiscard]] bool is_beyond(int face, double distance) const;
  /// Infinite distances in a triangle that was not reached.
  [[nodiscard]] Within within(int face) const;

 private:
  void clear();
  void offer(int vertex, double distance);
  void visit(int vertex, double distance);
  void cross(int face, std::size_t from, double distance);

  static constexpr double kFar = std::numeric_limits<double>::infinity();
  const UnfoldedSurface& surface_;
  int source_face_ = -1;
  Eigen::Vector2d source_layout_ = Eigen::Vector2d::Zero();
  Eigen::Vector3d source_ = Eigen::Vector3d::Zero();
  double reach_ = 0;
  std::vector<double> distance_;              ///< of the vertices
  std::vector<char> is_reached_;              ///< of the triangles
  std::vector<int> touched_, reached_;        ///< vertices, triangles
  std::vector<std::pair<double, int>> heap_;  ///< nearest on top
};

}  // namespace geoprior
