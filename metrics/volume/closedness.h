#pragma once

#include "core/mesh.h"

namespace geoprior {

/// How far a mesh is from a closed 2-manifold, counted in elements.
struct Closedness {
  int border_edges = 0;          ///< of one triangle only
  int crowded_edges = 0;         ///< of three or more triangles
  int turned_edges = 0;          ///< of two triangles that pass it in the same direction
  int pinched_vertices = 0;      ///< whose triangles make more than one fan
  int components = 0;            ///< joined by common vertices
  int euler_characteristic = 0;  ///< V - E + F of the vertices in use

  [[nodiscard]] int defects() const {
    return border_edges + crowded_edges + turned_edges + pinched_vertices;
  }
};

/// Every mesh is allowed, the empty one too (it has no defect). Isolated vertices do not count.
Closedness closedness(const TriMesh& mesh);

/// Triangles of the component with the most of them (the first of several); vertices keep their
/// numbers.
Eigen::MatrixX3i largest_component(const TriMesh& mesh);

}  // namespace geoprior
