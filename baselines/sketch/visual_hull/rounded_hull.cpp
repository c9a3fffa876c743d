#include "baselines/sketch/visual_hull/rounded_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "models/sketch/drawing/polyline.h"

namespace geoprior::sketch {
namespace {

/// Half-space { y : n . (y - x) + d <= -r }, and its multiplier.
struct HalfSpace {
  Eigen::Vector3d normal;
  double distance = 0, multiplier = 0;
};

/// Point nearest to x of the half-spaces, by ascent of the dual, one multiplier at a time.
Eigen::Vector3d nearest_in(std::vector<HalfSpace>& spaces, const Eigen::Vector3d& x,
                           double radius) {
  constexpr int kRounds = 60;
  Eigen::Vector3d y = x;
  for (int round = 0; round < kRounds; ++round) {
    double moved = 0;
    for (HalfSpace& s : spaces) {
      const double beyond = s.normal.dot(y - x) + s.distance + radius;
      const double step = std::max(-s.multiplier, beyond);
      s.multiplier += step;
      y -= step * s.normal;
      moved = std::max(moved, std::abs(step));
    }
    if (moved < 1e-6 * radius) break;
  }
  return y;
}

bool on_border(const SketchSurface& surface, int view, const Eigen::Vector2d& point) {
  const double near = 0.05 * surface.hull.spacing;
  return std::any_of(surface.borders.begin(), surface.borders.end(),
                     [&](const BorderPlace& border) {
                       if (border.inside || border.view != view) return false;
                       const BesideStroke at = beside(border.points, point);
                       return std::abs(at.distance) < near && at.along > -near &&
                              at.along < length(border.points) + near;
                     });
}

/// The silhouette of a view, moved outward by a length where borders run along it.
Outline beyond_borders(const SketchSurface& surface, int view, double by) {
  const Outline& outline = surface.hull.views[view].outline;
  const std::vector<Eigen::Vector2d>& p = outline.points();
  const int n = static_cast<int>(p.size());
  std::vector<char> border(n);
  for (int i = 0; i < n; ++i) border[i] = on_border(surface, view, p[i]);
  const auto first = std::find(border.begin(), border.end(), 0);
  if (first == border.end()) return outline;
  std::vector<Eigen::Vector2d> points;
  const int begin = static_cast<int>(first - border.begin());
  for (int k = 0; k < n;) {
    const int i = (begin + k) % n;
    if (!border[i]) {
      points.push_back(p[i]);
      ++k;
      continue;
    }
    int run = 1;
    while (k + run < n && border[(i + run) % n]) ++run;
    const Eigen::Vector2d along = p[(i + run - 1) % n] - p[i];
    const Eigen::Vector2d out =
        run > 1 ? by * Eigen::Vector2d(along.y(), -along.x()).normalized() : Eigen::Vector2d(0, 0);
    points.push_back(p[i]);
    if (run > 1) {
      for (int j = 0; j < run; ++j) points.push_back(p[(i + j) % n] + out);
      points.push_back(p[(i + run - 1) % n]);
    }
    k += run;
  }
  return Outline(std::move(points));
}

}  // namespace

Eigen::MatrixX3d rounded_hull(const SketchSurface& surface, double radius) {
  const VisualHull& hull = surface.hull;
  Eigen::MatrixX3d X = hull.mesh.V;
  if (!(radius > 0)) return X;
  std::vector<Outline> outlines;
  for (int v = 0; v < std::ssize(hull.views); ++v)
    outlines.push_back(beyond_borders(surface, v, 4 * radius));
  std::vector<HalfSpace> spaces;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    for (int pass = 0; pass < 4; ++pass) {
      const Eigen::Vector3d x = X.row(i).transpose();
      spaces.clear();
      for (std::size_t v = 0; v < outlines.size(); ++v) {
        const Outline::Nearest nearest = outlines[v].nearest(hull.views[v].project(x));
        spaces.push_back(
            {hull.views[v].frame.topRows<2>().transpose() * nearest.normal, nearest.distance});
      }
      const Eigen::Vector3d from = x - nearest_in(spaces, x, radius);
      const double beyond = from.norm() - radius;
      if (beyond > 1e-9 * radius) X.row(i) -= (beyond * from.normalized()).transpose();
    }
  }
  return X;
}

}  // namespace geoprior::sketch
