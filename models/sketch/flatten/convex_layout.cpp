#include "models/sketch/flatten/convex_layout.h"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "core/geometry/topology.h"

namespace geoprior::sketch {
namespace {

/// A weight is not below this share of the largest one at its vertex, so that no vertex is held on
/// one side alone to round-off.
constexpr double kLeastMeanShare = 1e-3;

Eigen::VectorXcd border_on_circle(const TriMesh& mesh, std::span<const int> border, double area) {
  Eigen::VectorXcd z = Eigen::VectorXcd::Zero(mesh.vertex_count());
  std::vector<double> length{0};
  for (std::size_t i = 0; i < border.size(); ++i) {
    const int next = border[(i + 1) % border.size()];
    length.push_back(length.back() + (mesh.V.row(next) - mesh.V.row(border[i])).norm());
  }
  const double radius = std::sqrt(area / std::numbers::pi);
  for (std::size_t i = 0; i < border.size(); ++i)
    z(border[i]) = std::polar(radius, 2 * std::numbers::pi * length[i] / length.back());
  return z;
}

/// The mean of neighbours that every vertex is to be.
class MeanRows {
 public:
  explicit MeanRows(int vertex_count) : rows_(vertex_count) {}

  void add(int vertex, int neighbour, double weight) {
    for (auto& [other, sum] : rows_[vertex]) {
      if (other != neighbour) continue;
      sum += weight;
      return;
    }
    rows_[vertex].emplace_back(neighbour, weight);
  }
  int add_vertex() {
    rows_.emplace_back();
    return static_cast<int>(rows_.size()) - 1;
  }
  [[nodiscard]] int size() const { return static_cast<int>(rows_.size()); }
  [[nodiscard]] double heaviest(int vertex) const {
    double largest = 0;
    for (const auto& entry : rows_[vertex]) largest = std::max(largest, entry.second);
    return largest;
  }
  /// Neighbours and positive weights whose sum is 1.
  [[nodiscard]] std::vector<std::pair<int, double>> row(int vertex) const {
    std::vector<std::pair<int, double>> row = rows_[vertex];
    const double largest = heaviest(vertex);
    double sum = 0;
    for (auto& entry : row) sum += entry.second = std::max(entry.second, kLeastMeanShare * largest);
    for (auto& entry : row) entry.second /= sum;
    return row;
  }

 private:
  std::vector<std::vector<std::pair<int, double>>> rows_;
};

void add_mean_values(const Eigen::MatrixX3i& F, std::span<const FlatTriangle> triangles,
                     MeanRows& rows) {
  for (int t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      const double half = std::tan(std::min(triangles[t].angle[k], 3.0) / 2);
      const double to_next = std::abs(triangles[t].edge[k]);
      const double to_last = std::abs(triangles[t].edge[last]);
      if (!(to_next > 0) || !(to_last > 0)) continue;
      rows.add(F(t, k), F(t, next), half / to_next);
      rows.add(F(t, k), F(t, last), half / to_last);
    }
  }
}

/// Holes get a vertex in their middle, joined to the whole loop both ways.
void close_holes(const TriMesh& mesh, std::span<const int> border, MeanRows& rows) {
  const std::vector<Edge> open = boundary_edges(mesh.F);
  DisjointSets loops(mesh.vertex_count());
  std::vector<bool> on_border(mesh.vertex_count(), false);
  for (const Edge& edge : open) {
    loops.join(edge[0], edge[1]);
    on_border[edge[0]] = true;
  }
  std::vector<int> middle(mesh.vertex_count(), -1);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int loop = loops.find(v);
    if (!on_border[v] || loop == loops.find(border[0])) continue;
    if (middle[loop] < 0) middle[loop] = rows.add_vertex();
    rows.add(middle[loop], v, 1);
    rows.add(v, middle[loop], rows.heaviest(v));
  }
}

}  // namespace

Eigen::VectorXcd convex_layout(const TriMesh& mesh, std::span<const FlatTriangle> triangles,
                               std::span<const int> border) {
  double area = 0;
  for (const FlatTriangle& t : triangles) area += t.area;
  Eigen::VectorXcd z = border_on_circle(mesh, border, area);
  std::vector<bool> fixed(mesh.vertex_count(), false);
  for (const int v : border) fixed[v] = true;
  MeanRows rows(mesh.vertex_count());
  add_mean_values(mesh.F, triangles, rows);
  close_holes(mesh, border, rows);
  fixed.resize(rows.size(), false);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(rows.size(), 2);
  for (int v = 0; v < rows.size(); ++v) {
    entries.emplace_back(v, v, 1.0);
    if (fixed[v]) {
      right.row(v) << z(v).real(), z(v).imag();
      continue;
    }
    for (const auto& [neighbour, weight] : rows.row(v)) entries.emplace_back(v, neighbour, -weight);
  }
  Eigen::SparseMatrix<double> matrix(rows.size(), rows.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success) {
    throw Error("the mean values cannot be factorised", "flattening", "a connected piece");
  }
  const Eigen::MatrixX2d places = solver.solve(right);
  return to_complex(places.topRows(mesh.vertex_count()));
}

}  // namespace geoprior::sketch
