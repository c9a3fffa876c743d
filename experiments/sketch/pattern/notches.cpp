#include "experiments/sketch/pattern/notches.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/error.h"
#include "models/sketch/pattern/piece_border.h"

namespace geoprior::sketch {
namespace {

constexpr double kDirectionShare = 0.4;  // of the first part
constexpr double kMostParts = 1000;

struct NotchShare {
  double share;  ///< of the edge's length
  bool direction;
};

std::vector<NotchShare> notch_shares(double length, double spacing) {
  const double parts = std::clamp(std::round(length / spacing), 1.0, kMostParts);
  std::vector<NotchShare> shares{{kDirectionShare / parts, true}};
  for (int i = 1; i < static_cast<int>(parts); ++i) shares.push_back({i / parts, false});
  return shares;
}

/// The edge's point at an arc length, and there the normal away from the material.
void place_notch(const PatternPiece& piece, const std::set<std::pair<int, int>>& directed,
                 Notch& notch) {
  const std::vector<int>& chain = piece.edges[notch.edge].vertices;
  double left = notch.arc;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const Eigen::Vector2d a = piece.points.row(chain[i]).transpose();
    const Eigen::Vector2d along = piece.points.row(chain[i + 1]).transpose() - a;
    const double length = along.norm();
    if (left <= length || i + 2 == chain.size()) {
      const Eigen::Vector2d d = along / length;
      const double side = directed.contains({chain[i], chain[i + 1]}) ? 1 : -1;
      notch.point = a + std::min(left, length) * d;
      notch.outward = side * Eigen::Vector2d(d.y(), -d.x());
      return;
    }
    left -= length;
  }
}

}  // namespace

std::vector<Notch> paired_notches(const Pattern& pattern, const NotchOptions& options) {
  if (!(options.spacing > 0)) throw Error("notch spacing is not positive", {}, "more than 0");
  require_drawable(pattern);
  std::vector<std::set<std::pair<int, int>>> directed;
  for (const PatternPiece& piece : pattern.pieces) directed.push_back(directed_segments(piece));
  std::vector<Notch> notches;
  const auto add = [&](int label, bool direction, int piece, int edge, double share) {
    const PatternPiece& p = pattern.pieces[piece];
    const double length = edge_length(p, p.edges[edge]);
    Notch notch{label, direction, piece, edge, share * length};
    place_notch(p, directed[piece], notch);
    notches.push_back(notch);
  };
  int label = 0;
  for (int k = 0; k < std::ssize(pattern.pieces); ++k) {
    const PatternPiece& piece = pattern.pieces[k];
    for (int e = 0; e < std::ssize(piece.edges); ++e) {
      const PieceEdge& edge = piece.edges[e];
      const std::pair here(k, e), there(edge.partner_piece, edge.partner_edge);
      const double length = edge_length(piece, edge);
      // Each seam once, from its first side.
      if (there.first < 0 || there < here || length < options.shortest_edge) continue;
      for (const NotchShare& n : notch_shares(length, options.spacing)) {
        if (here == there && n.share >= 0.5) continue;
        add(++label, n.direction, k, e, n.share);
        add(label, n.direction, there.first, there.second, 1 - n.share);
      }
    }
  }
  return notches;
}

}  // namespace geoprior::sketch
