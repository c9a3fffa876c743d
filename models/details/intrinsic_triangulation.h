#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/state_bytes.h"

namespace geoprior::details {

/// What `IntrinsicTriangulation::check` finds. All zero but `euler` and `border_edges` when it is
/// the Delaunay triangulation of a manifold.
struct TriangulationReport {
  int vertices = 0;
  int triangles = 0;
  int euler = 0;             ///< V - E + F; equal to that of the surface when it covers it
  int border_edges = 0;      ///< edges with one triangle
  int broken_links = 0;      ///< half-edges whose twin does not point back or has other ends
  int broken_vertices = 0;   ///< vertices whose triangles are not one fan (or that have none)
  int repeated_edges = 0;    ///< pairs of vertices joined by more than one edge, or loops
  int broken_triangles = 0;  ///< lengths that violate the triangle inequality, or unequal twins
  int not_delaunay = 0;  ///< interior edges whose opposite angles sum to more than pi + 1e-8 …
  int blocked = 0;  ///< … and those of them whose flip would join two vertices twice (not counted
                    ///< in not_delaunay)
  double worst_angle_sum = 0;  ///< largest sum of opposite angles (rad)
  [[nodiscard]] bool manifold() const {
    return broken_links + broken_vertices + repeated_edges + broken_triangles == 0;
  }
};

/// Triangulation of points on a surface by half-edges and edge lengths alone: the intrinsic metric.
///
/// Half-edge h = 3 t + k runs from corner k to corner k + 1 of triangle t, counter-clockwise.
/// Angles and areas come from lengths; a flip lays two triangles out in the plane and measures the
/// other diagonal there, so that Lawson's algorithm ends (the plane's argument holds edge by edge).
/// It stays a simplicial complex: an operation that would join two vertices twice is refused, and
/// counted by `refused_flips`. Vertices and triangles keep their numbers; freed numbers are used
/// again.
///
/// Each triangle carries a density (expected details per area), the thesis' "initial area" carried
/// through changes of the triangulation: every operation conserves the sum of density x area over
/// the triangles it rewrites.
class IntrinsicTriangulation {
 public:
  IntrinsicTriangulation() = default;
  /// Takes triangles and positions of an oriented manifold; lengths are distances.
  IntrinsicTriangulation(std::span<const std::array<int, 3>> triangles,
                         std::span<const Eigen::Vector3d> position);

  // --- What is there ---
  [[nodiscard]] int vertex_slots() const { return static_cast<int>(out_.size()); }
  [[nodiscard]] int triangle_slots() const { return static_cast<int>(density_.size()); }
  [[nodiscard]] bool vertex_alive(int v) const { return out_[v] >= 0; }
  [[nodiscard]] bool triangle_alive(int t) const { return origin_[3 * t] >= 0; }
  [[nodiscard]] int triangle_count() const { return live_triangles_; }
  [[nodiscard]] int origin(int h) const { return origin_[h]; }
  [[nodiscard]] int twin(int h) const { return twin_[h]; }  ///< -1 at a border
  [[nodiscard]] double length(int h) const { return length_[h]; }
  [[nodiscard]] int tip(int h) const { return origin_[next(h)]; }
  [[nodiscard]] static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
  [[nodiscard]] static int previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
  [[nodiscard]] bool border_vertex(int v) const { return border_[v] != 0; }
  [[nodiscard]] std::array<int, 3> corners(int t) const {
    return {origin(3 * t), origin(3 * t + 1), origin(3 * t + 2)};
  }
  [[nodiscard]] double area(int t) const;  ///< Kahan's formula (m^2)
  [[nodiscard]] double density(int t) const { return density_[t]; }
  void set_density(int t, double density) { density_[t] = density; }
  /// A half-edge that leaves `v`; of a border vertex the one along the border.
  [[nodiscard]] int outgoing(int v) const { return out_[v]; }
  /// Neighbours of `v`, counter-clockwise (from border to border).
  void neighbours(int v, std::vector<int>& into) const;
  /// Half-edge from a to b; -1 when there is none (a border edge that exists only the other way).
  [[nodiscard]] int find_edge(int a, int b) const;
  [[nodiscard]] bool adjacent(int a, int b) const;

