#include "solvers/sketch/fold_rotation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <tuple>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/planar.h"
#include "core/topology.h"

namespace geoprior::sketch {
namespace {

/// Distance of every vertex along edges from the edges of folds, and the nearest of those.
struct FoldDistance {
  std::vector<double> distance;
  std::vector<int> fold, edge;  ///< of the surface's folds, and of the path's edges
};

FoldDistance fold_distances(const SketchSurface& s, double most) {
  const Eigen::MatrixX3d& V = s.hull.mesh.V;
  const auto n = static_cast<std::size_t>(V.rows());
  FoldDistance d{std::vector<double>(n, std::numeric_limits<double>::infinity()),
                 std::vector<int>(n, -1), std::vector<int>(n, -1)};
  const VertexGraph graph = one_rings(s.hull.mesh.F, static_cast<int>(V.rows()));
  using Item = std::tuple<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (std::size_t f = 0; f < s.folds.size(); ++f) {
    for (std::size_t e = 0; e < s.folds[f].edges.size(); ++e) {
      for (const int v : s.folds[f].edges[e]) {
        if (d.distance[v] == 0) continue;
        d.distance[v] = 0;
        d.fold[v] = static_cast<int>(f);
        d.edge[v] = static_cast<int>(e);
        queue.emplace(0.0, v);
      }
    }
  }
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > d.distance[v]) continue;
    for (const int w : graph.of(v)) {
      const double further = distance + (V.row(v) - V.row(w)).norm();
      if (further >= d.distance[w] || further > most) continue;
      d.distance[w] = further;
      d.fold[w] = d.fold[v];
      d.edge[w] = d.edge[v];
      queue.emplace(further, w);
    }
  }
  return d;
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Smallest angle about the axis that brings `n` to the cosine `c` with `eye`; the nearest it gets
/// where it cannot.
double turn_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& n, const Eigen::Vector3d& eye,
                  double c) {
  const Eigen::Vector3d n_off = n - n.dot(axis) * axis, eye_off = eye - eye.dot(axis) * axis;
  const double size = n_off.norm() * eye_off.norm();
  if (size < 1e-12) return 0;
  const double now = std::atan2(axis.dot(n_off.cross(eye_off)), n_off.dot(eye_off));
  const double away = std::acos(std::clamp((c - n.dot(axis) * eye.dot(axis)) / size, -1.0, 1.0));
  const double first = std::remainder(now - away, kFullTurn);
  const double second = std::remainder(now + away, kFullTurn);
  return std::abs(first) <= std::abs(second) ? first : second;
}

}  // namespace

void describe(OptionVisitor& v, FoldOptions& o) {
  v.value("angle_deg", o.angle_deg,
          {.doc = "between normal and view direction on the contour of a fold",
           .unit = "deg",
           .min = 0,
           .max = 90});
  v.value("width", o.width,
          {.doc = "distance along the surface over which a fold fades",
           .unit = "m",
           .min = 0,
           .max = 10});
}

FoldRotation::FoldRotation(const SketchSurface& s, const FoldOptions& options) {
  if (s.folds.empty()) return;
  double widest = options.width;
  for (const StrokePath& fold : s.folds) widest = std::max(widest, fold.fold_width.value_or(0));
  const FoldDistance d = fold_distances(s, widest);
  for (int t = 0; t < s.hull.mesh.F.rows(); ++t) {
    // The corner that is nearest to a fold decides which; the mean distance, how much.
    int nearest = s.hull.mesh.F(t, 0);
    double mean = 0;
    for (int k = 0; k < 3; ++k) {
      const int v = s.hull.mesh.F(t, k);
      if (d.distance[v] < d.distance[nearest]) nearest = v;
      mean += d.distance[v] / 3;
    }
    if (d.fold[nearest] < 0 || !std::isfinite(mean)) continue;
    const StrokePath& fold = s.folds[d.fold[nearest]];
    const double width = fold.fold_width.value_or(options.width);
    const double reach = d.distance[nearest] == 0 ? 0 : mean;
    const double weight = reach == 0 ? 1 : smooth_step(1 - reach / width);
    if (weight <= 0) continue;
    triangles_.push_back({t, weight, fold.edges[d.edge[nearest]],
                          s.hull.views[fold.view].frame.row(2).transpose(),
                          fold.fold_angle_deg.value_or(options.angle_deg) * kDegree});
  }
}

void FoldRotation::blend(const Eigen::MatrixX3d& X, const Eigen::MatrixX3d& normals,
                         std::vector<Eigen::Matrix3d>& rotations) const {
  for (const Demand& demand : triangles_) {
    const Eigen::Vector3d axis =
        (X.row(demand.edge[1]) - X.row(demand.edge[0])).transpose().normalized();
    const Eigen::Vector3d n = normals.row(demand.triangle).transpose();
    // The back of the surface is seen from behind.
    const Eigen::Vector3d eye =
        n.dot(demand.to_eye) >= 0 ? demand.to_eye : Eigen::Vector3d(-demand.to_eye);
    const double turn = turn_about(axis, n, eye, std::cos(demand.angle));
    const Eigen::Quaterniond folded(Eigen::AngleAxisd(turn, axis));
    const Eigen::Quaterniond developable(rotations[demand.triangle]);
    rotations[demand.triangle] = developable.slerp(demand.weight, folded).toRotationMatrix();
  }
}

std::vector<int> FoldRotation::on_fold() const {
  std::vector<int> triangles;
  for (const Demand& demand : triangles_) {
    if (demand.weight == 1) triangles.push_back(demand.triangle);
  }
  return triangles;
}

}  // namespace geoprior::sketch
