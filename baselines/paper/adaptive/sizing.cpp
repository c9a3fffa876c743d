#include "baselines/paper/adaptive/sizing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/connectivity.h"
#include "core/geometry/planar.h"

namespace geoprior::paper {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Gradient = Eigen::Matrix<double, 3, 2>;

/// Eigenvalues and the axis of the greater one of a symmetric 2 x 2 matrix.
struct Axes {
  double major, minor;
  Vector2d axis;
};

Axes axes_of(const Matrix2d& m) {
  const double mean = (m(0, 0) + m(1, 1)) / 2, half = (m(0, 0) - m(1, 1)) / 2;
  const double off = (m(0, 1) + m(1, 0)) / 2;
  const double radius = std::hypot(half, off);
  // The larger of two equal expressions for the axis: the other one cancels.
  Vector2d axis = half >= 0 ? Vector2d(half + radius, off) : Vector2d(off, radius - half);
  const double length = axis.norm();
  if (length > 0) {
    axis /= length;
  } else {
    axis = Vector2d::UnitX();
  }
  return {mean + radius, mean - radius, axis};
}

Matrix2d from_axes(double major, double minor, const Vector2d& axis) {
  return minor * Matrix2d::Identity() + (major - minor) * axis * axis.transpose();
}

/// The part of a symmetric matrix with positive eigenvalues.
Matrix2d positive_part(const Matrix2d& m) {
  const Axes a = axes_of(m);
  return from_axes(std::max(a.major, 0.0), std::max(a.minor, 0.0), a.axis);
}

/// Triangles with what the criteria need of them.
class SizingField {
 public:
  SizingField(const ShellState& state, const std::vector<Obstacle>& obstacles,
              const SizingOptions& options);
  [[nodiscard]] SizeTensor of_triangle(int f) const;
  [[nodiscard]] double twice_area(int f) const { return twice_area_[f]; }

 private:
  /// The edge from `a` to `b` as its triangle `left` has it.
  struct Hinge {
    int a, b, left, right;
  };
  void build_triangles();
  void build_normals();
  void build_curvature();
  [[nodiscard]] std::vector<Hinge> hinges() const;
  [[nodiscard]] Vector2d pattern(int v) const { return state_.mesh.pattern.row(v); }
  [[nodiscard]] Vector3d place(int v) const { return state_.x.row(v); }
  /// Gradient over the pattern of the linear function with these values at the corners.
  [[nodiscard]] Gradient gradient(int f, const Vector3d& a, const Vector3d& b,
                                  const Vector3d& c) const {
    Gradient d;
    d.col(0) = b - a;
    d.col(1) = c - a;
    return d * inverse_[f];
  }

  const ShellState& state_;
  const SizingOptions& options_;
  std::vector<Matrix2d> inverse_;          ///< of the edge matrix of each triangle in the pattern
  std::vector<double> twice_area_;         ///< in the pattern
  std::vector<Vector3d> normal_;           ///< of triangles, unit
  std::vector<Vector3d> smooth_;           ///< of vertices, unit
  std::vector<Matrix2d> curvature_;        ///< of triangles
  std::vector<Eigen::VectorXd> distance_;  ///< of vertices to each obstacle
};

SizingField::SizingField(const ShellState& state, const std::vector<Obstacle>& obstacles,
                         const SizingOptions& options)
    : state_(state), options_(options) {
  build_triangles();
  build_normals();
  build_curvature();
  for (const Obstacle& obstacle : obstacles) {
    Eigen::VectorXd distance(state.mesh.vertex_count());
    for (int v = 0; v < state.mesh.vertex_count(); ++v) {
      distance[v] = obstacle.contact(place(v), state.time).distance;
    }
    distance_.push_back(std::move(distance));
  }
}

void SizingField::build_triangles() {
  const Eigen::MatrixX3i& F = state_.mesh.triangles;
  for (int f = 0; f < state_.mesh.triangle_count(); ++f) {
    const Vector2d a = pattern(F(f, 0)), b = pattern(F(f, 1)), c = pattern(F(f, 2));
    Matrix2d edges;
    edges << b - a, c - a;
    const double det = cross(b - a, c - a);
    Matrix2d inverse;
    inverse << edges(1, 1), -edges(0, 1), -edges(1, 0), edges(0, 0);
    inverse_.emplace_back(inverse / det);
    twice_area_.push_back(det);
    const Vector3d n = (place(F(f, 1)) - place(F(f, 0))).cross(place(F(f, 2)) - place(F(f, 0)));
    const double length = n.norm();
    normal_.push_back(length > 0 ? Vector3d(n / length) : Vector3d::UnitZ());
  }
}

/// Weights of Max 1999, which make the normals of a sphere exact on any triangulation: weights by
/// area alone overestimated curvature by a quarter on irregular meshes.
void SizingField::build_normals() {
  smooth_.assign(state_.mesh.vertex_count(), Vector3d::Zero());
  for (int f = 0; f < state_.mesh.triangle_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int v = state_.mesh.triangles(f, k);
      const double before =
          (pattern(state_.mesh.triangles(f, (k + 2) % 3)) - pattern(v)).squaredNorm();
      const double after =
          (pattern(state_.mesh.triangles(f, (k + 1) % 3)) - pattern(v)).squaredNorm();
      smooth_[v] += twice_area_[f] / (before * after) * normal_[f];
    }
  }
  for (Vector3d& n : smooth_) {
    const double length = n.norm();
    if (length > 0) n /= length;
  }
}

