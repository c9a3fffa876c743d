#include "models/paper/tear/lip_places.h"

#include "core/geometry/planar.h"

namespace geoprior::paper {
namespace {

using Eigen::RowVector3d;
using Eigen::Vector2d;

/// Distance from a lip, over the size of the pattern.
constexpr double kBeside = 1e-3;
/// Barycentric weight that rounding takes a point on an edge to.
constexpr double kLeastWeight = -1e-9;

}  // namespace

LipPlaces::LipPlaces(const ShellState& state, double width)
    : state_(state), locator_(state.mesh), beside_(kBeside * width) {}

PatternLocator::Place LipPlaces::on_lip(const Vector2d& p, const Vector2d& left, int lip) const {
  return locator_.locate(p, p + beside_ * inwards(left, lip));
}

std::optional<RowVector3d> LipPlaces::behind_lip(const Vector2d& p, const Vector2d& left, int lip,
                                                 double depth) const {
  const Vector2d in = inwards(left, lip);
  const PatternLocator::Place at = locator_.locate(p + depth * in, p + beside_ * in);
  if (at.weights.minCoeff() < kLeastWeight) return std::nullopt;
  return in_space(at);
}

RowVector3d LipPlaces::in_space(const PatternLocator::Place& at) const {
  RowVector3d x = RowVector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    x += at.weights[k] * state_.x.row(state_.mesh.triangles(at.triangle, k));
  }
  return x;
}

RowVector3d LipPlaces::in_plane_of(int triangle, const Vector2d& p) const {
  const Eigen::RowVector3i t = state_.mesh.triangles.row(triangle);
  const Vector2d a = state_.mesh.pattern.row(t[0]), b = state_.mesh.pattern.row(t[1]),
                 c = state_.mesh.pattern.row(t[2]);
  const double twice = cross(b - a, c - a);
  const double u = cross(c - b, p - b) / twice, v = cross(a - c, p - c) / twice;
  return in_space({triangle, {u, v, 1 - u - v}});
}

}  // namespace geoprior::paper
