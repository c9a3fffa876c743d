#include "solvers/sketch/surface/fold_rotation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/geometry/planar.h"
#include "core/geometry/topology.h"
#include "models/sketch/drawing/polyline.h"

namespace geoprior::sketch {
namespace {

/// Distance of every vertex along edges from the edges of folds, and the nearest of those.
struct FoldDistance {
  std::vector<double> distance;
  std::vector<int> fold, edge;  ///< of the surface's folds, and of the path's edges
};

FoldDistance fold_distances(const SketchSurface& s, double most) {
  const Eigen::MatrixX3d& V = s.hull.mesh.V;
  const std::size_t n = V.rows();
  FoldDistance d{std::vector<double>(n, std::numeric_limits<double>::infinity()),
                 std::vector<int>(n, -1), std::vector<int>(n, -1)};
  const VertexGraph graph = one_rings(s.hull.mesh.F, static_cast<int>(V.rows()));
  using Item = std::tuple<double, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (int f = 0; f < std::ssize(s.folds); ++f) {
    for (int e = 0; e < std::ssize(s.folds[f].edges); ++e) {
      for (const int v : s.folds[f].edges[e]) {
        if (d.distance[v] == 0) continue;
        d.distance[v] = 0;
        d.fold[v] = f;
        d.edge[v] = e;
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

/// The two angles about an axis that bring a normal to an angle with `eye`, or as near as it gets:
/// the surface then falls away to the left of the axis, or to the right, as the eye sees it.
struct FoldTurns {
  double left = 0, right = 0;  ///< rad

  [[nodiscard]] double of(FoldSide side) const { return side == FoldSide::left ? left : right; }
};

FoldTurns turns_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& n,
                      const Eigen::Vector3d& eye, double angle) {
  const Eigen::Vector3d n_off = n - n.dot(axis) * axis, eye_off = eye - eye.dot(axis) * axis;
  const double size = n_off.norm() * eye_off.norm();
  if (size < 1e-12) return {};
  const double now = std::atan2(axis.dot(n_off.cross(eye_off)), n_off.dot(eye_off));
  const double c = (std::cos(angle) - n.dot(axis) * eye.dot(axis)) / size;
  const double away = std::acos(std::clamp(c, -1.0, 1.0));
  return {std::remainder(now - away, kFullTurn), std::remainder(now + away, kFullTurn)};
}

FoldSide other_side(FoldSide side) {
  return side == FoldSide::left ? FoldSide::right : FoldSide::left;
}

}  // namespace

void describe(OptionVisitor& v, FoldOptions& o) {
  v.value("angle_deg", o.angle_deg,
          {.doc = "angle between normal and view direction on the contour of a fold",
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
  for (const StrokePath& fold : s.folds) {
    widest = std::max(widest, fold.fold_width.value_or(0));
    const Eigen::Vector3d to_eye = s.hull.views[fold.view].frame.row(2).transpose();
    const double angle = fold.fold_angle_deg.value_or(options.angle_deg) * kDegree;
    groups_.push_back({to_eye, angle, fold.fold_side});
    groups_.push_back({-to_eye, angle, {}});
    if (fold.fold_side) groups_.back().side = other_side(*fold.fold_side);
  }
  add_edges(s);
  const FoldDistance d = fold_distances(s, widest);
  const Eigen::MatrixX3d normals = triangle_normals(s.hull.mesh);
  for (int t = 0; t < s.hull.mesh.F.rows(); ++t) {
    // The corner that is nearest to a fold decides which; the mean distance, how much.
    int nearest = s.hull.mesh.F(t, 0);
    double mean = 0;
    for (int k = 0; k < 3; ++k) {
      const int v = s.hull.mesh.F(t, k);
      if (d.distance[v] < d.distance[nearest]) nearest = v;
      mean += d.distance[v] / 3;
    }
    const int f = d.fold[nearest];
    if (f < 0 || !std::isfinite(mean)) continue;
    const double width = s.folds[f].fold_width.value_or(options.width);
    const double reach = d.distance[nearest] == 0 ? 0 : mean;
    const double weight = reach == 0 ? 1 : smooth_step(1 - reach / width);
    if (weight <= 0) continue;
    const DepthSide side = s.folds[f].side;
    const bool back = side == DepthSide::back ||
                      (side == DepthSide::both && normals.row(t).dot(groups_[2 * f].to_eye) < 0);
    triangles_.push_back({t, weight, first_edge_[f] + d.edge[nearest], 2 * f + (back ? 1 : 0)});
  }
}

void FoldRotation::add_edges(const SketchSurface& s) {
  const double window = 3 * s.hull.spacing;
  for (const StrokePath& fold : s.folds) {
    const OutlinedView& view = s.hull.views[fold.view];
    const auto first = static_cast<int>(edges_.size());
    first_edge_.push_back(first);
    std::vector<Eigen::Vector3d> middle;
    for (Edge e : fold.edges) {
      const Eigen::Vector3d a = s.hull.mesh.V.row(e[0]), b = s.hull.mesh.V.row(e[1]);
      middle.emplace_back((a + b) / 2);
      const Eigen::Vector2d along = beside(fold.points, view.project(middle.back())).direction;
      if (along.dot(view.project(b - a)) < 0) std::swap(e[0], e[1]);
      edges_.push_back({e, {}});
    }
    for (std::size_t i = 0; i < middle.size(); ++i) {
      for (int j = 0; j < std::ssize(middle); ++j) {
        if ((middle[i] - middle[j]).norm() <= window) edges_[first + i].nearby.push_back(first + j);
      }
    }
  }
}

std::vector<Eigen::Vector3d> FoldRotation::axes(const Eigen::MatrixX3d& X) const {
  std::vector<Eigen::Vector3d> axes;
  for (const FoldEdge& edge : edges_) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int e : edge.nearby)
      sum += (X.row(edges_[e].edge[1]) - X.row(edges_[e].edge[0])).transpose();
    axes.push_back(sum.normalized());
  }
  return axes;
}

void FoldRotation::blend(const Eigen::MatrixX3d& X, const Eigen::MatrixX3d& normals,
                         std::vector<Eigen::Matrix3d>& rotations) const {
  const std::vector<Eigen::Vector3d> axis = axes(X);
  std::vector<FoldTurns> turns;
  std::vector<FoldTurns> in_all(groups_.size());
  for (const Demand& demand : triangles_) {
    const Group& group = groups_[demand.group];
    turns.push_back(turns_about(axis[demand.edge], normals.row(demand.triangle).transpose(),
                                group.to_eye, group.angle));
    in_all[demand.group].left += demand.weight * std::abs(turns.back().left);
    in_all[demand.group].right += demand.weight * std::abs(turns.back().right);
  }
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Demand& demand = triangles_[i];
    const FoldTurns& all = in_all[demand.group];
    const FoldSide side = groups_[demand.group].side.value_or(
        all.left <= all.right ? FoldSide::left : FoldSide::right);
    const Eigen::Quaterniond folded(Eigen::AngleAxisd(turns[i].of(side), axis[demand.edge]));
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
