#include "models/sketch/pattern/layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace geoprior::sketch {
namespace {

/// Share of the shelves that pieces of unlike heights leave free, by which a square is enlarged.
constexpr double kShelfSlack = 1.2;

double square_width(const Eigen::MatrixX2d& size, double gap) {
  double area = 0;
  for (Eigen::Index p = 0; p < size.rows(); ++p) area += (size(p, 0) + gap) * (size(p, 1) + gap);
  return std::max(std::sqrt(kShelfSlack * area), size.rows() > 0 ? size.col(0).maxCoeff() : 0.0);
}

void move_piece(PatternPiece& piece, const Eigen::RowVector2d& by) {
  piece.points.rowwise() += by;
  for (PieceHole& hole : piece.holes) hole.centre += by.transpose();
  for (std::vector<Eigen::Vector2d>& line : piece.placements) {
    for (Eigen::Vector2d& p : line) p += by.transpose();
  }
}

}  // namespace

void lay_on_shelves(Pattern& pattern, const ShelfOptions& options) {
  const Eigen::Index count = pattern.pieces.size();
  Eigen::MatrixX2d low(count, 2), size(count, 2);
  for (Eigen::Index p = 0; p < count; ++p) {
    low.row(p) = pattern.pieces[p].points.colwise().minCoeff();
    size.row(p) = pattern.pieces[p].points.colwise().maxCoeff() - low.row(p);
  }
  std::vector<Eigen::Index> order(pattern.pieces.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index p, Eigen::Index q) { return size(p, 1) > size(q, 1); });
  const double width = options.width.value_or(square_width(size, options.gap));
  double x = 0, y = 0, height = 0;
  for (const Eigen::Index p : order) {
    if (x > 0 && x + size(p, 0) > width) {
      y += height + options.gap;
      x = height = 0;
    }
    move_piece(pattern.pieces[p], Eigen::RowVector2d(x, y) - low.row(p));
    x += size(p, 0) + options.gap;
    height = std::max(height, size(p, 1));
  }
}

}  // namespace geoprior::sketch
