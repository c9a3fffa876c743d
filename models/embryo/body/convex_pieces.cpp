#include "models/embryo/body/convex_pieces.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "models/embryo/shape/curve.h"

namespace geoprior::embryo {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// The point nearest to the origin in the hull of a subset of points, if it is in the inside of
/// that hull: weights w of sum 1 with (P w).(p_i - p_0) = 0 for all i.
std::optional<Eigen::Vector3d> nearest_inside(const Points& points, unsigned subset) {
  Points p;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (subset >> i & 1U) p.push_back(points[i]);
  const int n = static_cast<int>(p.size()) - 1;
  if (n == 0) return p[0];
  Eigen::MatrixXd edges(3, n);
  for (int i = 0; i < n; ++i) edges.col(i) = p[i + 1] - p[0];
  const Eigen::FullPivLU<Eigen::MatrixXd> gram(edges.transpose() * edges);
  if (!gram.isInvertible()) return std::nullopt;
  const Eigen::VectorXd w = gram.solve(-edges.transpose() * p[0]);
  if (w.minCoeff() < 0 || w.sum() > 1) return std::nullopt;
  return p[0] + edges * w;
}

/// The point nearest to the origin in the hull of up to four points, which are reduced to those
/// whose hull it is inside of. Every subset is tried: there are 15.
Eigen::Vector3d nearest_in_hull(Points& points) {
  Eigen::Vector3d best = points[0];
  unsigned best_subset = 1;
  for (unsigned subset = 1; subset < 1U << points.size(); ++subset) {
    const auto candidate = nearest_inside(points, subset);
    if (candidate && candidate->squaredNorm() < best.squaredNorm()) {
      best = *candidate;
      best_subset = subset;
    }
  }
  Points kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (best_subset >> i & 1U) kept.push_back(points[i]);
  points = std::move(kept);
  return best;
}

}  // namespace

ConvexPiece ConvexPiece::ovoid(const Shape& shape) {
  ConvexPiece piece;
  piece.kind_ = Kind::ovoid;
  piece.center_ = shape.center;
  piece.axes_ = shape.axes;
  piece.radii_ = shape.radii;
  piece.egg_ = shape.egg;
  piece.reach_ = (1 + std::abs(shape.egg)) * shape.radii.maxCoeff();
  return piece;
}

ConvexPiece ConvexPiece::square(const Shape& plane) {
  ConvexPiece piece;
  piece.kind_ = Kind::square;
  piece.center_ = plane.center;
  piece.axes_ = plane.axes;
  piece.radii_ = plane.radii;
  piece.reach_ = plane.radii.norm();
  return piece;
}

ConvexPiece ConvexPiece::balls(const Eigen::Vector3d& a, double radius_a, const Eigen::Vector3d& b,
                               double radius_b) {
  ConvexPiece piece;
  piece.center_ = (a + b) / 2;
  piece.reach_ = (a - b).norm() / 2 + std::max(radius_a, radius_b);
  piece.a_ = a;
  piece.b_ = b;
  piece.radius_a_ = radius_a;
  piece.radius_b_ = radius_b;
  return piece;
}

/// In local coordinates x = (1 + k s) cos t (a cos p, b sin p), z = c s, s = sin t: the best p is
/// along the direction, and t maximises f(t) = m (1 + k sin t) cos t + n sin t, by Newton from
/// the best t without the egg.
Eigen::Vector3d ConvexPiece::ovoid_support(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d d = axes_.transpose() * direction;
  const Eigen::Vector2d across = radii_.head<2>().cwiseProduct(d.head<2>());
  const double m = across.norm(), n = radii_.z() * d.z();
  double t = std::atan2(n, m);
  for (int step = 0; step < 30 && egg_ != 0; ++step) {
    const double slope = -m * std::sin(t) + m * egg_ * std::cos(2 * t) + n * std::cos(t);
    const double bend = -m * std::cos(t) - 2 * m * egg_ * std::sin(2 * t) - n * std::sin(t);
    if (!(bend < 0)) break;
    const double move = std::clamp(-slope / bend, -0.5, 0.5);
    t += move;
    if (std::abs(move) < 1e-14) break;
  }
  const double width = (1 + egg_ * std::sin(t)) * std::cos(t);
  Eigen::Vector3d local(0, 0, radii_.z() * std::sin(t));
  if (m > 0) local.head<2>() = width / m * radii_.head<2>().cwiseProduct(across);
  return center_ + axes_ * local;
}

