#include "models/sketch/drawing/outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

constexpr double kCornerTurn = 30 * kDegree;

double twice_area(const std::vector<Eigen::Vector2d>& points) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += cross(points[i] - points[0], points[(i + 1) % points.size()] - points[0]);
  return sum;
}

}  // namespace

Outline::Outline(std::vector<Eigen::Vector2d> points) : points_(std::move(points)) {
  if (points_.size() < 3) {
    throw Error("has " + std::to_string(points_.size()) + " points", "outline", "at least three");
  }
  const double area = twice_area(points_);
  if (!(std::abs(area) > 0)) throw Error("has no area", "outline");
  if (area < 0) std::reverse(points_.begin(), points_.end());
  const std::size_t n = points_.size();
  arc_.assign(1, 0);
  lowest_ = highest_ = points_[0];
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d along = points_[(i + 1) % n] - points_[i];
    arc_.push_back(arc_.back() + along.norm());
    sides_.emplace_back(Eigen::Vector2d(along.y(), -along.x()).normalized());
    lowest_ = lowest_.cwiseMin(points_[i]);
    highest_ = highest_.cwiseMax(points_[i]);
  }
  fill_grid();
}

int Outline::cell(const Eigen::Vector2d& x, int axis) const {
  const double at = std::floor((x[axis] - lowest_[axis]) / spacing_);
  return static_cast<int>(std::clamp(at, 0.0, (axis == 0 ? columns_ : rows_) - 1.0));
}

void Outline::fill_grid() {
  const int n = static_cast<int>(points_.size());
  // About as many cells along the diagonal as a tenth of the segments, so that a cell holds few.
  spacing_ = diagonal() / std::clamp(n / 4, 8, 256);
  columns_ = static_cast<int>((highest_.x() - lowest_.x()) / spacing_) + 1;
  rows_ = static_cast<int>((highest_.y() - lowest_.y()) / spacing_) + 1;
  std::vector<std::vector<int>> of_cell(static_cast<std::size_t>(columns_) * rows_);
  for (int s = 0; s < n; ++s) {
    const Eigen::Vector2d a = points_[s], b = points_[(s + 1) % n];
    const Eigen::Vector2d low = a.cwiseMin(b), high = a.cwiseMax(b);
    for (int j = cell(low, 1); j <= cell(high, 1); ++j) {
      for (int i = cell(low, 0); i <= cell(high, 0); ++i) of_cell[j * columns_ + i].push_back(s);
    }
  }
  begin_.assign(1, 0);
  for (const std::vector<int>& segments : of_cell) {
    segment_.insert(segment_.end(), segments.begin(), segments.end());
    begin_.push_back(static_cast<int>(segment_.size()));
  }
}

Outline::Nearest Outline::on_segment(int segment, const Eigen::Vector2d& x) const {
  const int n = static_cast<int>(points_.size());
  const Eigen::Vector2d a = points_[segment], along = points_[(segment + 1) % n] - a;
  const double t = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  Nearest found;
  found.point = a + t * along;
  found.normal = sides_[segment];
  // At a corner the sum of both sides' normals tells inside from outside.
  if (t == 0) found.normal += sides_[(segment + n - 1) % n];
  if (t == 1) found.normal += sides_[(segment + 1) % n];
  found.arc_length = arc_[segment] + t * along.norm();
  const double distance = (x - found.point).norm();
  found.distance = (x - found.point).dot(found.normal) >= 0 ? distance : -distance;
  found.normal.normalize();
  return found;
}

Outline::Nearest Outline::nearest(const Eigen::Vector2d& x) const {
  const int i = cell(x, 0), j = cell(x, 1);
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  // Rings of cells about the nearest one, until no nearer segment can lie further out.
  for (int ring = 0; ring < columns_ + rows_; ++ring) {
    if (best >= 0 && least < (ring - 1) * spacing_) break;
    for (int row = std::max(0, j - ring); row <= std::min(rows_ - 1, j + ring); ++row) {
      const bool whole = std::abs(row - j) == ring;
      for (int column = i - ring; column <= i + ring; column += whole || ring == 0 ? 1 : 2 * ring) {
        if (column < 0 || column >= columns_) continue;
        const int c = row * columns_ + column;
        for (int k = begin_[c]; k < begin_[c + 1]; ++k) {
          const double distance = std::abs(on_segment(segment_[k], x).distance);
          if (distance < least || (distance == least && segment_[k] < best)) {
            least = distance;
            best = segment_[k];
          }
        }
      }
    }
  }
  return on_segment(best, x);
}

std::vector<double> Outline::corners_that(bool (*count)(double turn)) const {
  std::vector<double> corners;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector2d in = points_[i] - points_[(i + points_.size() - 1) % points_.size()];
    const Eigen::Vector2d out = points_[(i + 1) % points_.size()] - points_[i];
    if (count(signed_angle(in, out))) corners.push_back(arc_[i]);
  }
  return corners;
}

std::vector<double> Outline::corners() const {
  return corners_that([](double turn) { return std::abs(turn) > kCornerTurn; });
}

std::vector<double> Outline::convex_corners() const {
  return corners_that([](double turn) { return turn > kCornerTurn; });
}

Eigen::Vector2d Outline::at(double arc_length) const {
  double t = std::fmod(arc_length, length());
  if (t < 0) t += length();
  const auto after = std::upper_bound(arc_.begin(), arc_.end(), t);
  const std::size_t segment =
      std::min<std::size_t>(static_cast<std::size_t>(after - arc_.begin()), points_.size()) - 1;
  const Eigen::Vector2d a = points_[segment], b = points_[(segment + 1) % points_.size()];
  return a + (t - arc_[segment]) / (arc_[segment + 1] - arc_[segment]) * (b - a);
}

}  // namespace geoprior::sketch
