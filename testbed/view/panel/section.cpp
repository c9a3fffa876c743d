#include "testbed/view/panel/section.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace geoprior {
namespace {

constexpr Rgb kInside{240, 224, 212};
constexpr Rgb kOverlap{214, 62, 50};
constexpr Rgb kInsideOut{70, 110, 190};
constexpr Rgb kCurve{60, 40, 34};

Rgb section_color(int winding) {
  if (winding < 0) return kInsideOut;
  return winding == 1 ? kInside : kOverlap;
}

}  // namespace

std::vector<CurveSegment> cut(const Part& part, const ViewWindow& window) {
  const Eigen::VectorXd height =
      (part.points.rowwise() - window.center.transpose()) * window.direction;
  const auto flat = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector2d((p - window.center).dot(window.right),
                           (p - window.center).dot(window.up));
  };
  std::vector<CurveSegment> segments;
  for (Eigen::Index t = 0; t < part.triangles.rows(); ++t) {
    std::vector<Eigen::Vector3d> ends;
    for (int i = 0; i < 3; ++i) {
      const int a = part.triangles(t, i);
      const int b = part.triangles(t, (i + 1) % 3);
      if ((height[a] >= 0) == (height[b] >= 0)) continue;
      const double f = height[a] / (height[a] - height[b]);
      ends.emplace_back((1 - f) * part.points.row(a) + f * part.points.row(b));
    }
    if (ends.size() != 2) continue;
    const Eigen::Vector3d p = part.points.row(part.triangles(t, 0));
    const Eigen::Vector3d q = part.points.row(part.triangles(t, 1));
    const Eigen::Vector3d r = part.points.row(part.triangles(t, 2));
    const Eigen::Vector3d outward = (q - p).cross(r - p);
    const Eigen::Vector3d along = window.direction.cross(outward);
    if (along.dot(ends[1] - ends[0]) < 0) std::swap(ends[0], ends[1]);
    segments.push_back({flat(ends[0]), flat(ends[1])});
  }
  return segments;
}

Picture draw_section(const std::vector<CurveSegment>& segments, const ViewWindow& window,
                     int width_px, int height_px) {
  Picture picture(width_px, height_px);
  const PlaneView view{Eigen::Vector2d::Zero(), width_px / window.width_m};
  const std::vector<CurveSegment> curve = to_pixels(segments, view, picture);
  fill(picture, curve, section_color);
  stroke(picture, curve, std::max(1.5, height_px / 280.0), kCurve);
  return picture;
}

}  // namespace geoprior
