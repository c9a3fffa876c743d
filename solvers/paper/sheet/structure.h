#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "models/paper/sheet/pattern.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// A straight line of the sheet: a segment of the pattern that stays straight in space.
struct Ruling {
  Eigen::Vector2d a, b;  ///< ends in the pattern (m); of a cone, `a` is at the apex
  int piece = -1;        ///< of PaperStructure::pieces; -1: a fold between two flat pieces
  /// Singular points that the ends are; an end that is none lies on the border.
  std::optional<int> singular_a, singular_b;
  int age_frames = 0;     ///< frames since it was made
  int unbent_frames = 0;  ///< for how many frames the sheet has been flat across it
  int astray_frames = 0;  ///< for how many frames the sheet has bent along it
};

/// From border to border.
inline bool is_chord(const Ruling& r) { return !r.singular_a && !r.singular_b; }

/// A part of the sheet that is developable and smooth: thesis 3.2.1, Figure 3.7.
struct PaperPiece {
  enum class Kind { flat, cylinder, cone };
  Kind kind = Kind::flat;
  int id = 0;                           ///< stays with a bent piece while it is tracked
  std::vector<int> rulings;             ///< of PaperStructure::rulings, in order across the piece
  Eigen::Vector2d direction{1, 0};      ///< of a cylinder's rulings, unit
  std::optional<Eigen::Vector2d> apex;  ///< of a cone
  std::optional<int> singular_point;    ///< that the apex is, if it lies in the sheet
  Pattern region;                       ///< the part of the pattern, with what is cut out of it
  std::vector<int> neighbours;          ///< pieces that share a part of their outline
};

/// A point where the sheet is not smooth (a d-cone). Where the paper has yielded about it, it never
/// vanishes.
struct SingularPoint {
  int id = 0;
  Eigen::Vector2d position;  ///< in the pattern (m)
  double birth = 0;          ///< s
  double weakening = 0;      ///< w: bending stiffness about it falls by 1 / (1 + w)
  bool on_border = false;
  std::optional<int> tear = {};  ///< whose tip it is
};

/// A place about which the mesh is finer than elsewhere, because the sheet strained there whatever
/// its rulings were: within two edges of it, edges are that long.
struct FinePlace {
  Eigen::Vector2d centre;  ///< in the pattern (m)
  double edge = 0;         ///< m
};

/// The geometric layer of the hybrid method: what the sheet is made of at one time.
///
/// The rulings and singular points are the state; pieces and border points follow from them and
/// from the mesh whose edges they are (solvers/paper/sheet/pieces.h).
struct PaperStructure {
  std::vector<Ruling> rulings;
  std::vector<PaperPiece> pieces;
  std::vector<SingularPoint> singular_points;
  std::vector<FinePlace> fine_places;
  std::vector<std::vector<int>>
      border_points;      ///< singular points on each edge of the pattern, in order
  int next_piece_id = 0;  ///< that the next new piece gets

  [[nodiscard]] std::vector<int> pieces_at(int singular_point) const;
  [[nodiscard]] int piece_at(const Eigen::Vector2d& p) const;  ///< -1: outside the pattern
  /// Rulings that end at a singular point, counter-clockwise.
  [[nodiscard]] std::vector<int> rulings_at(int singular_point) const;
};

}  // namespace geoprior::paper
