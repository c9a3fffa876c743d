#include "metrics/developability/folds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/limits.h"

namespace geoprior {
namespace {

using Eigen::Vector2d;
using Hinge = CurvatureFit::Hinge;

/// Larger factors come from edges that hardly fold on a cylinder, about a triangle at the border.
constexpr double kMostFoldFactor = 1.5;
constexpr double kMostDiscs = 1 << 24;
/// Directions that are tried over half a turn.
constexpr int kDirections = 48;
/// Preference for the direction across the folds: alternating folds of narrow strips may be those
/// of pleats or, as well, of a cylinder far aslant.
constexpr double kAcross = 0.03;
/// Preference for a cylinder that has the signs too: grids with alternating diagonals have the same
/// sizes on two.
constexpr double kOneWay = 0.01;

/// Hinges with what both measures ask of them, and those at each triangle.
class HingeField {
 public:
  HingeField(const CurvatureFit& fit, const Eigen::MatrixX2d& pattern,
             const std::vector<double>& angle)
      : fit_(fit), of_triangle_(fit.area.size()), angle_(angle) {
    for (int h = 0; h < std::ssize(fit.hinges); ++h) {
      const Hinge& hinge = fit.hinges[h];
      const Vector2d edge = pattern.row(hinge.b) - pattern.row(hinge.a);
      weight_.push_back(edge.squaredNorm() / (fit.area[hinge.left] + fit.area[hinge.right]));
      normal_.push_back(Vector2d(-edge.y(), edge.x()).normalized());
      of_triangle_[hinge.left].push_back(h);
      of_triangle_[hinge.right].push_back(h);
    }
  }

  /// l^2 / (A1 + A2)
  [[nodiscard]] double weight(int hinge) const { return weight_[hinge]; }
  [[nodiscard]] const std::vector<int>& of_triangle(int t) const { return of_triangle_[t]; }

