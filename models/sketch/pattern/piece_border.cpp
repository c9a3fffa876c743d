#include "models/sketch/pattern/piece_border.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "models/sketch/surface/positive_winding.h"

namespace geoprior::sketch {
namespace {

constexpr double kFarthestPoint = 1000;  // m

std::string piece_edge_label(const Pattern& pattern, int piece, std::size_t edge) {
  return piece_label(pattern, piece) + ", edge " + std::to_string(edge);
}

PlaneLoop border_points(const PatternPiece& piece, const std::vector<int>& chain) {
  PlaneLoop points;
  for (const int v : chain) points.emplace_back(piece.points.row(v).transpose());
  return points;
}

void require_chain(const PatternPiece& piece, const std::vector<int>& chain, std::size_t least,
                   const std::string& where) {
  if (chain.size() < least) {
    throw Error("has " + std::to_string(chain.size()) + " points", where,
                std::to_string(least) + " or more");
  }
  for (const int v : chain) {
    if (v < 0 || v >= piece.points.rows()) {
      throw Error("point " + std::to_string(v) + " of " + std::to_string(piece.points.rows()),
                  where, "points of the piece");
    }
  }
}

void require_piece_shape(const Pattern& pattern, int k) {
  const PatternPiece& piece = pattern.pieces[k];
  const std::string where = piece_label(pattern, k);
  for (Eigen::Index i = 0; i < piece.points.rows(); ++i) {
    // Not by the larger coordinate: Eigen's maximum may pass over a NaN.
    if (!(std::abs(piece.points(i, 0)) <= kFarthestPoint &&
          std::abs(piece.points(i, 1)) <= kFarthestPoint)) {
      throw Error("point " + std::to_string(i) + " is not finite or too far away", where,
                  "within 1000 m");
    }
  }
  if (piece.borders.empty()) throw Error("has no border", where, "an outer border");
  for (std::size_t b = 0; b < piece.borders.size(); ++b) {
    require_chain(piece, piece.borders[b], 3, where + ", border " + std::to_string(b));
  }
  for (std::size_t f = 0; f < piece.folds.size(); ++f) {
    require_chain(piece, piece.folds[f], 2, where + ", fold " + std::to_string(f));
  }
  if (!(std::abs(piece.grain.norm() - 1) < 1e-6)) {
    throw Error("grain is no direction", where, "a unit vector");
  }
}

void require_piece_edges(const Pattern& pattern, int k) {
  const PatternPiece& piece = pattern.pieces[k];
  const auto segments = directed_segments(piece);
  for (std::size_t e = 0; e < piece.edges.size(); ++e) {
    const PieceEdge& edge = piece.edges[e];
    const std::string where = piece_edge_label(pattern, k, e);
    require_chain(piece, edge.vertices, 2, where);
    for (std::size_t i = 0; i + 1 < edge.vertices.size(); ++i) {
      const int a = edge.vertices[i], b = edge.vertices[i + 1];
      if (!segments.contains({a, b}) && !segments.contains({b, a})) {
        throw Error("points " + std::to_string(a) + " and " + std::to_string(b) +
                        " are not joined by the border",
                    where, "a stretch of a border");
      }
    }
    if (edge.partner_piece < 0) continue;
    const std::size_t q = edge.partner_piece;
    const std::size_t f = edge.partner_edge;
    if (q >= pattern.pieces.size() || edge.partner_edge < 0 ||
        f >= pattern.pieces[q].edges.size()) {
      throw Error("is sewn to an edge that does not exist", where, "edges of the pattern");
    }
    const PieceEdge& partner = pattern.pieces[q].edges[f];
    if (partner.partner_piece != k || partner.partner_edge != static_cast<int>(e)) {
      throw Error("is not its partner's partner", where, "each of two sewn edges names the other");
    }
  }
}

}  // namespace

std::string piece_label(const Pattern& pattern, int piece) {
  return "piece " + std::to_string(piece) + " '" + pattern.pieces[piece].name + "'";
}

void require_drawable(const Pattern& pattern) {
  const int n = static_cast<int>(pattern.pieces.size());
  for (int k = 0; k < n; ++k) require_piece_shape(pattern, k);
  for (int k = 0; k < n; ++k) require_piece_edges(pattern, k);
}

std::vector<std::vector<int>> oriented_borders(const PatternPiece& piece) {
  std::vector<std::vector<int>> borders = piece.borders;
  for (std::size_t b = 0; b < borders.size(); ++b) {
    const bool counter_clockwise = loop_area(border_points(piece, borders[b])) > 0;
    if (counter_clockwise != (b == 0)) std::reverse(borders[b].begin(), borders[b].end());
  }
  return borders;
}

std::map<std::pair<int, int>, int> edge_of_segment(const PatternPiece& piece) {
  std::map<std::pair<int, int>, int> edge_of;
  for (int e = 0; e < std::ssize(piece.edges); ++e) {
    const std::vector<int>& chain = piece.edges[e].vertices;
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      edge_of[std::minmax(chain[i], chain[i + 1])] = e;
    }
  }
  return edge_of;
}

std::set<std::pair<int, int>> directed_segments(const PatternPiece& piece) {
  std::set<std::pair<int, int>> segments;
  for (const std::vector<int>& border : oriented_borders(piece)) {
    for (std::size_t i = 0; i < border.size(); ++i) {
      segments.emplace(border[i], border[(i + 1) % border.size()]);
    }
  }
  return segments;
}

double edge_length(const PatternPiece& piece, const PieceEdge& edge) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < edge.vertices.size(); ++i) {
    length += (piece.points.row(edge.vertices[i + 1]) - piece.points.row(edge.vertices[i])).norm();
  }
  return length;
}

}  // namespace geoprior::sketch
