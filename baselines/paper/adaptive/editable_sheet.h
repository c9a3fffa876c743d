#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// A sheet whose triangulation changes: triangles with their neighbours, and the three local
/// operations, each of which carries the state along.
///
/// Split halves an edge, flip exchanges the diagonal of two triangles, collapse takes a vertex
/// away. Positions and velocities of new vertices are linear along the edge; plastic curvature and
/// damage keep their integral over the triangles that change. Vertices and triangles taken away
/// stay as dead entries until `state()`.
class EditableSheet {
 public:
  enum class Kind {
    inside,  ///< may go anywhere
    side,    ///< on a straight part of the border: may go along it
    fixed    ///< corner of the border or anchor of a handle
  };
  struct Vertex {
    Eigen::Vector2d pattern;
    Eigen::Vector3d x, v;
    Eigen::Matrix2d size = Eigen::Matrix2d::Identity();  ///< sizing tensor (1/m^2)
    Kind kind = Kind::inside;
    int segment = -1;   ///< handle whose segment it lies on
    int triangle = -1;  ///< one of those about it; -1: dead
    bool is_new = false;
  };
  struct Triangle {
    std::array<int, 3> vertex;     ///< counter-clockwise in the pattern; -1: dead
    std::array<int, 3> neighbour;  ///< across the edge from vertex[k] to vertex[k + 1]; -1: border
    Eigen::Vector3d plastic_curvature;
    double damage = 0;
  };
  /// The edge from vertex[k] to vertex[k + 1] of a triangle.
  struct Side {
    int triangle = -1;
    int k = 0;
  };

  /// @throws Error  on an edge with more than two triangles
  explicit EditableSheet(const ShellState& state);

  [[nodiscard]] ShellState state(double time) const;
  /// Rows of `state()` that are new or whose surroundings changed: what a pop filter may move.
  [[nodiscard]] std::vector<bool> changed() const;

  [[nodiscard]] const std::vector<Vertex>& vertices() const { return vertices_; }
  [[nodiscard]] std::vector<Vertex>& vertices() { return vertices_; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }

  /// The side from a to b, or from b to a where only that exists; triangle -1 when they are no
  /// neighbours.
  [[nodiscard]] Side find(int a, int b) const;
  /// `find(a, b)` that looks first where the edge was when last seen.
  [[nodiscard]] Side find(int a, int b, Side hint) const;
  [[nodiscard]] int start(Side s) const { return corner(s.triangle, s.k); }
  [[nodiscard]] int end(Side s) const { return corner(s.triangle, (s.k + 1) % 3); }
  /// Vertex opposite to the side in its triangle.
  [[nodiscard]] int apex(Side s) const { return corner(s.triangle, (s.k + 2) % 3); }
  /// The side of the same edge in the triangle across it; triangle -1 at the border.
  [[nodiscard]] Side opposite(Side s) const;
  /// Triangles about a vertex, counter-clockwise; at the border from one end to the other.
  void star(int v, std::vector<int>& triangles) const;
  /// Neighbours of a vertex, counter-clockwise.
  void ring(int v, std::vector<int>& neighbours) const;
  /// Calls `visit(triangle, k)` for the triangles about v, which is their corner k, in the order of
  /// `star`, until it returns true; returns whether it did.
  template <class Visit>
  bool around(int v, Visit&& visit) const;
  /// True where both ends lie on the segment of one handle: such an edge must stay.
  [[nodiscard]] bool is_held(Side s) const;

  /// @return  the new vertex in the middle of the edge; its size is the mean of both ends'
  int split(Side s);

  /// Whether the two triangles can exchange their diagonal: neither border nor held, and the new
  /// ones are not flatter than `least_altitude` of their longest edge unless the old ones were.
  [[nodiscard]] bool can_flip(Side s, double least_altitude) const;
  void flip(Side s);

  /// Whether `v` can be drawn into its neighbour `w`: connectivity stays that of a disc, border and
  /// held segments keep their shape, no triangle turns over or gets too flat, and no new edge is
  /// strained by more than `most_strain` unless one of the old ones was.
  [[nodiscard]] bool can_collapse(int v, int w, double least_altitude, double most_strain) const;
  void collapse(int v, int w);

 private:
  [[nodiscard]] int corner(int triangle, int k) const { return triangles_[triangle].vertex[k]; }
  [[nodiscard]] int across(int triangle, int k) const { return triangles_[triangle].neighbour[k]; }
  [[nodiscard]] int corner_of(int triangle, int v) const {
    const auto& t = triangles_[triangle].vertex;
    return t[0] == v ? 0 : t[1] == v ? 1 : 2;
  }
  [[nodiscard]] const Eigen::Vector2d& point(int v) const { return vertices_[v].pattern; }
  [[nodiscard]] double twice_area(int triangle) const;
  [[nodiscard]] double altitude_ratio(int a, int b, int c) const;
  [[nodiscard]] double strain(int a, int b) const;
  [[nodiscard]] bool keeps_disc(int v, int w) const;
  [[nodiscard]] bool keeps_border(int v, int w) const;
  void replace_neighbour(int triangle, int old, int now);
  void place_triangle(int triangle, const std::array<int, 3>& vertex,
                      const std::array<int, 3>& neighbour);
  void carry_creases(const std::vector<Triangle>& old, const std::vector<int>& now);

  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<bool> changed_;  ///< of vertices
};

template <class Visit>
bool EditableSheet::around(int v, Visit&& visit) const {
  const int first = vertices_[v].triangle;
  if (first < 0) return false;
  // Clockwise to the border, or once around.
  int begin = first, next = first;
  do {
    begin = next;
    next = across(begin, corner_of(begin, v));
  } while (next >= 0 && next != first);
  if (next == first) begin = first;
  for (int t = begin; t >= 0;) {
    const int k = corner_of(t, v);
    if (visit(t, k)) return true;
    t = across(t, k == 0 ? 2 : k - 1);
    if (t == begin) break;
  }
  return false;
}

}  // namespace geoprior::paper
