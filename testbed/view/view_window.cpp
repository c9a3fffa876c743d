#include "testbed/view/view_window.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/error.h"
#include "testbed/view/panel/actors.h"

namespace geoprior {
namespace {

constexpr double kMargin = 1.04;  ///< of a fitted window over its content
constexpr double kWidest = 1.3;   ///< width over height of a window whose height is given
constexpr double kNarrowest = 0.4;

Eigen::Vector3d to_vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

/// Bounds along right, up and direction, relative to a centre.
struct Bounds {
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d high = -low;

  [[nodiscard]] bool empty() const { return low.x() > high.x(); }
  void add(const Eigen::Array3d& p) {
    low = low.min(p);
    high = high.max(p);
  }
};

/// Bounds of the points whose height lies within `half_height` and whose side within `half_width`.
Bounds bounds_of(const std::vector<const Part*>& parts, const ViewWindow& window,
                 double half_height, double half_width) {
  Eigen::Matrix3d axes;
  axes << window.right.transpose(), window.up.transpose(), window.direction.transpose();
  Bounds bounds;
  for (const Part* part : parts) {
    const Eigen::MatrixX3d points = extent_points(*part);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const Eigen::Vector3d p = axes * (points.row(i).transpose() - window.center);
      if (!p.allFinite()) continue;
      if (std::abs(p.y()) <= half_height && std::abs(p.x()) <= half_width) bounds.add(p.array());
    }
  }
  return bounds;
}

void set_axes(ViewWindow& window, const Eigen::Vector3d& direction, const Eigen::Vector3d& up,
              const char* key) {
  const Eigen::Vector3d right = up.cross(direction);
  if (!(right.norm() > 1e-9 * up.norm() * direction.norm())) {
    throw Error("direction and up are zero or parallel", key, "two independent vectors");
  }
  window.direction = direction.normalized();
  window.right = right.normalized();
  window.up = window.direction.cross(window.right);
}

/// Points are drawn as balls, which reach out of their bounds.
bool has_points(const std::vector<const Part*>& parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [](const Part* part) { return part->kind == Part::Kind::points; });
}

}  // namespace

Eigen::MatrixX3d extent_points(const Part& part) {
  if (part.kind != Part::Kind::grid) return part.points;
  Eigen::MatrixX3d corners(8, 3);
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const int last = part.grid_size[axis] - 1;
      corners(i, axis) =
          part.grid_origin[axis] + ((i >> axis) & 1) * last * part.grid_spacing[axis];
    }
  }
  return corners;
}

ViewWindow fit_window(const std::vector<const Part*>& parts, const FigureView& view) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  ViewWindow window;
  set_axes(window, to_vector(view.direction), to_vector(view.up), "figure_view.direction");
  if (view.target) window.center = to_vector(*view.target);
  const Bounds all = bounds_of(parts, window, kAll, kAll);
  if (all.empty()) throw Error("nothing to draw: the part has no points", "figure_view.part");
  const auto move = [&](double x, double y, double z) {
    window.center += x * window.right + y * window.up + z * window.direction;
  };
  if (!view.target) {
    const Eigen::Array3d middle = (all.low + all.high) / 2;
    move(middle.x(), middle.y(), middle.z());
  }
  window.height_m = view.height_m.value_or(
      2 * kMargin *
      (view.target ? std::max(all.high.y(), -all.low.y()) : (all.high.y() - all.low.y()) / 2));
  // Flat content (a line, a plane seen from its side) still needs a height.
  window.height_m = std::max(window.height_m, 0.05 * (all.high.x() - all.low.x()));
  const double widest = view.height_m ? kWidest * window.height_m / 2 : kAll;
  const Bounds seen = bounds_of(parts, window, window.height_m / 2, widest);
  if (seen.empty()) {
    throw Error("nothing to draw: no point lies in the window", "figure_view.target");
  }
  move((seen.low.x() + seen.high.x()) / 2, 0, (seen.low.z() + seen.high.z()) / 2);
  window.width_m = std::max(kMargin * (seen.high.x() - seen.low.x()), kNarrowest * window.height_m);
  const double ball = has_points(parts) && !view.height_m ? overlay_ball_radius(window) : 0;
  window.height_m += 2 * ball;
  window.width_m += 2 * ball;
  window.depth_m = std::max((seen.high.z() - seen.low.z()) / 2, 0.05 * window.height_m) * 1.2;
  return window;
}

ViewWindow section_window(const ViewWindow& window, const SectionView& section) {
  ViewWindow out = window;
  Eigen::Vector3d normal = to_vector(section.normal);
  if (normal.dot(window.direction) < 0) normal = -normal;
  set_axes(out, normal, window.up, "figure_view.section");
  const Eigen::Vector3d offset = to_vector(section.origin) - window.center;
  out.center += offset.dot(out.direction) * out.direction;
  return out;
}

}  // namespace geoprior
