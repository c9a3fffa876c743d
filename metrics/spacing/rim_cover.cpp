#include "metrics/spacing/rim_cover.h"

#include <cmath>

#include "core/error.h"
#include "core/geometry/triangle_tree.h"
#include "metrics/isometry/circular_arc.h"

namespace geoprior {

double uncovered_share(const Eigen::MatrixX3d& rim, double ends, const TriMesh& below) {
  const CircularArc arc = circular_arc(rim);
  if (!std::isfinite(arc.radius)) throw Error("the rim is straight", "rim cover", "a circular arc");
  constexpr double kReach = 0.5;  // of the radius
  // A segment may pass between two triangles by round-off: a second one leans aside.
  constexpr double kAside = 0.01;
  const auto skipped = static_cast<Eigen::Index>(ends * static_cast<double>(rim.rows()));
  const TriangleTree tree(below);
  Eigen::Index count = 0, uncovered = 0;
  for (Eigen::Index i = skipped; i < rim.rows() - skipped; ++i) {
    const Eigen::Vector3d p = rim.row(i).transpose();
    const Eigen::Vector3d inward = kReach * (arc.centre - p);
    const Eigen::Vector3d aside = kAside * arc.axis.cross(inward);
    ++count;
    const bool covered =
        tree.meets_segment(p, p + inward) || tree.meets_segment(p, p + inward + aside);
    uncovered += covered ? 0 : 1;
  }
  return static_cast<double>(uncovered) / static_cast<double>(count);
}

}  // namespace geoprior
