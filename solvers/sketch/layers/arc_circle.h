#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "models/sketch/drawing/ellipse_fit.h"
#include "solvers/sketch/drawing/mirror_plane.h"

namespace geoprior::sketch {

/// Circle in space whose centre and axis lie in the mirror plane, of which a view shows an arc:
/// P(s) = centre + radius (cos s up + sin s across), across = axis x up = +- the plane's normal.
struct ArcCircle {
  int stroke = 0;    ///< of the view
  std::string id;    ///< of the stroke
  std::string name;  ///< of the layer that ends there
  Eigen::Vector3d centre{0, 0, 0};
  Eigen::Vector3d axis{0, 0, 1};  ///< unit, from the first arc towards the last
  Eigen::Vector3d up{0, 1, 0};    ///< unit, in the mirror plane, to the side that was drawn
  double radius = 0;              ///< m
  std::vector<double> at;         ///< s of each drawn point, in (-pi, pi]
  double half_angle = 0;          ///< of the symmetric arc: the greatest |s| that was drawn
  double rms = 0, max = 0;        ///< distance of the drawn points in the view (m)
  double condition = 0;           ///< of the constrained fit (`CurveFit`)
  /// Sine of the angle by which the axis of the free ellipse leaves the mirror plane: of the
  /// reading that was kept, and of the other one (the ellipse is the image of two circles).
  double kept_sine = 0, other_sine = 0;

  [[nodiscard]] Eigen::Vector3d across() const;
  [[nodiscard]] Eigen::Vector3d point(double s) const;
};

/// Circles through the arcs of a view, in their order.
///
/// The free ellipse (`fit_ellipse`) has two circles as readings: radius = half major axis, tilt
/// cos phi = minor / major, on either side. The one whose axis is nearer to the mirror plane is the
/// start of the well-posed problem: centre (two coordinates within the mirror plane), angle of the
/// axis within it and radius are fitted to the drawn points in the view (`fit_curve`). With the
/// plane as it was read there is one such circle; the other reading of the plane (Necker,
/// `MirrorPlanes::other`) has the mirrored circles.
///
/// The first arc is the front edge of the first layer, whose rear edge is the second one. Where a
/// circle with the second's axis, two unknowns, lies about as near to the drawn points as one that
/// is free in the mirror plane (RMS at most twice as large, or a thousandth of the radius), it is
/// taken: the layer is a frustum, and noise does not tilt its edge. Else the circle stays free, and
/// the layer is cut obliquely in front (`FrustumBand`).
///
/// @throws Error  naming the stroke: fewer than two arcs; what `fit_ellipse` refuses; a circle seen
///                edge on; an arc whose centre does not go on along the body (layers out of order)
/// @param constrained  off: the start itself, its axis turned into the mirror plane (an ablation)
/// @param oblique      off: the first circle has the axis of the second in any case
std::vector<ArcCircle> fit_arc_circles(const View& view, const MirrorPlane& plane,
                                       bool constrained = true, bool oblique = true);

/// A single arc, without the order of others: `axis` and `up` up to sign.
/// @throws Error  as `fit_arc_circles`
ArcCircle fit_arc_circle(const Stroke& arc, const MirrorPlane& plane, bool constrained = true);

/// The two axes (unit, z >= 0) of circles that a view shows as this ellipse; equal where it is a
/// circle. radius = major, sin phi = sqrt(1 - (minor / major)^2).
std::array<Eigen::Vector3d, 2> axes_of_ellipse(const Ellipse& ellipse);

}  // namespace geoprior::sketch
