#include "metrics/shape/roughness.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"
#include "metrics/tracks/weighted_quantile.h"

namespace geoprior {
namespace {

constexpr double kNoMeasure = std::numeric_limits<double>::quiet_NaN();

/// Values that are there, with the areas they stand for.
struct Sample {
  std::vector<double> values;
  std::vector<double> areas;

  void add(double value, double area) {
    if (std::isnan(value)) return;
    values.push_back(value);
    areas.push_back(area);
  }
  [[nodiscard]] auto value_vector() const { return as_vector(values); }
  [[nodiscard]] auto area_vector() const { return as_vector(areas); }
  /// @param shares  ascending
  [[nodiscard]] std::vector<double> percentiles(std::vector<double> shares) const {
    return weighted_quantiles(value_vector(), area_vector(), shares);
  }
  [[nodiscard]] double max() const { return value_vector().maxCoeff(); }
  /// Summed in order: sums over vectors depend on where these happen to lie in memory.
  [[nodiscard]] double rms() const {
    double squares = 0, area = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      squares += areas[i] * values[i] * values[i];
      area += areas[i];
    }
    return std::sqrt(squares / area);
  }

 private:
  static Eigen::Map<const Eigen::VectorXd> as_vector(const std::vector<double>& v) {
    return {v.data(), std::ssize(v)};
  }
};

std::vector<bool> chosen(const std::vector<int>& vertices, int count) {
  std::vector<bool> is_chosen(count, vertices.empty());
  for (const int v : vertices) is_chosen[v] = true;
  return is_chosen;
}

}  // namespace

Roughness::Roughness(const TriMesh& rest)
    : F_(rest.F),
      edges_(rest.F),
      rings_(one_rings(rest.F, rest.vertex_count())),
      at_border_(boundary_vertices(rest.F, rest.vertex_count())),
      edge_area_(Eigen::VectorXd::Zero(edges_.edge_count())),
      vertex_area_(Eigen::VectorXd::Zero(rest.vertex_count())) {
  rest_angles_ = dihedral_angles(rest.V);
  rest_heights_ = umbrella_heights(rest.V);
  const Eigen::VectorXd areas = triangle_areas(rest.V, rest.F);
  for (int h = 0; h < edges_.half_edge_count(); ++h) {
    edge_area_(edges_.edge_of(h)) += areas(h / 3) / 3;
    vertex_area_(edges_.origin(h)) += areas(h / 3) / 3;
  }
}

Eigen::VectorXd Roughness::folds(const Eigen::MatrixX3d& posed) const {
  require_vertices(posed);
  Eigen::VectorXd folds = (dihedral_angles(posed) - rest_angles_).cwiseAbs();
  for (Eigen::Index e = 0; e < folds.size(); ++e) {
    const bool lost_area = std::isnan(folds(e)) && !std::isnan(rest_angles_(e));
    if (lost_area) folds(e) = std::numbers::pi;
  }
  return folds;
}

Eigen::VectorXd Roughness::lumps(const Eigen::MatrixX3d& posed) const {
  require_vertices(posed);
  const Eigen::VectorXd change = umbrella_heights(posed) - rest_heights_;
  Eigen::VectorXd lumps(change.size());
  for (int v = 0; v < vertex_count(); ++v) {
    double sum = 0;
    int count = 0;
    for (const int n : rings_.of(v)) {
      if (std::isnan(change(n))) continue;
      sum += change(n);
      ++count;
    }
    lumps(v) = count > 0 ? std::abs(change(v) - sum / count) : kNoMeasure;
  }
  return lumps;
}

/// Signed, 0 when flat, positive at a ridge; NaN at a border and beside a triangle without area.
Eigen::VectorXd Roughness::dihedral_angles(const Eigen::MatrixX3d& V) const {
  const Eigen::MatrixX3d normals = triangle_normals({V, F_});
  Eigen::VectorXd angles(edges_.edge_count());
  for (int e = 0; e < edges_.edge_count(); ++e) {
    angles(e) = kNoMeasure;
    const int left = edges_.left(e);
    const int right = edges_.right(e);
    if (left < 0 || right < 0) continue;
    const Eigen::RowVector3d a = normals.row(left);
    const Eigen::RowVector3d b = normals.row(right);
    if (a.isZero(0) || b.isZero(0)) continue;
    const auto& [from, to] = edges_.edge(e);
    const Eigen::RowVector3d along = (V.row(to) - V.row(from)).normalized();
    angles(e) = std::atan2(b.cross(a).dot(along), a.dot(b));
  }
  return angles;
}

/// n_v . (mean of the neighbours - v) of every vertex; NaN at a border.
Eigen::VectorXd Roughness::umbrella_heights(const Eigen::MatrixX3d& V) const {
  const Eigen::MatrixX3d normals = vertex_normals({V, F_});
  Eigen::VectorXd heights(V.rows());
  for (int v = 0; v < V.rows(); ++v) {
    const auto ring = rings_.of(v);
    heights(v) = kNoMeasure;
    if (at_border_[v] || ring.empty()) continue;
    Eigen::RowVector3d umbrella = Eigen::RowVector3d::Zero();
    for (const int n : ring) umbrella += V.row(n) - V.row(v);
    heights(v) = normals.row(v).dot(umbrella) / static_cast<double>(ring.size());
  }
  return heights;
}

void Roughness::require_vertices(const Eigen::MatrixX3d& posed) const {
  if (posed.rows() == vertex_count()) return;
  throw Error(std::to_string(posed.rows()) + " posed vertices", "roughness",
              std::to_string(vertex_count()) + ", as at rest");
}

std::optional<RoughnessSummary> summarize(const Roughness& surface, const Eigen::VectorXd& folds,
                                          const Eigen::VectorXd& lumps,
                                          const std::vector<int>& vertices) {
  const std::vector<bool> is_chosen = chosen(vertices, surface.vertex_count());
  Sample fold;
  for (int e = 0; e < surface.edges().edge_count(); ++e) {
    const auto& [a, b] = surface.edges().edge(e);
    if (is_chosen[a] && is_chosen[b]) fold.add(folds(e), surface.edge_area()(e));
  }
  Sample lump;
  for (int v = 0; v < surface.vertex_count(); ++v) {
    if (is_chosen[v]) lump.add(lumps(v), surface.vertex_area()(v));
  }
  if (fold.values.empty() || lump.values.empty()) return std::nullopt;
  const std::vector<double> folded = fold.percentiles({0.5, 0.95, 0.99});
  return RoughnessSummary{folded[0],  folded[1],  folded[2],
                          fold.max(), lump.rms(), lump.percentiles({0.95}).front(),
                          lump.max()};
}

}  // namespace geoprior
