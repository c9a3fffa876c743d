#include "models/sketch/sections/view_slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "models/sketch/drawing/polyline.h"

namespace geoprior::sketch {
namespace {

/// Coordinate of a view that runs along an axis of space.
int coordinate_along(const OutlinedView& view, int axis) {
  return view_axis(view.frame, 0).axis == axis ? 0 : 1;
}

/// Of each segment of the outline: the rim that it is part of, or -1.
std::vector<int> rims_of_segments(const OutlinedView& view, int axis, const std::vector<Rim>& rims,
                                  int number_of_view) {
  const std::vector<Eigen::Vector2d>& p = view.outline.points();
  const double near = 0.005 * view.outline.diagonal();
  std::vector<int> rim_of(p.size(), -1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Eigen::Vector2d middle = 0.5 * (p[i] + p[(i + 1) % p.size()]);
    for (std::size_t r = 0; r < rims.size(); ++r) {
      if (rims[r].view != number_of_view || rims[r].axis != axis) continue;
      const BesideStroke at = beside(rims[r].points, middle);
      const bool within = at.along > 0 && at.along < length(rims[r].points);
      if (within && std::abs(at.distance) < near) rim_of[i] = static_cast<int>(r);
    }
  }
  return rim_of;
}

/// Largest coordinate of the rim in a direction along an axis (1 or -1), times that direction.
double outermost(const Rim& rim, int coordinate, double direction) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& q : rim.points) most = std::max(most, direction * q[coordinate]);
  return most;
}

}  // namespace

ViewSlices::ViewSlices(const OutlinedView& view, int axis, const std::vector<Rim>& rims,
                       int number_of_view) {
  const int c = coordinate_along(view, axis);
  const double along = view_axis(view.frame, c).sign, across = view_axis(view.frame, 1 - c).sign;
  across_ = view_axis(view.frame, 1 - c).axis;
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector2d& q : view.outline.points())
    outline.emplace_back(along * q[c], across * q[1 - c]);
  std::vector<Rim> turned;
  for (const Rim& rim : rims) {
    turned.push_back(rim);
    for (Eigen::Vector2d& q : turned.back().points) q = {along * q[c], across * q[1 - c]};
    turned.back().outward = {along * rim.outward[c], across * rim.outward[1 - c]};
  }
  add_sides(outline, rims_of_segments(view, axis, rims, number_of_view), turned);
  sort_into_bands();
}

void ViewSlices::add_sides(const std::vector<Eigen::Vector2d>& outline,
                           const std::vector<int>& rim_of, const std::vector<Rim>& rims) {
  const int n = static_cast<int>(outline.size());
  for (int i = 0; i < n; ++i) {
    if (rim_of[i] < 0) sides_.push_back({outline[i], outline[(i + 1) % n]});
  }
  // Sides go on at both ends of a rim: at a point after which (step 1) or before which it begins.
  for (int i = 0; i < n; ++i) {
    for (const int step : {1, -1}) {
      const int rim_segment = step > 0 ? i : (i + n - 1) % n;
      const int side_segment = step > 0 ? (i + n - 1) % n : i;
      if (rim_of[rim_segment] < 0 || rim_of[side_segment] >= 0) continue;
      const Rim& rim = rims[rim_of[rim_segment]];
      const double out = rim.outward.x() < 0 ? -1 : 1;
      const double way = outermost(rim, 0, out) - out * outline[i].x();
      const double chord = (rim.points.front() - rim.points.back()).norm();
      if (way < 1e-6 * chord) continue;
      int back = i;
      for (int walked = 1; walked < n && (outline[back] - outline[i]).norm() < 0.15 * chord &&
                           rim_of[step > 0 ? (back + n - 1) % n : back] < 0;
           ++walked)
        back = (back - step + n) % n;
      Eigen::Vector2d direction = (outline[i] - outline[back]).normalized();
      if (out * direction.x() < 0.2) direction = {out, 0};
      sides_.push_back({outline[i], outline[i] + way / std::abs(direction.x()) * direction});
    }
  }
}

void ViewSlices::sort_into_bands() {
  for (const Side& side : sides_) {
    knots_.push_back(side.a.x());
    knots_.push_back(side.b.x());
  }
  std::sort(knots_.begin(), knots_.end());
  const double least = 1e-9 * (knots_.back() - knots_.front());
  knots_.erase(
      std::unique(knots_.begin(), knots_.end(), [&](double a, double b) { return b - a < least; }),
      knots_.end());
  bands_.resize(knots_.size() - 1);
  const auto knot = [&](double along) {
    const auto after = std::upper_bound(knots_.begin(), knots_.end(), along + 0.5 * least);
    return static_cast<int>(after - knots_.begin()) - 1;
  };
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const auto [low, high] = std::minmax(sides_[s].a.x(), sides_[s].b.x());
    for (int band = knot(low); band < knot(high); ++band) {
      bands_[band].push_back(static_cast<int>(s));
    }
  }
}

