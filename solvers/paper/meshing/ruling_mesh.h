#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/paper/sheet/pattern.h"
#include "models/paper/shell/state.h"
#include "solvers/paper/sheet/structure.h"

namespace geoprior::paper {

/// The mesh that a structure asks for, and where the structure is in it.
struct RulingMesh {
  ShellMesh mesh;
  std::vector<std::vector<int>> ruling_paths;  ///< vertices of each ruling from `a` to `b`
  std::vector<int> singular_vertices;          ///< of each singular point
  std::vector<int> cell;  ///< of each triangle: rulings and border separate the cells
  int cell_count = 0;
  std::vector<int> piece;  ///< of each triangle, after `derive_pieces`
};

/// How fine the mesh of a structure is (m).
struct MeshSizes {
  double flat = 0.1;      ///< border and lattice where the ground is flat
  int ruling_parts = 1;   ///< most edges that a ruling is divided into
  double least_part = 0;  ///< shortest of them
};

/// Constrained Delaunay triangulation with the rulings as edges, from scratch.
///
/// Vertices are the corners of the pattern and its holes, the anchors, the ends of rulings and the
/// singular points; rulings are divided evenly; about fine places border and a lattice of their
/// edge; where the ground is flat, also the border at most `flat` apart and a hexagonal lattice of
/// that size, at least half of it away from everything else. A pure function of its input: the same
/// structure has the same mesh.
RulingMesh mesh_structure(const PaperStructure& structure, const Pattern& pattern,
                          const std::vector<Eigen::Vector2d>& anchors, const MeshSizes& sizes);

/// Vertices of the mesh on the segment a b, in order, if each two in a row share an edge and they
/// reach from one end to the other; empty otherwise. Points within `tolerance` (m) count as on it.
std::vector<int> edge_path(const ShellMesh& mesh, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b, double tolerance);

}  // namespace geoprior::paper
