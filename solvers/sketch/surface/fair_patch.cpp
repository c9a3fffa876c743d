#include "solvers/sketch/surface/fair_patch.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/numerics/sparse_ldlt.h"

namespace geoprior::sketch {
namespace {

/// Inner points keep this many spacings away from the border, so that no sliver arises there.
constexpr double kBorderGap = 0.6;

/// Border seen along its mean normal (Newell's: sum of the cross products of its points).
Eigen::MatrixX2d border_layout(const Eigen::MatrixX3d& border, const std::string& where) {
  const Eigen::RowVector3d centre = border.colwise().mean();
  Eigen::Vector3d normal(0, 0, 0);
  for (Eigen::Index i = 0; i < border.rows(); ++i) {
    const Eigen::Vector3d a = (border.row(i) - centre).transpose();
    const Eigen::Vector3d b = (border.row((i + 1) % border.rows()) - centre).transpose();
    normal += a.cross(b);
  }
  if (!(normal.norm() > 0)) throw Error("border of a panel has no area", where);
  normal.normalize();
  const Eigen::Vector3d right = normal.unitOrthogonal();
  const Eigen::Vector3d up = normal.cross(right);
  Eigen::MatrixX2d flat(border.rows(), 2);
  flat.col(0) = (border.rowwise() - centre) * right;
  flat.col(1) = (border.rowwise() - centre) * up;
  return flat;
}

/// Whether a point is inside the border and not near it.
bool well_inside(const Eigen::MatrixX2d& border, const Eigen::Vector2d& p, double gap) {
  bool inside = false;
  const Eigen::Index n = border.rows();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d a = border.row(i).transpose(), b = border.row((i + 1) % n).transpose();
    const Eigen::Vector2d d = b - a;
    const double t = std::clamp(d.dot(p - a) / d.squaredNorm(), 0.0, 1.0);
    if ((a + t * d - p).norm() < gap) return false;
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * d.x())
      inside = !inside;
  }
  return inside;
}

/// The border's points, then those of a hexagonal grid inside.
Eigen::MatrixX2d points_inside(const Eigen::MatrixX2d& border, double spacing) {
  const Eigen::RowVector2d low = border.colwise().minCoeff(), high = border.colwise().maxCoeff();
  std::vector<Eigen::Vector2d> inner;
  const double rise = spacing * std::sqrt(3.0) / 2;
  const int rows = static_cast<int>((high.y() - low.y()) / rise);
  const int columns = static_cast<int>((high.x() - low.x()) / spacing);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const Eigen::Vector2d p(low.x() + (i + (j % 2 == 0 ? 0.0 : 0.5)) * spacing,
                              low.y() + j * rise);
      if (well_inside(border, p, kBorderGap * spacing)) inner.push_back(p);
    }
  }
  Eigen::MatrixX2d points(border.rows() + inner.size(), 2);
  points.topRows(border.rows()) = border;
  for (std::size_t k = 0; k < inner.size(); ++k)
    points.row(border.rows() + k) = inner[k].transpose();
  return points;
}

/// Half cotangents of the corners of a triangle, not negative: the system stays definite.
std::array<double, 3> half_cotangents(const Eigen::MatrixX3d& V, const Eigen::Vector3i& t) {
  std::array<double, 3> cot{};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d a = (V.row(t((k + 1) % 3)) - V.row(t(k))).transpose();
    const Eigen::Vector3d b = (V.row(t((k + 2) % 3)) - V.row(t(k))).transpose();
    const double area = a.cross(b).norm();
    cot[k] = area > 0 ? std::max(a.dot(b) / area, 1e-6) / 2 : 1e-6;
  }
  return cot;
}

/// Moves the inner vertices to L x = 0 with the Laplacian of a shape.
void solve_inner(const Eigen::MatrixX3d& shape, const Eigen::MatrixX3i& F, Eigen::Index fixed,
                 Eigen::MatrixX3d& V) {
  const Eigen::Index n = V.rows() - fixed;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(n, 3);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::Vector3i corner = F.row(t).transpose();
    const std::array<double, 3> weight = half_cotangents(shape, corner);
    for (int k = 0; k < 3; ++k) {
      for (const auto& [v, w] : {std::pair{corner((k + 1) % 3), corner((k + 2) % 3)},
                                 std::pair{corner((k + 2) % 3), corner((k + 1) % 3)}}) {
        if (v < fixed) continue;
        const auto row = static_cast<int>(v - fixed);
        entries.emplace_back(row, row, weight[k]);
        if (w < fixed) {
          right.row(row) += weight[k] * V.row(w);
        } else {
          entries.emplace_back(row, static_cast<int>(w - fixed), -weight[k]);
        }
      }
    }
  }
  Eigen::SparseMatrix<double> L(n, n);
  L.setFromTriplets(entries.begin(), entries.end());
  V.bottomRows(n) = SparseLdlt(L).solve_columns(right);
}

/// Triangles between points whose first `count` are the border.
Eigen::MatrixX3i triangles_inside(const Eigen::MatrixX2d& points, int count,
                                  const std::string& where) {
  std::vector<Eigen::Vector2i> segments;
  for (int i = 0; i < count; ++i) segments.emplace_back(i, (i + 1) % count);
  try {
    return constrained_delaunay(points, segments);
  } catch (const Error& crossing) {
    throw Error("border of a panel crosses itself: " + std::string(crossing.what()), where,
                "a border that is simple seen along its mean normal");
  }
}

void require_border(const Eigen::MatrixX3d& border, const std::string& where) {
  if (border.rows() < 3) throw Error("border of a panel has less than three points", where);
}

}  // namespace

TriMesh fair_patch(const Eigen::MatrixX3d& border, double spacing, int solves,
                   const std::string& where) {
  require_border(border, where);
  if (!(spacing > 0)) throw Error("spacing is not positive", where, "above 0 m");
  const Eigen::MatrixX2d flat = points_inside(border_layout(border, where), spacing);
  const auto n = static_cast<int>(border.rows());
  TriMesh mesh;
  mesh.F = triangles_inside(flat, n, where);
  mesh.V = Eigen::MatrixX3d::Zero(flat.rows(), 3);
  mesh.V.topRows(n) = border;
  if (flat.rows() == border.rows()) return mesh;
  Eigen::MatrixX3d shape = Eigen::MatrixX3d::Zero(flat.rows(), 3);
  shape.leftCols<2>() = flat;
  solve_inner(shape, mesh.F, n, mesh.V);
  for (int k = 0; k < solves; ++k) {
    shape = mesh.V;
    solve_inner(shape, mesh.F, n, mesh.V);
  }
  return mesh;
}

TriMesh flat_patch(const Eigen::MatrixX3d& border, const std::string& where) {
  require_border(border, where);
  const auto n = static_cast<int>(border.rows());
  return {border, triangles_inside(border_layout(border, where), n, where)};
}

}  // namespace geoprior::sketch