  /// A triangle and its neighbours; sorted.
  [[nodiscard]] std::vector<int> patch(int triangle) const {
    std::vector<int> all{triangle};
    for (const int h : of_triangle_[triangle]) all.push_back(across(h, triangle));
    std::sort(all.begin(), all.end());
    return all;
  }
  /// Both triangles of a hinge and their neighbours; sorted.
  [[nodiscard]] std::vector<int> patch_of_hinge(int hinge) const {
    std::vector<int> all = patch(fit_.hinges[hinge].left);
    const std::vector<int> right = patch(fit_.hinges[hinge].right);
    all.insert(all.end(), right.begin(), right.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Direction d of the cylinder whose folds have sizes most like those of the triangles; zero when
  /// they are flat.
  [[nodiscard]] Vector2d direction(const std::vector<int>& triangles) const {
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const int t : triangles) {
      for (const int h : of_triangle_[t]) {
        spread += weight_[h] * angle_[h] * angle_[h] * normal_[h] * normal_[h].transpose();
      }
    }
    if (!(spread.trace() > 0)) return Vector2d::Zero();
    spread /= spread.trace();
    Vector2d best = Vector2d::Zero();
    double best_match = -1;
    for (int k = 0; k < kDirections; ++k) {
      const double angle = std::numbers::pi * k / kDirections;
      const Vector2d d(std::cos(angle), std::sin(angle));
      double product = 0, signed_product = 0, square = 0;
      for (const int t : triangles) {
        for (const int h : of_triangle_[t]) {
          const double q = on_cylinder(h, d);
          product += weight_[h] * std::abs(angle_[h] * q);
          signed_product += weight_[h] * angle_[h] * q;
          square += weight_[h] * q * q;
        }
      }
      const double match =
          (product * (1 + kAcross * d.dot(spread * d)) + kOneWay * std::abs(signed_product)) /
          std::sqrt(square);
      if (match <= best_match) continue;
      best_match = match;
      best = d;
    }
    return best;
  }

  /// Angle of a hinge on a cylinder of unit curvature that is bent in the direction d (m).
  [[nodiscard]] double on_cylinder(int hinge, const Vector2d& d) const {
    return fit_.hinges[hinge].jump.dot(
        Eigen::Vector3d(d.x() * d.x(), d.x() * d.y(), d.y() * d.y()));
  }

 private:
  [[nodiscard]] int across(int hinge, int triangle) const {
    const Hinge& h = fit_.hinges[hinge];
    return h.left == triangle ? h.right : h.left;
  }

  const CurvatureFit& fit_;
  std::vector<std::vector<int>> of_triangle_;
  const std::vector<double>& angle_;
  std::vector<double> weight_;
  std::vector<Vector2d> normal_;
};

std::vector<double> dihedral_angles(const CurvatureFit& fit, const Eigen::MatrixX3d& x) {
  std::vector<double> angle;
  angle.reserve(fit.hinges.size());
  for (const Hinge& h : fit.hinges) angle.push_back(dihedral_angle(x, h));
  return angle;
}

/// Length of the part of a segment that lies in a disc.
double length_within(const Vector2d& a, const Vector2d& b, const Vector2d& centre, double radius) {
  const Vector2d e = b - a, p = a - centre;
  const double length = e.norm();
  const double along = -p.dot(e) / length;  // of the foot of the centre
  const double beside = p.squaredNorm() - along * along;
  const double half = radius * radius - beside;
  if (!(half > 0)) return 0;
  const double reach = std::sqrt(half);
  return std::max(0.0, std::min(length, along + reach) - std::max(0.0, along - reach));
}

}  // namespace

SheetFolds sheet_folds(const CurvatureFit& fit, const Eigen::MatrixX2d& pattern,
                       const Eigen::MatrixX3d& x) {
  const std::vector<double> angle = dihedral_angles(fit, x);
  const HingeField field(fit, pattern, angle);
  SheetFolds folds;
  for (int h = 0; h < std::ssize(fit.hinges); ++h) {
    const auto index = h;
    const Vector2d d = field.direction(field.patch_of_hinge(index));
    folds.angle.push_back(field.on_cylinder(index, d) < 0 ? -angle[h] : angle[h]);
    folds.a.emplace_back(pattern.row(fit.hinges[h].a).transpose());
    folds.b.emplace_back(pattern.row(fit.hinges[h].b).transpose());
  }
  return folds;
}

double cancelling_share(const SheetFolds& folds, double radius) {
  if (!(radius > 0)) throw Error("is not positive", "radius of the discs", "a length");
  if (folds.angle.empty()) return 0;
  Vector2d low = folds.a.front(), high = low;
  for (const auto* ends : {&folds.a, &folds.b}) {
    for (const Vector2d& p : *ends) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const double spacing = radius / 2;
  const Vector2d size = (high - low) / spacing;
  require_count((size.x() + 1) * (size.y() + 1), "discs", kMostDiscs, "radius of the discs");
  const int columns = static_cast<int>(size.x()) + 2, rows = static_cast<int>(size.y()) + 2;
  std::vector<double> up(static_cast<std::size_t>(columns) * rows, 0);
  std::vector<double> down = up;
  for (std::size_t h = 0; h < folds.angle.size(); ++h) {
    const Vector2d from = (folds.a[h].cwiseMin(folds.b[h]) - low).array() / spacing - 2;
    const Vector2d to = (folds.a[h].cwiseMax(folds.b[h]) - low).array() / spacing + 2;
    for (int j = std::max(0, static_cast<int>(from.y())); j < rows && j <= to.y(); ++j) {
      for (int i = std::max(0, static_cast<int>(from.x())); i < columns && i <= to.x(); ++i) {
        const Vector2d centre = low + spacing * Vector2d(i, j);
        const double m = length_within(folds.a[h], folds.b[h], centre, radius) * folds.angle[h];
        const auto at = static_cast<std::size_t>(j) * columns + i;
        (m > 0 ? up[at] : down[at]) += std::abs(m);
      }
    }
  }
  double cancelling = 0, all = 0;
  for (std::size_t at = 0; at < up.size(); ++at) {
    cancelling += std::min(up[at], down[at]);
    all += (up[at] + down[at]) / 2;
  }
  return all > 0 ? cancelling / all : 0;
}

double fold_energy(const CurvatureFit& fit, const Eigen::MatrixX2d& pattern,
                   const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& rest_curvature,
                   const PlateStiffness& plate) {
  const Eigen::Index m = fit.area.size();
  if (rest_curvature.rows() != m) {
    throw Error(std::to_string(rest_curvature.rows()) + " rest curvatures", "fold energy",
                std::to_string(m) + ", one a triangle");
  }
  std::vector<double> angle = dihedral_angles(fit, x);
  for (std::size_t h = 0; h < angle.size(); ++h) {
    const Hinge& hinge = fit.hinges[h];
    const Eigen::RowVector3d rest =
        (rest_curvature.row(hinge.left) + rest_curvature.row(hinge.right)) / 2;
    angle[h] -= rest.dot(hinge.jump);
  }
  const HingeField field(fit, pattern, angle);
  double energy = 0;
  for (int t = 0; t < static_cast<int>(m); ++t) {
    double folds = 0;
    for (const int h : field.of_triangle(t)) folds += field.weight(h) * angle[h] * angle[h] / 2;
    if (!(folds > 0)) continue;
    const std::vector<int> patch = field.patch(t);
    const Vector2d d = field.direction(patch);
    double area = 0, on_cylinder = 0;
    for (const int s : patch) {
      area += fit.area[s];
      for (const int h : field.of_triangle(s)) {
        const double q = field.on_cylinder(h, d);
        on_cylinder += field.weight(h) * q * q / 2;
      }
    }
    energy += folds * std::min(area / on_cylinder, kMostFoldFactor);
  }
  return energy * plate.bending / 2;
}

}  // namespace geoprior
