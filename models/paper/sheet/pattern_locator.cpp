#include "models/paper/sheet/pattern_locator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Barycentric weight below zero that still counts as inside: round-off of points on an edge.
constexpr double kInside = -1e-10;
/// Most cells of the grid along one side.
constexpr double kMostCells = 512;

struct Box {
  Vector2d low, high;
};

Box box_of(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles, int f) {
  Box box{pattern.row(triangles(f, 0)), pattern.row(triangles(f, 0))};
  for (int k = 1; k < 3; ++k) {
    const Vector2d p = pattern.row(triangles(f, k));
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

/// Barycentric weights of the point of a triangle nearest to `p`.
Eigen::Vector3d clamped_weights(const std::array<Vector2d, 3>& t, const Vector2d& p,
                                double& distance) {
  Eigen::Vector3d best = Eigen::Vector3d::UnitX();
  distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t j = (k + 1) % 3;
    const Vector2d along = t[j] - t[k];
    const double s = std::clamp((p - t[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double d = (p - t[k] - s * along).norm();
    if (d >= distance) continue;
    distance = d;
    best.setZero();
    best[k] = 1 - s;
    best[j] = s;
  }
  return best;
}

}  // namespace

PatternLocator::PatternLocator(const ShellMesh& mesh)
    : pattern_(mesh.pattern), triangles_(mesh.triangles) {
  if (mesh.triangle_count() == 0) throw Error("mesh without triangles", "pattern locator");
  origin_ = pattern_.colwise().minCoeff();
  const Vector2d size = pattern_.colwise().maxCoeff().transpose() - origin_;
  // About one cell a triangle; a few more cost less than longer lists.
  cell_ = std::max(std::sqrt(size.x() * size.y() / (2.0 * mesh.triangle_count())),
                   size.maxCoeff() / kMostCells);
  columns_ = static_cast<int>(size.x() / cell_) + 1;
  rows_ = static_cast<int>(size.y() / cell_) + 1;
  offset_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  // Two passes over the boxes: count, then fill.
  const auto visit = [&](auto&& each) {
    for (int f = 0; f < mesh.triangle_count(); ++f) {
      const Box box = box_of(pattern_, triangles_, f);
      for (int j = row(box.low.y()); j <= row(box.high.y()); ++j) {
        for (int i = column(box.low.x()); i <= column(box.high.x()); ++i) {
          each(static_cast<std::size_t>(j * columns_ + i), f);
        }
      }
    }
  };
  visit([&](std::size_t cell, int) { ++offset_[cell + 1]; });
  for (std::size_t c = 1; c < offset_.size(); ++c) offset_[c] += offset_[c - 1];
  items_.resize(offset_.back());
  std::vector<int> fill(offset_.begin(), offset_.end() - 1);
  visit([&](std::size_t cell, int f) { items_[fill[cell]++] = f; });
}

int PatternLocator::column(double u) const {
  return std::clamp(static_cast<int>((u - origin_.x()) / cell_), 0, columns_ - 1);
}

int PatternLocator::row(double v) const {
  return std::clamp(static_cast<int>((v - origin_.y()) / cell_), 0, rows_ - 1);
}

Eigen::Vector3d PatternLocator::barycentric(int f, const Vector2d& p) const {
  const Vector2d a = pattern_.row(triangles_(f, 0)), b = pattern_.row(triangles_(f, 1)),
                 c = pattern_.row(triangles_(f, 2));
  const double twice = cross(b - a, c - a);
  const double u = cross(c - b, p - b) / twice, v = cross(a - c, p - c) / twice;
  return {u, v, 1 - u - v};
}

PatternLocator::Place PatternLocator::locate(const Vector2d& p, int guess) const {
  if (guess >= 0) {
    const Eigen::Vector3d weights = barycentric(guess, p);
    if (weights.minCoeff() > 0) return {guess, weights};
  }
  const std::size_t cell = row(p.y()) * columns_ + column(p.x());
  Place best;
  double most = kInside;
  for (int i = offset_[cell]; i < offset_[cell + 1]; ++i) {
    const int f = items_[i];
    const Eigen::Vector3d weights = barycentric(f, p);
    const double least = weights.minCoeff();
    if (least <= most) continue;
    most = least;
    best = {f, weights};
    if (least > 0) return best;
  }
  if (best.triangle < 0) return nearest(p);
  best.weights = best.weights.cwiseMax(0.0);
  best.weights /= best.weights.sum();
  return best;
}

PatternLocator::Place PatternLocator::locate(const Vector2d& p, const Vector2d& from,
                                             int guess) const {
  if (across_.empty()) across_ = EdgeConnectivity(triangles_).across();
  int f = locate(from, guess).triangle;
  // A straight way enters a triangle once; more steps only rounding could take.
  for (std::size_t steps = 0; steps < across_.size(); ++steps) {
    const Eigen::Vector3d weights = barycentric(f, p);
    int exit = -1;
    for (int k = 0; k < 3; ++k) {
      const Vector2d a = pattern_.row(triangles_(f, k));
      const Vector2d b = pattern_.row(triangles_(f, (k + 1) % 3));
      // Beyond this edge, and the way leaves between its ends.
      if (weights[(k + 2) % 3] >= kInside) continue;
      if (orientation(from, p, a) <= 0 && orientation(from, p, b) >= 0) exit = k;
    }
    if (exit < 0) return {f, weights};
    const int next = across_[f][exit];
    if (next < 0) return {f, weights};
    f = next;
  }
  return locate(p);
}

/// All triangles: only points outside the mesh come here, which are few.
PatternLocator::Place PatternLocator::nearest(const Vector2d& p) const {
  Place best;
  double closest = std::numeric_limits<double>::infinity();
  for (int f = 0; f < triangles_.rows(); ++f) {
    const Eigen::Vector3d inside = barycentric(f, p);
    if (inside.minCoeff() >= 0) return {f, inside};
    double distance = 0;
    const Eigen::Vector3d weights = clamped_weights(
        {Vector2d(pattern_.row(triangles_(f, 0))), Vector2d(pattern_.row(triangles_(f, 1))),
         Vector2d(pattern_.row(triangles_(f, 2)))},
        p, distance);
    if (distance >= closest) continue;
    closest = distance;
    best = {f, weights};
  }
  return best;
}

}  // namespace geoprior::paper
