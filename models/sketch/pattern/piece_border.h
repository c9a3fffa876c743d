#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "models/sketch/pattern/pattern.h"

namespace geoprior::sketch {

/// How the piece is named in errors: "piece 2 'sleeve'".
std::string piece_label(const Pattern& pattern, int piece);

/// Throws Error, naming piece and edge, unless the pattern can be drawn: points finite and within a
/// kilometre, indices in range, every edge along its piece's border, seams mutual, a grain.
void require_drawable(const Pattern& pattern);

/// The borders with the material on the left: the outer one counter-clockwise, holes clockwise.
///
/// @param piece  of a pattern that is drawable
std::vector<std::vector<int>> oriented_borders(const PatternPiece& piece);

/// The edge to which each segment of the border belongs, by its points (lower one first).
std::map<std::pair<int, int>, int> edge_of_segment(const PatternPiece& piece);

/// Directed segments of the borders, the material on their left.
std::set<std::pair<int, int>> directed_segments(const PatternPiece& piece);

/// Length of the edge in the pattern (m).
double edge_length(const PatternPiece& piece, const PieceEdge& edge);

}  // namespace geoprior::sketch