Eigen::Vector3d ConvexPiece::support(const Eigen::Vector3d& direction) const {
  switch (kind_) {
    case Kind::ovoid:
      return ovoid_support(direction);
    case Kind::square: {
      const Eigen::Vector3d d = axes_.transpose() * direction;
      return center_ + axes_ * d.cwiseSign().cwiseProduct(radii_);
    }
    case Kind::balls:
      break;
  }
  const Eigen::Vector3d unit = direction.normalized();
  const bool at_a = unit.dot(a_) + radius_a_ >= unit.dot(b_) + radius_b_;
  return at_a ? a_ + radius_a_ * unit : b_ + radius_b_ * unit;
}

std::vector<ConvexPiece> convex_pieces(const Shape& shape) {
  switch (shape.primitive) {
    case Primitive::ovoid:
      return {ConvexPiece::ovoid(shape)};
    case Primitive::plane:
      return {ConvexPiece::square(shape)};
    case Primitive::duct:
      break;
    default: {
      const double radius = std::min(shape.radii.x(), shape.radii.z());
      const Eigen::Vector3d half = (shape.radii.z() - radius) * shape.axes.col(2);
      return {ConvexPiece::balls(shape.center - half, radius, shape.center + half, radius)};
    }
  }
  const Curve curve(shape.points);
  constexpr int kPerSpan = 8;
  const Points line = curve.polyline(kPerSpan);
  const auto radius = [&](std::size_t i) {
    const int spans = static_cast<int>(curve.spans().size()), at = static_cast<int>(i);
    const int span = std::min(at / kPerSpan, std::max(spans - 1, 0));
    const double share =
        spans == 0 ? 0 : curve.fraction_at(span, double(at - span * kPerSpan) / kPerSpan);
    return shape.radius + share * (shape.end_radius - shape.radius);
  };
  std::vector<ConvexPiece> pieces;
  if (line.size() == 1)
    pieces.push_back(ConvexPiece::balls(line[0], radius(0), line[0], radius(0)));
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    pieces.push_back(ConvexPiece::balls(line[i], radius(i), line[i + 1], radius(i + 1)));
  return pieces;
}

double distance(const ConvexPiece& a, const ConvexPiece& b) {
  constexpr double kAccuracy = 1e-9;
  const double size = a.reach() + b.reach();
  Eigen::Vector3d v = a.center() - b.center();
  if (v.norm() <= kAccuracy * size) return 0;
  Points simplex;
  for (int step = 0; step < 100; ++step) {
    const Eigen::Vector3d w = a.support(-v) - b.support(v);
    // v.w / |v| is a bound from below.
    if (!simplex.empty() && v.squaredNorm() - v.dot(w) <= kAccuracy * v.squaredNorm()) break;
    simplex.push_back(w);
    const Eigen::Vector3d next = nearest_in_hull(simplex);
    if (simplex.size() == 4 || next.norm() <= kAccuracy * size) return 0;
    const bool stuck = simplex.size() > 1 && !(next.squaredNorm() < v.squaredNorm());
    v = next;
    if (stuck && step > 1) break;
  }
  return v.norm();
}

double gap(const Shape& a, const Shape& b) {
  const std::vector<ConvexPiece> of_a = convex_pieces(a), of_b = convex_pieces(b);
  double least = std::numeric_limits<double>::infinity();
  for (const ConvexPiece& p : of_a) {
    for (const ConvexPiece& q : of_b) {
      if ((p.center() - q.center()).norm() - p.reach() - q.reach() >= least) continue;
      least = std::min(least, distance(p, q));
      if (least == 0) return 0;
    }
  }
  return least;
}

double extent_along(const Shape& shape, const Eigen::Vector3d& direction) {
  double most = -std::numeric_limits<double>::infinity();
  for (const ConvexPiece& piece : convex_pieces(shape))
    most = std::max(most, direction.dot(piece.support(direction)));
  return most;
}

}  // namespace geoprior::embryo
