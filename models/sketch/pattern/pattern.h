#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace geoprior::sketch {

/// A stretch of the border of a piece that is sewn to another stretch, or left free.
struct PieceEdge {
  std::vector<int> vertices;  ///< of the piece, along its border counter-clockwise
  int seam = -1;              ///< of the drawing or proposed; -1: a free border
  int partner_piece = -1;     ///< it is sewn to; -1 for a free border
  int partner_edge = -1;      ///< of that piece, run through the opposite way
};

/// A round hole in a piece, for a rivet.
struct PieceHole {
  Eigen::Vector2d centre{0, 0};  ///< m
  double radius = 0;             ///< m
};

/// One flat piece of material. Metres, true scale, counter-clockwise.
struct PatternPiece {
  std::string name;
  Eigen::MatrixX2d points;
  Eigen::MatrixX3i triangles;
  std::vector<int> surface_vertex;        ///< of each point, in the welded surface
  std::vector<int> surface_triangle;      ///< of each triangle
  std::vector<std::vector<int>> borders;  ///< closed loops of points; the outer one first
  std::vector<PieceEdge> edges;           ///< the outer and inner borders, cut at seams' ends
  Eigen::Vector2d grain{0, 1};            ///< direction of the material's grain, unit
  std::vector<std::vector<int>> folds;    ///< chains of points along which it is folded
  std::vector<PieceHole> holes = {};      ///< not cut out of the triangles
  /// Lines along which the edge of another piece lies when both are put together (m).
  std::vector<std::vector<Eigen::Vector2d>> placements = {};
};

/// What is cut out and sewn together.
struct Pattern {
  std::vector<PatternPiece> pieces;
};

}  // namespace geoprior::sketch
