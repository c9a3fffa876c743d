#include "metrics/volume/liquid_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace geoprior {
namespace {

using Eigen::Vector2d;

/// Twice the signed area of (a, b, p) with its sign decided on ties as if p were moved by an
/// infinitesimal step along +x and a smaller one along +y. The edge is always taken from its lower
/// end to its higher one, so that both triangles of an edge decide alike.
struct Side {
  double value;
  bool left;
};

Side side(Vector2d a, Vector2d b, const Vector2d& p) {
  const bool turned = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
  if (turned) std::swap(a, b);
  const Vector2d e = b - a;
  const double value = e.x() * (p.y() - a.y()) - e.y() * (p.x() - a.x());
  // d/dx of the value is -e.y, d/dy is +e.x; a < b leaves e.x >= 0.
  const bool left = value != 0 ? value > 0 : (e.y() != 0 ? e.y() < 0 : e.x() > 0);
  return turned ? Side{-value, !left} : Side{value, left};
}

/// Height of the triangle at p, and whether it is seen from above (+1) or below (-1); 0: not met.
int crossing(const Eigen::Matrix3d& corners, const Vector2d& p, double* height) {
  const Vector2d a = corners.row(0).head<2>(), b = corners.row(1).head<2>(),
                 c = corners.row(2).head<2>();
  const Side bc = side(b, c, p), ca = side(c, a, p), ab = side(a, b, p);
  if (bc.left != ca.left || ca.left != ab.left) return 0;
  const double sum = bc.value + ca.value + ab.value;
  // All three on one side of a triangle that is upright: met by the tie rule only, without area.
  if (sum == 0) return 0;
  *height = (bc.value * corners(0, 2) + ca.value * corners(1, 2) + ab.value * corners(2, 2)) / sum;
  return bc.left ? 1 : -1;
}

}  // namespace

ColumnGrid covering_grid(const Eigen::MatrixX3d& points, double spacing) {
  ColumnGrid grid;
  grid.spacing = spacing;
  if (points.rows() == 0) return grid;
  const Vector2d low = points.leftCols<2>().colwise().minCoeff();
  const Vector2d high = points.leftCols<2>().colwise().maxCoeff();
  grid.nx = std::max(1, static_cast<int>(std::ceil((high.x() - low.x()) / spacing)));
  grid.ny = std::max(1, static_cast<int>(std::ceil((high.y() - low.y()) / spacing)));
  const Vector2d size(grid.nx * spacing, grid.ny * spacing);
  grid.origin = (low + high - size) / 2;
  return grid;
}

void append_crossings(const Eigen::Matrix3d& corners, const ColumnGrid& grid, int first_row,
                      int last_row, std::vector<ColumnCrossing>* crossings) {
  const auto range = [&](int axis, int first, int last) {
    const double low = (corners.col(axis).minCoeff() - grid.origin[axis]) / grid.spacing - 0.5;
    const double high = (corners.col(axis).maxCoeff() - grid.origin[axis]) / grid.spacing - 0.5;
    return std::pair{std::max(first, static_cast<int>(std::floor(std::max(low, -1.0)))),
                     std::min(last, static_cast<int>(std::ceil(std::min(high, last + 1.0))))};
  };
  const auto [i0, i1] = range(0, 0, grid.nx - 1);
  const auto [j0, j1] = range(1, first_row, last_row);
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      double height = 0;
      const int sign = crossing(corners, grid.probe(i, j), &height);
      if (sign != 0) crossings->push_back({i, j, height, sign});
    }
  }
}

Columns columns(const TriMesh& mesh, const ColumnGrid& grid) {
  if (!mesh.V.allFinite()) throw Error("coordinate is not finite", "columns", "finite numbers");
  Columns result;
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  result.top = Eigen::VectorXd::Constant(grid.count(), kNone);
  result.depth = Eigen::VectorXd::Zero(grid.count());
  std::vector<ColumnCrossing> crossings;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    crossings.clear();
    append_crossings(mesh.V({mesh.F(t, 0), mesh.F(t, 1), mesh.F(t, 2)}, Eigen::all), grid, 0,
                     grid.ny - 1, &crossings);
    for (const ColumnCrossing& c : crossings) {
      const Eigen::Index at = grid.index(c.i, c.j);
      result.top[at] = std::max(result.top[at], c.height);
      result.depth[at] += c.sign * c.height;
    }
  }
  for (double& top : result.top) {
    if (top == kNone) top = std::numeric_limits<double>::quiet_NaN();
  }
  return result;
}

ColumnComparison compare_columns(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) {
    throw Error(std::to_string(b.size()) + " columns", "compare_columns",
                std::to_string(a.size()) + ", as many as the first");
  }
  ColumnComparison result;
  double mean_a = 0, mean_b = 0, squares = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    ++result.probes;
    mean_a += a[i];
    mean_b += b[i];
    squares += (a[i] - b[i]) * (a[i] - b[i]);
    result.max = std::max(result.max, std::abs(a[i] - b[i]));
  }
  if (result.probes == 0) return result;
  mean_a /= result.probes;
  mean_b /= result.probes;
  result.rms = std::sqrt(squares / result.probes);
  double aa = 0, bb = 0, ab = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
  }
  if (aa > 0 && bb > 0) {
    result.correlation = ab / std::sqrt(aa * bb);
  } else {
    result.correlation = squares == 0 ? 1 : 0;
  }
  return result;
}

double largest_second_difference(const Eigen::VectorXd& before, const Eigen::VectorXd& now,
                                 const Eigen::VectorXd& after) {
  double largest = 0;
  for (Eigen::Index i = 0; i < now.size(); ++i) {
    const double jump = std::abs(after[i] - 2 * now[i] + before[i]);
    if (std::isfinite(jump)) largest = std::max(largest, jump);
  }
  return largest;
}

}  // namespace geoprior
