#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace geoprior::fluid {

/// Level set 0 of a function at the nodes of a lattice, one cell at a time: marching tetrahedra
/// (six around each cell's diagonal). Closed, manifold and oriented towards positive values
/// wherever the cells given enclose it; as irregular as contoured liquid surfaces are, with
/// slivers.
class LatticeContour {
 public:
  /// @param origin  of node (0, 0, 0) @param spacing  of nodes (m)
  LatticeContour(const Eigen::Vector3d& origin, double spacing);
  /// @param values  at the cell's nodes, number dx + 2 dy + 4 dz; indices from 0 to 2^20
  void add_cell(int i, int j, int k, const double (&values)[8]);
  [[nodiscard]] TriMesh mesh() const;

 private:
  [[nodiscard]] int vertex(const Eigen::Vector3i& cell, int a, int b, const double (&values)[8]);
  void add_tetrahedron(const Eigen::Vector3i& cell, const int (&corner)[4], bool even,
                       const double (&values)[8]);
  void grow();

  Eigen::Vector3d origin_;
  double spacing_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
  // Vertices by lattice edge: open addressing, looked up only.
  struct Slot {
    std::uint64_t key = ~std::uint64_t{0};
    int vertex = -1;
  };
  std::vector<Slot> slots_;
};

}  // namespace geoprior::fluid
