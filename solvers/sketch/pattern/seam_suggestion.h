#pragma once

#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/options.h"
#include "models/sketch/pattern/make_pattern.h"
#include "models/sketch/pattern/suggested_seam.h"

namespace geoprior::sketch {

/// Where suggested cuts lie.
enum class SuggestionRule {
  measured,  ///< the candidate that takes out most for its length, by flattening anew
  chance,    ///< straight cuts from places on the border drawn by lot, as long in all as that one
};

struct SeamSuggestionOptions {
  double tolerance = 0.02;
  double share = 0.98;
  int count = 3;
  double length_weight = 0.05;  ///< what a length of the root of the area costs, in removed error
  double piece_weight = 0.12;   ///< what a piece more costs, in removed error
  int plans = 3;                ///< followed at once
  double min_part = 0.02;
  bool fair = true;
  bool symmetric = true;
  SuggestionRule rule = SuggestionRule::measured;
  int seed = 0;
};
void describe(OptionVisitor& v, SeamSuggestionOptions& options);

/// Seams and darts that would make the pattern of a surface fit it (the thesis, end of 2.1.2: "at
/// the current state, the interpretation of the non-developable part is fully let to the user").
///
/// Of the piece whose pattern is strained most, every candidate (`cut_candidates`) is cut and its
/// parts are laid flat (`try_cut`). The best few in
///
///   (E - E') / E - length_weight * length / sqrt(area) - piece_weight * added pieces
///     - 0.005 of a radian that it turns by - 0.02 of a cut beside the mirror plane of its piece
///     + 1 where no part lies on another any more,
///
/// E the integral of |log stretch| over the piece before, E' after the cut, both measured and 1e-4
/// of its area at least, are made, each in a plan of its own. When the surface is its own mirror
/// image and the piece's image is another piece, that one is cut alike, in the same suggestion. Of
/// all plans the `plans` with the least
///
///   log(mean |log stretch|) + length_weight * length / sqrt(area) + piece_weight * pieces
///     + 0.03 suggestions + 0.005 of a radian that cuts turn by + 0.02 of cuts that are not their
///     own mirror image + 5 of what `share` lacks + 1 where parts lie on each other
///
/// of the whole surface are followed further, of those that come to the same one, until one has the
/// share of the area within the tolerance and no parts on each other, or none is better than the
/// best before. Parts that lie on each other are cut first. Candidates whose parts overlap
/// themselves in the plane are left out when the piece did not, and those that leave a piece
/// smaller than `min_part`, all cuts and openings made, or more than `PatternOptions::most_pieces`.
/// The lines of suggestions are fair (`faired_lines`).
///
/// It cannot: move a seam that is there, take cuts back, or know what a tailor likes. Work is that
/// of flattening a piece some thirty times a suggestion and plan.
/// @param surface  of length m, oriented manifold
/// @param seams    that it is cut along already
/// @return         in rank order; each is meant to be made after those before it
/// @throws Error   as `cut_surface` and `flatten`
/// Source: ours; places from Ben-Chen, Gotsman and Bunin 2008.
std::vector<SuggestedSeam> suggest_seams(const TriMesh& surface, std::span<const SeamEdge> seams,
                                         const SeamSuggestionOptions& options,
                                         const PatternOptions& pattern = {});

}  // namespace geoprior::sketch
