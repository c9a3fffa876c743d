#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"
#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// An edge of the surface along which it is cut, and the seam it is part of.
struct SeamEdge {
  Edge edge{};   ///< vertices of the surface, in any order
  int seam = 0;  ///< not negative
};

/// A connected part of a surface that was cut, with vertices of its own.
///
/// Borders are closed loops of vertices with the piece on their left, the longest first; each
/// starts at its lowest vertex. `edges` are the borders cut into stretches of one seam each, which
/// end where a seam ends, branches, crosses another one or meets the border of the surface. A
/// stretch that closes on itself names its first vertex twice and starts at the vertex that is
/// lowest in the surface. The stretches on the two sides of a seam have as many vertices, the
/// i-th of one at the same place of the surface as the i-th from the end of the other.
struct CutPiece {
  TriMesh mesh;
  std::vector<int> surface_vertex;    ///< of each vertex
  std::vector<int> surface_triangle;  ///< of each triangle, ascending
  std::vector<std::vector<int>> borders;
  std::vector<PieceEdge> edges;
  int euler_characteristic = 1;  ///< vertices - edges + triangles

  [[nodiscard]] int border_count() const { return static_cast<int>(borders.size()); }
  /// Number of handles.
  [[nodiscard]] int genus() const { return (2 - border_count() - euler_characteristic) / 2; }
  /// Only a disc can be laid flat without regard to how it closes: a piece without borders, with a
  /// handle or with a second border may need a further cut (`shortest_cut`).
  [[nodiscard]] bool is_disc() const { return euler_characteristic == 1 && border_count() == 1; }
};

/// Cuts a surface along seams.
///
/// A seam may end inside a piece (a dart), close on itself, branch and cross others: what counts is
/// the set of edges. Vertices are doubled by fans: the corners at a vertex that triangles join
/// without crossing a seam are one vertex of the piece, so that two parts that touch in a vertex
/// come apart. Pieces are in the order of their first triangles. Of an edge that is given twice the
/// first seam counts; an edge at the border of the surface is open already and is left out.
///
/// @param surface  consistently oriented and manifold along its edges, with or without border
/// @throws Error   on three triangles or two of equal direction at an edge, on a seam edge that the
///                 surface does not have, and on a negative seam (names it)
std::vector<CutPiece> cut_surface(const TriMesh& surface, std::span<const SeamEdge> seams);

/// Total turning of every border of a piece (rad): the sum of pi minus the angles of the triangles
/// at its vertices. 2 pi around a flat disc, -2 pi around a hole in something flat, 0 at the end of
/// a straight tube.
std::vector<double> border_turnings(const CutPiece& piece);

}  // namespace geoprior::sketch