  // --- Metric ---
  /// Measures all lengths as distances (chords) of the vertices' positions. In parallel.
  void measure(std::span<const Eigen::Vector3d> position);
  void set_length(int h, double length);  ///< of the edge: both half-edges

  // --- Changes ---
  /// Flips edges until all are Delaunay (opposite angles sum to at most pi; cot + cot >= -1e-10).
  /// @return  number of flips
  int flip_to_delaunay();
  /// Flips until all are Delaunay, beginning with the edges of the triangles around some vertices;
  /// for what `insert` without flips has left.
  int flip_around(std::span<const int> vertices);
  /// Flips one edge. False when it is a border edge, its quadrilateral is not convex, or the other
  /// diagonal exists.
  bool flip(int h);
  /// A vertex at barycentric coordinates (all positive) of a triangle, then Delaunay flips around
  /// it (none with `flips = false`).
  /// @return  number of the vertex
  int insert(int triangle, const Eigen::Vector3d& barycentric, bool flips = true);
  /// Removes an interior vertex: flips until it has three triangles, merges them, Delaunay flips;
  /// where that is stuck (strong curvature) by `collapse` onto the nearest neighbour that allows
  /// it, with lengths measured from `position`. False, and nothing is changed but the diagonals,
  /// when the link condition forbids every collapse: the vertex holds the topology.
  bool remove(int v, std::span<const Eigen::Vector3d> position);
  /// Half-edge collapse of its origin onto its tip, under the link condition; the new edges are
  /// chords of `position`. Interior origins only.
  bool collapse(int h, std::span<const Eigen::Vector3d> position);

  [[nodiscard]] std::int64_t refused_flips() const { return refused_flips_; }

  // --- Diagnosis (linear cost) ---
  [[nodiscard]] TriangulationReport check() const;
  /// Corners of the live triangles, in order of their numbers.
  [[nodiscard]] std::vector<std::array<int, 3>> triangles() const;
  /// Renumbers vertices: `number[v]` for every live vertex, a permutation of 0 … live - 1.
  void renumber(std::span<const int> number);

  void save(StateWriter& out) const;
  void load(StateReader& in);

 private:
  struct Diagonal;
  [[nodiscard]] Diagonal other_diagonal(int h) const;
  [[nodiscard]] double cotangent(int h) const;
  [[nodiscard]] bool delaunay(int h) const;
  void set_triangle(int t, const std::array<int, 3>& corner, const std::array<double, 3>& length,
                    const std::array<int, 3>& twin);
  void refresh_outgoing(int t);
  int settle(std::vector<int>& stack);
  void push_edges(int t, std::vector<int>& stack) const;
  void link(std::span<const std::array<int, 3>> triangles);
  int new_triangle();
  int new_vertex();
  void free_triangle(int t);
  [[nodiscard]] int degree(int v) const;
  bool flip_down_to_three(int v, std::vector<int>& touched);
  bool merge_three(int v, std::vector<int>& touched);
  [[nodiscard]] bool can_collapse(int h) const;

  std::vector<int> origin_;      ///< per half-edge; -1: free triangle
  std::vector<int> twin_;        ///< per half-edge
  std::vector<double> length_;   ///< per half-edge
  std::vector<double> density_;  ///< per triangle
  std::vector<int> out_;         ///< per vertex; -1: free
  std::vector<char> border_;     ///< per vertex
  std::vector<int> free_triangles_, free_vertices_;
  int live_triangles_ = 0;
  std::int64_t refused_flips_ = 0;
  std::vector<int> stack_;          ///< edges to look at
  std::vector<int> refused_;        ///< edges whose flips were refused
  std::vector<double> cotangents_;  ///< scratch, per half-edge
};

}  // namespace geoprior::details