/// Interior edges, in the order of the triangles that have them first.
std::vector<SizingField::Hinge> SizingField::hinges() const {
  const Eigen::MatrixX3i& F = state_.mesh.triangles;
  const auto across = EdgeConnectivity(F).across();
  std::vector<Hinge> result;
  result.reserve(2 * across.size());
  for (int f = 0; f < F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int g = across[f][k];
      if (g > f) result.push_back({F(f, k), F(f, (k + 1) % 3), f, g});
    }
  }
  return result;
}

/// Each hinge bends its two triangles by theta l t t' / 2, spread over their areas. One triangle's
/// sum depends on how its edges lie to the curvature; the mean over it and its neighbours does so
/// much less.
void SizingField::build_curvature() {
  const std::size_t m = state_.mesh.triangle_count();
  std::vector<Matrix2d> bend(m, Matrix2d::Zero());  // area times curvature
  const std::vector<Hinge> all = hinges();
  for (const Hinge& h : all) {
    const std::size_t f = h.left, g = h.right;
    const Vector2d along = pattern(h.b) - pattern(h.a);
    const double length = along.norm();
    const Vector2d across(-along.y() / length, along.x() / length);
    const Vector3d edge = place(h.b) - place(h.a);
    const Vector3d turn = normal_[f].cross(normal_[g]);
    const double angle = std::atan2(turn.norm(), normal_[f].dot(normal_[g]));
    // Mountains and valleys beside each other cancel, so the sign matters.
    const double theta = turn.dot(edge) < 0 ? angle : -angle;
    const Matrix2d half = 0.5 * theta * length * across * across.transpose();
    bend[f] += half;
    bend[g] += half;
  }
  curvature_ = bend;
  std::vector<double> area(twice_area_);
  for (const Hinge& h : all) {
    const std::size_t f = h.left, g = h.right;
    curvature_[f] += bend[g];
    curvature_[g] += bend[f];
    area[f] += twice_area_[g];
    area[g] += twice_area_[f];
  }
  for (std::size_t f = 0; f < m; ++f) curvature_[f] /= 0.5 * area[f];
}

SizeTensor SizingField::of_triangle(int f) const {
  const int a = state_.mesh.triangles(f, 0), b = state_.mesh.triangles(f, 1),
            c = state_.mesh.triangles(f, 2);
  const auto normal = [&](int v) { return smooth_[v]; };
  const auto square = [](const auto& m, double unit) -> Matrix2d {
    return m.transpose() * m / (unit * unit);
  };
  SizeTensor size = square(curvature_[f], options_.refine_angle);
  size =
      tensor_max(size, square(gradient(f, normal(a), normal(b), normal(c)), options_.refine_angle));
  size = tensor_max(size, square(gradient(f, state_.v.row(a), state_.v.row(b), state_.v.row(c)),
                                 options_.refine_velocity));
  const Gradient F = gradient(f, place(a), place(b), place(c));
  const Matrix2d strain = (F.transpose() * F - Matrix2d::Identity()) / 2;
  const double unit = options_.refine_compression;
  size = tensor_max(size, positive_part(-strain) / (unit * unit));
  for (const Eigen::VectorXd& h : distance_) {
    const double mean = (h[a] + h[b] + h[c]) / 3;
    if (mean > options_.size_max) continue;
    const Eigen::RowVector2d slope = Eigen::RowVector2d(h[b] - h[a], h[c] - h[a]) * inverse_[f];
    size = tensor_max(size, square(slope, std::max(mean, options_.size_min)));
  }
  return limited(size, options_);
}

}  // namespace

SizeTensor tensor_max(const SizeTensor& a, const SizeTensor& b) { return a + positive_part(b - a); }

SizeTensor limited(const SizeTensor& tensor, const SizingOptions& options) {
  const double least = 1 / (options.size_max * options.size_max);
  const double most = 1 / (options.size_min * options.size_min);
  const Axes axes = axes_of(tensor);
  const double major = std::clamp(axes.major, least, most);
  const double minor = std::clamp(
      axes.minor, std::max(least, major * options.aspect_min * options.aspect_min), most);
  return from_axes(major, minor, axes.axis);
}

std::vector<SizeTensor> sizing_tensors(const ShellState& state,
                                       const std::vector<Obstacle>& obstacles,
                                       const SizingOptions& options) {
  const SizingField field(state, obstacles, options);
  const std::size_t n = state.mesh.vertex_count();
  std::vector<SizeTensor> sum(n, SizeTensor::Zero());
  std::vector<double> weight(n, 0);
  for (int f = 0; f < state.mesh.triangle_count(); ++f) {
    const SizeTensor size = field.of_triangle(f);
    const double area = field.twice_area(f);
    for (int k = 0; k < 3; ++k) {
      const std::size_t v = state.mesh.triangles(f, k);
      sum[v] += area * size;
      weight[v] += area;
    }
  }
  for (std::size_t v = 0; v < n; ++v) sum[v] /= weight[v];
  return sum;
}

}  // namespace geoprior::paper
