#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "experiments/details/drawing/hole_chart.h"
#include "models/details/surface_walk.h"

namespace geoprior::details {

/// A triangle mesh with holes, on its way to a `DrawnDetails`.
struct HoledMesh {
  std::vector<Eigen::Vector3d> x;
  std::vector<Eigen::Vector3d> normal;
  std::vector<int> hole;  ///< of each vertex: whose border it lies on; -1: on none
  std::vector<std::array<int, 3>> triangle;
};

/// A surface with the charts of its holes: refined until the border of every hole crosses small
/// triangles only, then cut.
///
/// Refinement is bisection of longest edges (Rivara 1984): it keeps the surface as it is, leaves no
/// hanging vertices, and no angle becomes smaller than half the smallest one. The cut is that of
/// marching triangles: a vertex is inside a hole or not, an edge between the two has one border
/// vertex, at the radius; that gives a manifold whatever the numbers. Vertices close to the border
/// are moved onto it first, where the surface stays a manifold and no triangle turns over: that
/// keeps needles away.
class HoleMesh {
 public:
  HoleMesh(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
           std::span<const Eigen::Vector3d> normals);

  void add(int hole, const HoleChart& chart);
  /// Refines until triangles that a border crosses have edges of at most
  /// 2 pi radius / segments x 2.1. Then holes that meet another one or go around a part of the
  /// surface, so that what would be cut out is no disc of its own, are shrunk until it is.
  /// @param least  holes that become smaller are given up (m)
  void refine(int segments, double least);
  /// Radius of the hole added as the i-th; 0: given up.
  [[nodiscard]] double radius(int i) const { return hole_[i].radius; }
  [[nodiscard]] HoledMesh cut();

 private:
  struct Entry {
    int hole;
    Eigen::Vector2d at;
    int next;  ///< of the same vertex; -1: last
  };
  struct Hole {
    int number = 0;
    double radius = 0;
    double longest = 0;
  };
  class TriangleCutter;
  class Snapper;
  [[nodiscard]] const Entry* entry(int vertex, int hole) const;
  void add_entry(int vertex, int hole, const Eigen::Vector2d& at);
  [[nodiscard]] double length2(int a, int b) const;
  [[nodiscard]] int longest_edge(int t) const;
  [[nodiscard]] bool crossed_by(int t, int hole) const;
  [[nodiscard]] bool too_large(int t) const;
  int add_middle(int a, int b);
  int halve(int t, int edge, int middle);
  void bisect(int t, std::vector<int>& changed);
  void refine_borders(int segments, std::vector<int> stack);
  /// The hole that each vertex lies in; the last of several.
  [[nodiscard]] std::vector<int> hole_of_vertices() const;
  void keep_whole(std::vector<int>& inside) const;
  [[nodiscard]] std::vector<char> holes_in_trouble(const std::vector<int>& inside) const;
  [[nodiscard]] double place_of_border(int in, int out, int hole) const;

  void snap_to_borders(std::vector<int>& inside, std::vector<int>& on_border);

  std::vector<Eigen::Vector3d> x_, normal_;
  std::vector<int> first_;  ///< entry of each vertex; -1: none
  std::vector<Entry> entry_;
  std::vector<Hole> hole_;
  std::vector<int> touched_;  ///< faces in charts
  std::vector<std::array<int, 3>> corner_, across_;
};

}  // namespace geoprior::details
