#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace geoprior::embryo {

/// One span of a curve: p(t) = c[0] + c[1] t + c[2] t^2 + c[3] t^3 for t in [0, 1].
struct CubicSpan {
  std::array<Eigen::Vector3d, 4> c;

  [[nodiscard]] Eigen::Vector3d at(double t) const {
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
  }
  [[nodiscard]] Eigen::Vector3d derivative(double t) const {
    return c[1] + t * (2 * c[2] + 3 * t * c[3]);
  }
  [[nodiscard]] Eigen::Vector3d second_derivative(double t) const {
    return 2 * c[2] + 6 * t * c[3];
  }
};

/// The centre line of a duct: a centripetal Catmull-Rom curve through its control points, with a
/// continuous tangent, and the length of its arc.
///
/// With knots k(i+1) - k(i) = |P(i+1) - P(i)|^(1/2) the curve has no cusp and crosses itself in no
/// span. Before the first and after the last point stands the neighbour, mirrored at the end. A
/// control point that repeats the one before is left out; one point alone is a curve of no length.
/// Source: Yuksel, Schaefer and Keyser 2011, "Parameterization and applications of Catmull-Rom
/// curves".
class Curve {
 public:
  /// @param points  finite (m), one or more
  /// @throws Error  on no point, or on a coordinate that is not finite
  explicit Curve(std::span<const Eigen::Vector3d> points);

  /// Point at a fraction of the arc's length, which is clamped to [0, 1]; to about 1e-9 of the
  /// length.
  [[nodiscard]] Eigen::Vector3d at_fraction(double fraction) const;
  /// Fraction of the arc at parameter t of a span.
  [[nodiscard]] double fraction_at(int span, double t) const;
  /// The ends and `per_span` - 1 points, equal in the parameter, inside every span.
  /// @throws Error  unless 1 or more per span
  [[nodiscard]] std::vector<Eigen::Vector3d> polyline(int per_span) const;
  /// Metres.
  [[nodiscard]] double length() const { return arc_.back(); }
  /// None for a single point.
  [[nodiscard]] const std::vector<CubicSpan>& spans() const { return spans_; }

 private:
  [[nodiscard]] double arc_at(int span, double t) const;

  Eigen::Vector3d first_;
  std::vector<CubicSpan> spans_;
  std::vector<double> arc_;  ///< length up to the pieces' ends, kPieces a span, from 0
};

}  // namespace geoprior::embryo
