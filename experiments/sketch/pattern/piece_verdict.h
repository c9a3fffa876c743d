#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// Strain that cloth and paper take without a word.
inline constexpr double kTakenStrain = 0.02;
/// Share of a piece's area within it, below which a seam is suggested.
inline constexpr double kSewnShare = 0.95;
/// Difference of a piece's flat area from that of its surface, over the latter, that is refused.
inline constexpr double kRefusedArea = 0.02;

/// A cut that would ease a piece, as it lies on the flat piece.
struct AddedSeam {
  std::vector<std::vector<Eigen::Vector2d>> lines;  ///< m; empty: none is known
  bool is_dart = false;                             ///< it parts no piece in two
  double share = 0;  ///< of the piece's area within the tolerance after it, measured
};

/// Whether a piece can be cut out and sewn to what it is to become.
///
/// Strain of a triangle is max(s1, 1 / s2) - 1, s1 >= s2 the singular values of the map from the
/// surface to the plane: metrics/isometry/flattening.h.
struct PieceVerdict {
  double area = 0;                       ///< of the piece on the surface (m^2)
  double strain_p95 = 0;                 ///< that 95 % of its area stay under
  double share = 1;                      ///< of its area with a strain within kTakenStrain
  double area_error = 0;                 ///< flat area over that of the surface, minus 1
  int flips = 0;                         ///< triangles turned over
  double worst = 0;                      ///< largest strain of a triangle, and where it is
  Eigen::Vector2d worst_flat{0, 0};      ///< middle of that triangle in the pattern (m)
  Eigen::Vector3d worst_place{0, 0, 0};  ///< and on the surface (m)
  std::string nearest;  ///< the seam or border that is nearest to it in the pattern
  std::string refused;  ///< why the piece is not to be cut; empty: it may be
  AddedSeam seam;

  [[nodiscard]] bool is_strained() const { return share < kSewnShare; }
};

/// Verdicts on all pieces of a pattern.
///
/// Refused are a piece with turned-over triangles and one whose flat area differs from that of its
/// surface by more than kRefusedArea.
/// @param surface  n x 3, the points that `surface_vertex` counts (m)
/// @throws Error   on a piece that counts other points, naming it
std::vector<PieceVerdict> judge_pieces(const Pattern& pattern, const Eigen::MatrixX3d& surface);

/// Strain of every triangle of a piece with its sign: above 0 where the surface is longer than the
/// pattern, 1 / s2 - 1, below 0 where it is shorter, 1 - s1, whichever is farther from 0.
Eigen::VectorXd signed_strain(const PatternPiece& piece, const Eigen::MatrixX3d& surface);

/// The cut that is suggested for a piece that is strained
/// (solvers/sketch/pattern/seam_suggestion.h), by itself: its seams with others stay as they are.
/// Nothing where none eases it.
AddedSeam added_seam(const PatternPiece& piece, const Eigen::MatrixX3d& surface);

/// "strain p95 3.2 %, 91 % of the area within 2 %".
std::string short_verdict(const PieceVerdict& verdict);

/// "piece 1 of 2 'wall'": counted as people do, where errors count from zero (`piece_label`).
std::string counted_piece(const Pattern& pattern, int piece);

/// The verdict as one line, with the worst place, why it is refused and what would help.
std::string verdict_line(const Pattern& pattern, int piece, const PieceVerdict& verdict);

}  // namespace geoprior::sketch
