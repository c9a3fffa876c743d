#include "solvers/sketch/layers/arc_circle.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "models/sketch/drawing/curve_fit.h"

namespace geoprior::sketch {
namespace {

/// Least minor over major half axis of a circle that is not seen edge on: of what is narrower, a
/// line's width decides how the circle lies.
constexpr double kLeastOpening = 0.02;

/// Directions of a mirror plane, and of circles across it: P = origin + x e + y f.
struct PlaneBasis {
  Eigen::Vector3d origin, e, f, normal;

  [[nodiscard]] Eigen::Vector3d in_space(double x, double y) const {
    return origin + x * e + y * f;
  }
  /// The point of the plane that the view shows at p.
  [[nodiscard]] Eigen::Vector2d seen_at(const Eigen::Vector2d& p) const {
    Eigen::Matrix2d A;
    A << e.head<2>(), f.head<2>();
    return A.fullPivLu().solve(p - origin.head<2>());
  }
};

PlaneBasis basis_of(const MirrorPlane& plane) {
  const Eigen::Vector3d n = plane.normal;
  const Eigen::Vector3d e = n.unitOrthogonal();
  return {plane.offset * n, e, n.cross(e), n};
}

/// Circles across the plane: x, y of the centre, radius, angle of `up` from e. Lengths in `unit`.
ConjugateCurve circle_family(const PlaneBasis& basis, double unit, const Eigen::Vector2d& shift) {
  return [basis, unit, shift](const Eigen::VectorXd& p, Eigen::Matrix<double, 2, 3>& columns,
                              Eigen::Matrix<double, 6, Eigen::Dynamic>& d) {
    const Eigen::Vector2d e = basis.e.head<2>(), f = basis.f.head<2>(), n = basis.normal.head<2>();
    const Eigen::Vector2d up = std::cos(p(3)) * e + std::sin(p(3)) * f;
    columns << (basis.origin.head<2>() - shift) / unit + p(0) * e + p(1) * f, p(2) * up, p(2) * n;
    d.setZero();
    d.block<2, 1>(0, 0) = e;
    d.block<2, 1>(0, 1) = f;
    d.block<2, 1>(2, 2) = up;
    d.block<2, 1>(4, 2) = n;
    d.block<2, 1>(2, 3) = p(2) * (std::cos(p(3)) * f - std::sin(p(3)) * e);
  };
}

/// s of the point of a + b cos s + c sin s that is about nearest in direction.
double start_angle(const Eigen::Matrix<double, 2, 3>& columns, const Eigen::Vector2d& q) {
  const Eigen::Vector2d cs = columns.rightCols<2>().fullPivLu().solve(q - columns.col(0));
  return std::atan2(cs.y(), cs.x());
}

struct CircleStart {
  Eigen::Vector4d parameters;  ///< of `circle_family`, lengths in `unit`
  std::vector<int> fixed;
};

ArcCircle fitted_circle(const Stroke& arc, const PlaneBasis& basis, double unit,
                        const CircleStart& start) {
  const Eigen::Vector2d shift = arc.points.front();
  const ConjugateCurve family = circle_family(basis, unit, shift);
  std::vector<Eigen::Vector2d> points;
  std::vector<double> at;
  Eigen::Matrix<double, 2, 3> columns;
  Eigen::Matrix<double, 6, Eigen::Dynamic> d(6, 4);
  family(start.parameters, columns, d);
  for (const Eigen::Vector2d& p : arc.points) {
    points.emplace_back((p - shift) / unit);
    at.push_back(start_angle(columns, points.back()));
  }
  const CurveFit fit =
      fit_curve(family, points, start.parameters, at, start.fixed, "stroke '" + arc.id + "'");
  ArcCircle circle;
  circle.id = arc.id;
  circle.name = arc.name;
  const double angle = fit.parameters(3);
  circle.centre = basis.in_space(unit * fit.parameters(0), unit * fit.parameters(1));
  circle.up = std::cos(angle) * basis.e + std::sin(angle) * basis.f;
  circle.axis = circle.up.cross(basis.normal);
  circle.radius = unit * fit.parameters(2);
  circle.at = fit.at;
  circle.rms = unit * fit.rms;
  circle.max = unit * fit.max;
  circle.condition = fit.condition;
  return circle;
}

/// Turns the circle's own directions without moving it.
void turn_circle(ArcCircle& circle, const Eigen::Vector3d& axis, const Eigen::Vector3d& up) {
  std::vector<Eigen::Vector3d> feet;
  for (const double s : circle.at) feet.push_back(circle.point(s));
  circle.axis = axis;
  circle.up = up;
  circle.half_angle = 0;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const Eigen::Vector3d d = feet[i] - circle.centre;
    circle.at[i] = std::atan2(d.dot(circle.across()), d.dot(circle.up));
    circle.half_angle = std::max(circle.half_angle, std::abs(circle.at[i]));
  }
}

/// Axes point from the first circle to the last; `up` is towards what was drawn, of all circles on
/// the same side of the body.
void orient_circles(std::vector<ArcCircle>& circles, const Eigen::Vector3d& normal) {
  double side = 0;
  const std::size_t n = circles.size();
  for (std::size_t k = 0; k < n; ++k) {
    ArcCircle& circle = circles[k];
    const Eigen::Vector3d along =
        circles[std::min(k + 1, n - 1)].centre - circles[k > 0 ? k - 1 : 0].centre;
    if (circle.axis.dot(along) < 0) turn_circle(circle, -circle.axis, circle.up);
    const Eigen::Vector3d up = normal.cross(circle.axis);
    for (const double s : circle.at) side += (circle.point(s) - circle.centre).dot(up);
  }
  for (ArcCircle& circle : circles)
    turn_circle(circle, circle.axis, (side < 0 ? -1 : 1) * normal.cross(circle.axis));
}

void require_order(const std::vector<ArcCircle>& circles) {
  for (std::size_t k = 1; k < circles.size(); ++k) {
    const Eigen::Vector3d step = circles[k].centre - circles[k - 1].centre;
    const std::string where = "stroke '" + circles[k].id + "'";
    constexpr double kCoincide = 1e-3;
    if (!(step.norm() > kCoincide * circles[k].radius)) {
      throw Error("its circle coincides with that of '" + circles[k - 1].id + "'", where,
                  "every edge of a layer once");
    }
    if (k < 2) continue;
    const Eigen::Vector3d before = circles[k - 1].centre - circles[k - 2].centre;
    if (!(step.dot(before) > 0)) {
      throw Error("layers are out of order: it does not go on from '" + circles[k - 2].id +
                      "' and '" + circles[k - 1].id + "'",
                  where, "arcs in their order along the body");
    }
  }
}

/// The first circle anew, on the axis of the second.
ArcCircle coaxial_first(const Stroke& arc, const Eigen::Vector3d& normal,
                        const std::vector<ArcCircle>& circles) {
  const ArcCircle& second = circles[1];
  const PlaneBasis basis{second.centre, second.up, second.axis, normal};
  const double unit = second.radius;
  const double x = (circles[0].centre - second.centre).dot(second.axis) / unit;
  ArcCircle first = fitted_circle(arc, basis, unit, {{0, x, circles[0].radius / unit, 0}, {0, 3}});
  first.stroke = circles[0].stroke;
  first.kept_sine = circles[0].kept_sine;
  first.other_sine = circles[0].other_sine;
  // A radius of the other sign is the same circle, run through from its other side.
  if (first.radius < 0) {
    first.radius = -first.radius;
    for (double& s : first.at) s += std::acos(-1.0);
  }
  turn_circle(first, second.axis, second.up);
  return first;
}

/// Whether a circle lies about as near to its drawn points as one that had more freedom.
bool fits_as_well(const ArcCircle& bound, const ArcCircle& free) {
  constexpr double kWorse = 2, kLeast = 1e-3;  // times its distance; over the radius
  return bound.rms <= std::max(kWorse * free.rms, kLeast * free.radius);
}

}  // namespace

