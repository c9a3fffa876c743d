#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/method.h"
#include "core/options.h"
#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// Near and far of the picture of a circle cannot be told apart: one bit has to be said.
enum class FrustumReading {
  towards,  ///< the body's axis, from the first circle to the last, points towards the eye
  away,     ///< away from it
};

struct FrustumFormulaOptions {
  FrustumReading reading = FrustumReading::towards;
  int around = 48;
};
void describe(OptionVisitor& v, FrustumFormulaOptions& options);

/// A circle as its own ellipse shows it: no mirror plane, no neighbours.
struct EllipseCircle {
  int stroke = 0;                                  ///< of the view
  Eigen::Vector3d centre{0, 0, 0}, axis{0, 0, 1};  ///< m; unit, forwards along the body
  double radius = 0;                               ///< m
  std::vector<Eigen::Vector3d> points;  ///< where the drawn points lie on the circle's plane (m)
};

/// Depth of a chain of circles by the frustum's formula.
///
/// An ellipse with half axes a >= b is the picture of a circle of radius a, tilted by phi, cos phi
/// = b / a. Between two circles the axis is taken as the mean of their tilts: centres that are D
/// apart in the picture are D / tan phi apart in depth (D = h sin phi). Depth begins with 0 at the
/// first centre. Each axis is turned so that it goes on along the body in the picture, and by
/// `reading` in depth.
///
/// The weak place is what it leaves out: phi is read off b / a alone, and a circle seen nearly
/// along its axis (phi near 0) or an arc that shows little of its ellipse puts the error of b into
/// depth unhindered.
///
/// @param view  closed borders, or arcs; borders that are open, or no ellipses, are not circles
/// @throws Error  on fewer than two; as `fit_ellipse`; where both are seen along their axis
std::vector<EllipseCircle> frustum_formula(const View& view, const FrustumFormulaOptions& options);

/// One frame: "surface" (a strip of triangles between one circle and the next; arrays "border",
/// "seam", "fold", 0), "strokes" as `one_view_frame`. Phase "reconstruct".
std::unique_ptr<Process> make_frustum_formula_process(const View& view,
                                                      const FrustumFormulaOptions& options);

}  // namespace geoprior::sketch
