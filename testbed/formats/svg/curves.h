#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// Appends the end points of chords that stay within `tolerance` of a cubic Bezier curve that
/// starts at `p0`; `p0` itself is not appended. At most 4096 chords a curve.
void flatten_cubic(const Eigen::Vector2d& p0, const Eigen::Vector2d& p1, const Eigen::Vector2d& p2,
                   const Eigen::Vector2d& p3, double tolerance, std::vector<Eigen::Vector2d>& out);

/// An elliptical arc as SVG gives it: by its ends, radii, turn of its x axis and two flags.
struct SvgArc {
  Eigen::Vector2d from, to;
  Eigen::Vector2d radii;
  double turn_deg = 0;
  bool large = false;  ///< the longer way
  bool sweep = false;  ///< angles increase
};

/// Appends the points of an arc likewise. Radii too small to reach are enlarged, a zero radius, or
/// one of a 10^12th of the distance, makes a straight line, equal ends nothing (SVG 1.1, F.6.2).
void flatten_arc(const SvgArc& arc, double tolerance, std::vector<Eigen::Vector2d>& out);

}  // namespace geoprior