Eigen::Vector3d ArcCircle::across() const { return axis.cross(up); }

Eigen::Vector3d ArcCircle::point(double s) const {
  return centre + radius * (std::cos(s) * up + std::sin(s) * across());
}

std::array<Eigen::Vector3d, 2> axes_of_ellipse(const Ellipse& ellipse) {
  const double cosine = std::min(ellipse.minor / ellipse.major, 1.0);
  const double sine = std::sqrt((1 - cosine) * (1 + cosine));
  const Eigen::Vector2d minor =
      sine * Eigen::Vector2d(-ellipse.direction.y(), ellipse.direction.x());
  return {Eigen::Vector3d(minor.x(), minor.y(), cosine),
          Eigen::Vector3d(-minor.x(), -minor.y(), cosine)};
}

ArcCircle fit_arc_circle(const Stroke& arc, const MirrorPlane& plane, bool constrained) {
  const std::string where = "stroke '" + arc.id + "'";
  const EllipseFit free = fit_ellipse(arc.points, where);
  if (free.ellipse.minor < kLeastOpening * free.ellipse.major) {
    throw Error("the circle is seen edge on, and how it lies is not determined", where,
                "a view in which circles are seen as ellipses");
  }
  const PlaneBasis basis = basis_of(plane);
  std::array<Eigen::Vector3d, 2> axes = axes_of_ellipse(free.ellipse);
  if (std::abs(axes[1].dot(plane.normal)) < std::abs(axes[0].dot(plane.normal)))
    std::swap(axes[0], axes[1]);
  const double unit = free.ellipse.major;
  const Eigen::Vector2d centre = basis.seen_at(free.ellipse.centre) / unit;
  const Eigen::Vector3d up = basis.normal.cross(axes[0]).normalized();
  const double angle = std::atan2(up.dot(basis.f), up.dot(basis.e));
  const std::vector<int> none, all{0, 1, 2, 3};
  ArcCircle circle = fitted_circle(arc, basis, unit,
                                   {{centre.x(), centre.y(), 1, angle}, constrained ? none : all});
  circle.kept_sine = std::abs(axes[0].dot(plane.normal));
  circle.other_sine = std::abs(axes[1].dot(plane.normal));
  turn_circle(circle, circle.axis, circle.up);
  return circle;
}

std::vector<ArcCircle> fit_arc_circles(const View& view, const MirrorPlane& plane, bool constrained,
                                       bool oblique) {
  std::vector<ArcCircle> circles;
  std::vector<const Stroke*> arcs;
  for (int i = 0; i < std::ssize(view.strokes); ++i) {
    if (view.strokes[i].kind != StrokeKind::arc) continue;
    arcs.push_back(&view.strokes[i]);
    circles.push_back(fit_arc_circle(view.strokes[i], plane, constrained));
    circles.back().stroke = i;
  }
  if (circles.size() < 2) {
    throw Error("has " + std::to_string(circles.size()) + " arcs", "view:photo",
                "two or more: the edges of at least one layer");
  }
  require_order(circles);
  orient_circles(circles, plane.normal);
  ArcCircle first = coaxial_first(*arcs[0], plane.normal, circles);
  if (!oblique || fits_as_well(first, circles[0])) circles[0] = std::move(first);
  return circles;
}

}  // namespace geoprior::sketch