std::vector<Slice> ViewSlices::at(double along) const {
  const double margin = 1e-6 * (last() - first());
  const double t = std::clamp(along, first() + margin, last() - margin);
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), t);
  std::vector<std::pair<double, double>> crossings;  // place, slope
  for (const int s : bands_[after - knots_.begin() - 1]) {
    const Side& side = sides_[s];
    const double slope = (side.b.y() - side.a.y()) / (side.b.x() - side.a.x());
    crossings.emplace_back(side.a.y() + (t - side.a.x()) * slope, slope);
  }
  std::sort(crossings.begin(), crossings.end());
  if (crossings.size() % 2 == 1) crossings = {crossings.front(), crossings.back()};
  std::vector<Slice> slices;
  for (std::size_t i = 0; i < crossings.size(); i += 2) {
    const auto& [low, low_slope] = crossings[i];
    const auto& [high, high_slope] = crossings[i + 1];
    if (high > low) slices.push_back({low, high, low_slope, high_slope});
  }
  return slices;
}

Slice ViewSlices::extent_at(double along) const {
  const std::vector<Slice> slices = at(along);
  if (slices.empty()) return {};
  return {slices.front().low, slices.back().high, slices.front().low_slope,
          slices.back().high_slope};
}

namespace {

/// A drawn border as a rim, its axis not chosen yet; nothing where it is none.
std::optional<Rim> rim_of_border(const Stroke& stroke, const OutlinedView& view, int number) {
  if (stroke.inside || stroke.closed || stroke.points.size() < 2) return {};
  Rim rim{stroke.id, number, stroke.points};
  const Eigen::Vector2d chord = rim.points.back() - rim.points.front();
  if (!(chord.norm() > 0)) return {};
  const Eigen::Vector2d middle = point_along(rim.points, 0.5 * length(rim.points));
  rim.outward = Eigen::Vector2d(-chord.y(), chord.x()).normalized();
  if (rim.outward.dot(view.outline.nearest(middle).normal) < 0) rim.outward *= -1;
  return rim;
}

/// How well sections across an axis show the tube that a rim ends.
double axis_score(const Rim& rim, int coordinate, const std::vector<OutlinedView>& views) {
  constexpr double kLeastAcross = 0.35;  // sine of 20 degrees
  const double square = std::abs(rim.outward[coordinate]);
  if (square < kLeastAcross) return -1;
  const ViewAxis axis = view_axis(views[rim.view].frame, coordinate);
  const double chord = (rim.points.front() - rim.points.back()).norm();
  const Eigen::Vector2d middle = point_along(rim.points, 0.5 * length(rim.points));
  const double inner = axis.sign * (middle[coordinate] - 0.02 * chord * rim.outward[coordinate] /
                                                             std::abs(rim.outward[coordinate]));
  double score = square;
  if (ViewSlices(views[rim.view], axis.axis).at(inner).size() > 1) score -= 0.7;
  const bool seen_twice = std::any_of(views.begin(), views.end(), [&](const OutlinedView& other) {
    const bool shows =
        view_axis(other.frame, 0).axis == axis.axis || view_axis(other.frame, 1).axis == axis.axis;
    return shows && other.kind != views[rim.view].kind;
  });
  return seen_twice ? score : score - 0.2;
}

}  // namespace

std::vector<Rim> rims_of(const Drawing& aligned, const std::vector<OutlinedView>& views) {
  constexpr double kEdgeOn = 1.15, kMostCurved = 1.6;  // length over chord; a half circle: pi / 2
  std::vector<Rim> rims, oblique;
  std::array<bool, 3> used{};
  for (int v = 0; v < std::ssize(views); ++v) {
    for (const Stroke* stroke : strokes_of(*aligned.find(views[v].kind), StrokeKind::border)) {
      std::optional<Rim> rim = rim_of_border(*stroke, views[v], v);
      if (!rim) continue;
      const double curved = length(rim->points) / (rim->points.front() - rim->points.back()).norm();
      if (curved > kMostCurved) continue;
      const int c = axis_score(*rim, 0, views) > axis_score(*rim, 1, views) ? 0 : 1;
      rim->axis = view_axis(views[v].frame, c).axis;
      if (curved < kEdgeOn) used[rim->axis] = true;
      (curved < kEdgeOn ? rims : oblique).push_back(std::move(*rim));
    }
  }
  for (Rim& rim : oblique) {
    if (used[rim.axis]) rims.push_back(std::move(rim));
  }
  return rims;
}

}  // namespace geoprior::sketch
