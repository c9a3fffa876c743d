#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/inputs/surface_sequence.h"

namespace geoprior::fluid {

/// A surface while features are pasted into it: positions and triangles side by side in memory.
struct WorkMesh {
  std::vector<Eigen::Vector3d> x, velocity;  ///< m, m/s; velocity may be empty
  std::vector<std::array<int, 3>> triangles;

  [[nodiscard]] int vertex_count() const { return static_cast<int>(x.size()); }
};
WorkMesh work_mesh(const SurfaceFrame& frame);
SurfaceFrame surface_frame(const WorkMesh& mesh, double time);

/// Splits edges at their middles, all marked ones at once: a triangle with one, two or three of
/// them becomes two, three or four. So neighbours always fit, no edge gets a third triangle, and a
/// closed surface stays closed; surface and volume stay as they are.
///
/// New vertices are numbered in the order in which their edges were marked.
class EdgeSplitter {
 public:
  explicit EdgeSplitter(int vertex_count) : vertex_count_(vertex_count) {}

  void mark(int a, int b);
  [[nodiscard]] bool empty() const { return parents_.empty(); }
  /// Ends of the edges, in order: those of new vertex `vertex_count + i`.
  [[nodiscard]] const std::vector<std::array<int, 2>>& parents() const { return parents_; }
  /// Adds the vertices and splits the triangles. A quadrilateral that is left is cut along its
  /// shorter diagonal (equal ones: the one from the lower vertex).
  /// @return the triangles that are new or smaller
  std::vector<int> apply(WorkMesh& mesh) const;

 private:
  [[nodiscard]] int middle(int a, int b) const;
  [[nodiscard]] std::size_t slot(std::uint64_t key) const;
  void grow();

  int vertex_count_;
  std::vector<std::array<int, 2>> parents_;
  std::vector<std::uint64_t> keys_;  // open addressing, size a power of two
  std::vector<int> values_;
};

}  // namespace geoprior::fluid
