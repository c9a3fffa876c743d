#include "metrics/isometry/isometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/mesh.h"
#include "metrics/isometry/distortion.h"
#include "metrics/tracks/weighted_quantile.h"

namespace geoprior {
namespace {

void measure_edges(const Eigen::MatrixX3d& flat, const Eigen::MatrixX3d& x,
                   const Eigen::MatrixX3i& triangles, IsometrySummary& summary) {
  const EdgeConnectivity connectivity(triangles);
  const std::vector<Edge>& edges = connectivity.edges();
  Eigen::VectorXd error(edges.size());
  Eigen::VectorXd length(error.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = edges[i];
    const double rest = (flat.row(a) - flat.row(b)).norm();
    const double now = (x.row(a) - x.row(b)).norm();
    length(i) = rest;
    error(i) = rest > 0 ? std::abs(now / rest - 1) : 0.0;
  }
  summary.edge_error_p95 = weighted_quantile(error, length, 0.95);
  summary.edge_error_max = error.maxCoeff();
}

}  // namespace

IsometrySummary isometry(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& x,
                         const Eigen::MatrixX3i& triangles) {
  if (pattern.rows() != x.rows()) {
    throw Error(std::to_string(x.rows()) + " points", "isometry",
                std::to_string(pattern.rows()) + ", as in the pattern");
  }
  Eigen::MatrixX3d flat = Eigen::MatrixX3d::Zero(pattern.rows(), 3);
  flat.leftCols<2>() = pattern;
  const Eigen::VectorXd area = triangle_areas(flat, triangles);
  if (!(area.sum() > 0)) throw Error("no triangles with an area", "isometry", "at least one");
  std::vector<int> all(triangles.rows());
  std::iota(all.begin(), all.end(), 0);
  const Eigen::ArrayX2d strain = (singular_values(flat, x, triangles, all).array() - 1).abs();
  IsometrySummary summary;
  summary.rms =
      std::sqrt((strain.square().rowwise().sum() * area.array()).sum() / (2 * area.sum()));
  summary.max = strain.maxCoeff();
  summary.area_drift = triangle_areas(x, triangles).sum() / area.sum() - 1;
  measure_edges(flat, x, triangles, summary);
  return summary;
}

}  // namespace geoprior
