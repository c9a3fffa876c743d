#include "models/embryo/surface/duct.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 0.35;      ///< of a piece, at most (rad), unless a span turns very far
constexpr double kLongest = 6;      ///< length of a piece in radii
constexpr int kMostPieces = 64;     ///< of a span
constexpr int kWideningPieces = 8;  ///< of a span along which the radius changes, at least
constexpr int kNewtonSteps = 5;     ///< one or two are common
/// Last step in t: as steps shrink quadratically t is then exact to 1e-8, and the distance, which
/// is stationary, to round-off.
constexpr double kConverged = 1e-4;
constexpr double kLeastSlope = 0.25;  ///< of Newton's derivative against |p'|^2

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

int pieces_of(const CubicSpan& span, double length, const Shape& duct) {
  constexpr int kSamples = 16;
  double turn = 0;
  for (int k = 0; k < kSamples; ++k)
    turn += angle_between(span.derivative(double(k) / kSamples),
                          span.derivative(double(k + 1) / kSamples));
  const double radius = std::max(duct.radius, duct.end_radius);
  const double wanted = std::max(turn / kTurn, radius > 0 ? length / (kLongest * radius) : 1.0);
  const double least = duct.radius != duct.end_radius ? kWideningPieces : 1;
  return static_cast<int>(std::clamp(std::ceil(wanted), least, double(kMostPieces)));
}

/// The part of a span between two parameters, with a parameter of its own.
CubicSpan part_of(const CubicSpan& span, double from, double to) {
  const double d = to - from;
  return {{span.at(from), d * span.derivative(from), d * d / 2 * span.second_derivative(from),
           d * d * d * span.c[3]}};
}

double distance_to_chord(const DuctPiece& piece, const Vector3d& x) {
  const Vector3d from = x - piece.start;
  if (!(piece.chord_squared > 0)) return from.norm();
  const double t = std::clamp(from.dot(piece.chord) / piece.chord_squared, 0.0, 1.0);
  return (from - t * piece.chord).norm();
}

DuctPiece make_piece(const CubicSpan& line, double start_radius, double end_radius) {
  DuctPiece piece;
  piece.line = line;
  piece.start_radius = start_radius;
  piece.end_radius = end_radius;
  piece.start = line.c[0];
  piece.chord = line.at(1) - line.c[0];
  piece.chord_squared = piece.chord.squaredNorm();
  piece.largest_radius = std::max(start_radius, end_radius);
  // The line lies within the hull of its Bezier points.
  const Vector3d second = line.c[0] + line.c[1] / 3;
  const Vector3d third = line.c[0] + (2 * line.c[1] + line.c[2]) / 3;
  const double round_off = 1e-9 * (piece.largest_radius + piece.chord.norm());
  piece.sagitta =
      1.000001 * std::max(distance_to_chord(piece, second), distance_to_chord(piece, third)) +
      round_off;
  return piece;
}

}  // namespace

std::vector<DuctPiece> duct_pieces(const Shape& duct) {
  const Curve curve(duct.points);
  const auto radius_at = [&](int span, double t) {
    return duct.radius + curve.fraction_at(span, t) * (duct.end_radius - duct.radius);
  };
  std::vector<DuctPiece> out;
  const Vector3d none = Vector3d::Zero();
  if (curve.spans().empty())
    return {make_piece({{duct.points.front(), none, none, none}}, duct.radius, duct.radius)};
  for (int s = 0; s < static_cast<int>(curve.spans().size()); ++s) {
    const CubicSpan& span = curve.spans()[s];
    const double length = (curve.fraction_at(s, 1) - curve.fraction_at(s, 0)) * curve.length();
    const int n = pieces_of(span, length, duct);
    for (int k = 0; k < n; ++k) {
      const double from = double(k) / n, to = double(k + 1) / n;
      out.push_back(make_piece(part_of(span, from, to), radius_at(s, from), radius_at(s, to)));
    }
  }
  return out;
}

double piece_distance(const DuctPiece& piece, const Vector3d& x) {
  const double widening = piece.end_radius - piece.start_radius;
  double t = piece.chord_squared > 0
                 ? std::clamp((x - piece.start).dot(piece.chord) / piece.chord_squared, 0.0, 1.0)
                 : 0.0;
  Vector3d from = piece.line.at(t) - x;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector3d tangent = piece.line.derivative(t);
    const double distance = from.norm(), along = from.dot(tangent), speed = tangent.squaredNorm();
    if (!(speed > 0) || !(distance > 0)) break;
    const double slope =
        speed + from.dot(piece.line.second_derivative(t)) - widening * along / distance;
    const double next = std::clamp(
        t - (along - widening * distance) / std::max(slope, kLeastSlope * speed), 0.0, 1.0);
    const double moved = std::abs(next - t);
    t = next;
    from = piece.line.at(t) - x;
    if (moved < kConverged) break;
  }
  return from.norm() - (piece.start_radius + t * widening);
}

double piece_bound(const DuctPiece& piece, const Vector3d& x) {
  return distance_to_chord(piece, x) - piece.sagitta - piece.largest_radius;
}

}  // namespace geoprior::embryo
