#include "experiments/assembly/files/primitives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::assembly {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kTurnSegments = 48;    // of a full turn
constexpr int kRoundSegments = 4;    // of a rounded right angle
constexpr int kGrooveSegments = 12;  // of half a turn
const double kCreaseCosine = std::cos(std::numbers::pi / 6);
/// Shorter segments have no direction (m).
constexpr double kShortestSweptSegment = 1e-9;
constexpr double kSmallestBodySize = 1e-6;

/// A copy of a section: its point (x, y) lies at origin + x a + y b.
struct SweptStation {
  Vector3d origin, a, b;
  bool is_joined = true;  ///< false: no surface from here to the next one, which is at its place

  [[nodiscard]] Vector3d at(const Vector2d& p) const { return origin + p.x() * a + p.y() * b; }
};

double doubled_area(std::span<const Vector2d> outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    sum += cross(outline[i], outline[(i + 1) % outline.size()]);
  return sum;
}

/// The outline counter-clockwise and without points in one place.
std::vector<Vector2d> cleaned_outline(std::span<const Vector2d> outline) {
  std::vector<Vector2d> out;
  for (const Vector2d& p : outline)
    if (out.empty() || (p - out.back()).norm() > kShortestSweptSegment) out.push_back(p);
  while (out.size() > 1 && (out.front() - out.back()).norm() <= kShortestSweptSegment)
    out.pop_back();
  const double area = doubled_area(out);
  if (out.size() < 3 || !(std::abs(area) > 0))
    throw Error("has an outline that encloses nothing", "", "three points, not on one line");
  if (area < 0) std::reverse(out.begin(), out.end());
  return out;
}

/// Whether the surface bends by more than the crease angle at a corner.
bool is_body_crease(const Eigen::VectorXd& before, const Eigen::VectorXd& at,
                    const Eigen::VectorXd& after) {
  return (at - before).normalized().dot((after - at).normalized()) < kCreaseCosine;
}

void add_body_triangle(Body& body, int a, int b, int c) {
  const Vector3d &x = body.vertices[a], &y = body.vertices[b], &z = body.vertices[c];
  // Quads that end on the axis of a lathe have lost an edge.
  if ((x - y).norm() < kShortestSweptSegment || (y - z).norm() < kShortestSweptSegment ||
      (z - x).norm() < kShortestSweptSegment)
    return;
  body.triangles.emplace_back(a, b, c);
}

/// A column of vertices: one point of the section at each station.
int add_swept_column(Body& body, const Vector2d& p, const std::vector<SweptStation>& stations) {
  const int first = static_cast<int>(body.vertices.size());
  for (const SweptStation& station : stations) body.vertices.push_back(station.at(p));
  return first;
}

/// The surface that a counter-clockwise outline leaves behind on its way through the stations,
/// which run along a x b; a closed way ends at its beginning.
void add_swept_surface(Body& body, const std::vector<Vector2d>& outline,
                       const std::vector<SweptStation>& stations, bool is_closed) {
  const std::size_t n = outline.size();
  std::vector<int> leaving(n), arriving(n);
  for (std::size_t i = 0; i < n; ++i) {
    leaving[i] = arriving[i] = add_swept_column(body, outline[i], stations);
    if (is_body_crease(outline[(i + n - 1) % n], outline[i], outline[(i + 1) % n]))
      arriving[i] = add_swept_column(body, outline[i], stations);
  }
  const int count = static_cast<int>(stations.size());
  for (std::size_t i = 0; i < n; ++i) {
    const int low = leaving[i], high = arriving[(i + 1) % n];
    for (int s = 0; s < (is_closed ? count : count - 1); ++s) {
      if (!stations[s].is_joined) continue;
      const int next = (s + 1) % count;
      add_body_triangle(body, low + s, high + s, high + next);
      add_body_triangle(body, low + s, high + next, low + next);
    }
  }
}

/// Takes out vertices of no triangle: those of outline edges on the axis of a lathe.
void drop_unused_vertices(Body& body) {
  std::vector<int> number(body.vertices.size(), -1);
  std::vector<Vector3d> used;
  for (Eigen::Vector3i& triangle : body.triangles)
    for (int& corner : triangle) {
      int& k = number[corner];
      if (k < 0) {
        k = static_cast<int>(used.size());
        used.push_back(body.vertices[corner]);
      }
      corner = k;
    }
  body.vertices = std::move(used);
}

/// The two ends of a sweep.
void add_swept_caps(Body& body, const std::vector<Vector2d>& outline, const SweptStation& first,
                    const SweptStation& last) {
  const int n = static_cast<int>(outline.size());
  Eigen::MatrixX2d points(n, 2);
  std::vector<Eigen::Vector2i> segments;
  for (int i = 0; i < n; ++i) {
    points.row(i) = outline[i].transpose();
    segments.emplace_back(i, (i + 1) % n);
  }
  const Eigen::MatrixX3i F = constrained_delaunay(points, segments);
  for (const bool is_last : {false, true}) {
    const int from = static_cast<int>(body.vertices.size());
    for (const Vector2d& p : outline) body.vertices.push_back((is_last ? last : first).at(p));
    for (Eigen::Index f = 0; f < F.rows(); ++f) {
      const Eigen::Vector3i t = F.row(f).transpose().array() + from;
      body.triangles.emplace_back(t[0], t[is_last ? 1 : 2], t[is_last ? 2 : 1]);
    }
  }
}

/// The outline with its convex creases rounded. Points beyond both ends of an arc keep the normals
/// of the flat sides flat.
std::vector<Vector2d> rounded_outline(const std::vector<Vector2d>& outline, double round) {
  if (!(round > 0)) return outline;
  const std::size_t n = outline.size();
  std::vector<Vector2d> out;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d& corner = outline[i];
    const Vector2d in = corner - outline[(i + n - 1) % n], on = outline[(i + 1) % n] - corner;
    const double turn = signed_angle(in, on);
    if (turn <= 0 || std::cos(turn) >= kCreaseCosine) {
      out.push_back(corner);
      continue;
    }
    const double cut = round * std::tan(turn / 2);
    const double room = std::min(in.norm(), on.norm()) / 2;
    if (!(cut < room))
      throw Error("is rounded by more than its edges are long", "", "a smaller 'round'");
    const double beyond = std::min(2 * cut, (cut + room) / 2);
    const Vector2d d = in.normalized();
    const Vector2d centre = corner - cut * d + round * Vector2d(-d.y(), d.x());
    out.push_back(corner - beyond * d);
    for (int k = 0; k <= kRoundSegments; ++k)
      out.push_back(centre + Eigen::Rotation2Dd(turn * k / kRoundSegments) *
                                 (round * Vector2d(d.y(), -d.x())));
    out.push_back(corner + beyond * on.normalized());
  }
  return out;
}

/// The tight box of some points in a frame.
Box body_box_around(std::span<const Vector3d> points, const Eigen::Matrix3d& axes) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : points) box.extend(axes.transpose() * x);
  Box out;
  out.pose.linear() = axes;
  out.pose.translation() = axes * box.center();
  out.half = box.sizes() / 2;
  return out;
}

/// Axes along a direction, upright (z straight up) or square to it.
Eigen::Matrix3d segment_axes(const Vector3d& direction, bool is_upright) {
  Eigen::Matrix3d axes;
  const Vector3d side = Vector3d::UnitZ().cross(direction).normalized();
  axes.col(0) = is_upright ? side.cross(Vector3d::UnitZ()) : direction.normalized();
  axes.col(1) = side;
  axes.col(2) = axes.col(0).cross(side);
  return axes;
}

/// An upright box fits the ends of a sweep, which are upright, and a box along the segment its
/// slope: the first is kept until it is half as large again.
Box segment_box(std::span<const Vector3d> points, const Vector3d& direction) {
  const Box upright = body_box_around(points, segment_axes(direction, true));
  const Box sloped = body_box_around(points, segment_axes(direction, false));
  return upright.half.prod() <= 1.5 * sloped.half.prod() ? upright : sloped;
}

/// Upright sections along a poly-line, mitred in plan; a sharp corner has two.
std::vector<SweptStation> path_stations(std::span<const Vector3d> points) {
  if (points.size() < 2) throw Error("has no way to be swept along", "", "two points or more");
  std::vector<Vector3d> along;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    along.push_back(points[i + 1] - points[i]);
    if (along.back().head<2>().norm() <= kShortestSweptSegment)
      throw Error("is swept along a segment that stands still or upright",
                  "point " + std::to_string(i + 1), "segments with a horizontal length");
  }
  const auto left = [](const Vector3d& d) { return Vector3d::UnitZ().cross(d).normalized(); };
  std::vector<SweptStation> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d& in = along[i == 0 ? 0 : i - 1];
    const Vector3d& on = along[std::min(i, along.size() - 1)];
    const Vector3d sum = left(in) + left(on);
    if (sum.norm() < 1)
      throw Error("is swept around a turn that is too sharp", "point " + std::to_string(i),
                  "at most 120 degrees");
    out.push_back({points[i], 2 * sum / sum.squaredNorm(), Vector3d::UnitZ()});
    if (i > 0 && i + 1 < points.size() && is_body_crease(points[i - 1], points[i], points[i + 1])) {
      out.push_back(out.back());
      out[out.size() - 2].is_joined = false;
    }
  }
  return out;
}

/// One box for each run of segments on one line.
void add_segment_boxes(Body& body, const std::vector<Vector2d>& outline,
                       const std::vector<SweptStation>& stations) {
  Eigen::AlignedBox2d section;
  for (const Vector2d& p : outline) section.extend(p);
  std::vector<Vector3d> corners;
  const auto add_corners = [&](const SweptStation& station) {
    for (int c = 0; c < 4; ++c)
      corners.push_back(
          station.at(section.corner(static_cast<Eigen::AlignedBox2d::CornerType>(c))));
  };
  std::size_t first = 0;
  for (std::size_t s = 1; s < stations.size(); ++s) {
    const Vector3d run = stations[s].origin - stations[first].origin;
    if (s + 1 < stations.size()) {
      const Vector3d next = stations[s + 1].origin - stations[s].origin;
      if (next.norm() <= kShortestSweptSegment ||
          run.cross(next).norm() <= 1e-6 * run.norm() * next.norm())
        continue;
    }
    corners.clear();
    add_corners(stations[first]);
    add_corners(stations[s]);
    body.boxes.push_back(segment_box(corners, run));
    first = s;
  }
}

Body swept_body(const std::vector<Vector2d>& outline, std::span<const Vector3d> points) {
  const std::vector<SweptStation> stations = path_stations(points);
  Body body;
  add_swept_surface(body, outline, stations, false);
  add_swept_caps(body, outline, stations.front(), stations.back());
  add_segment_boxes(body, outline, stations);
  return body;
}

void require_body_sizes(std::initializer_list<double> sizes, double round) {
  for (const double size : sizes)
    if (!(size >= kSmallestBodySize)) throw Error("has no size", "", "at least 1e-6 m");
  if (!(round >= 0)) throw Error("has a negative 'round'", "", "at least 0");
}

/// Points of a rounded box along one axis: where the centre of the rounding is, and the tangent of
/// the angle by which the normal leans there. The second pair keeps the flat sides flat.
std::vector<Vector2d> box_steps(double half, double round) {
  constexpr int kSteps = kRoundSegments / 2;
  const double edge = half - round;
  const double flat = edge - std::min(round, edge / 2);
  std::vector<Vector2d> steps;
  for (int k = -kSteps; k <= 0; ++k)
    steps.emplace_back(-edge, std::tan(std::numbers::pi / 4 * k / kSteps));
  steps.emplace_back(-flat, 0);
  for (int k = static_cast<int>(steps.size()) - 1; k >= 0; --k) steps.push_back(-steps[k]);
  return steps;
}

/// One of the six sides of a rounded box, with its part of the rounding. Sides share vertices.
void add_rounded_side(Body& body, const Vector3d& half, double round, int axis, double sign,
                      std::map<std::array<long long, 3>, int>& vertices) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const std::vector<Vector2d> us = box_steps(half[u], round), vs = box_steps(half[v], round);
  const double grid = half.maxCoeff() * 1e-9;
  std::vector<int> index;
  for (const Vector2d& p : us)
    for (const Vector2d& q : vs) {
      Vector3d normal, centre;
      normal[axis] = sign, normal[u] = p.y(), normal[v] = q.y();
      centre[axis] = sign * (half[axis] - round), centre[u] = p.x(), centre[v] = q.x();
      const Vector3d x = centre + round * normal.normalized();
      const auto [at, is_new] =
          vertices.emplace(std::array{std::llround(x[0] / grid), std::llround(x[1] / grid),
                                      std::llround(x[2] / grid)},
                           static_cast<int>(body.vertices.size()));
      if (is_new) body.vertices.push_back(x);
      index.push_back(at->second);
    }
  const int rows = static_cast<int>(us.size()), columns = static_cast<int>(vs.size());
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j + 1 < columns; ++j) {
      const int a = index[i * columns + j], b = index[(i + 1) * columns + j],
                c = index[(i + 1) * columns + j + 1], d = index[i * columns + j + 1];
      body.triangles.emplace_back(a, sign > 0 ? b : c, sign > 0 ? c : b);
      body.triangles.emplace_back(a, sign > 0 ? c : d, sign > 0 ? d : c);
    }
}

}  // namespace

TriMesh Body::mesh() const {
  TriMesh out;
  out.V.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  out.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    out.V.row(static_cast<Eigen::Index>(i)) = vertices[i].transpose();
  for (std::size_t i = 0; i < triangles.size(); ++i)
    out.F.row(static_cast<Eigen::Index>(i)) = triangles[i].transpose();
  return out;
}

void append(Body& body, const Body& piece, const Pose& pose) {
  const int first = static_cast<int>(body.vertices.size());
  for (const Vector3d& x : piece.vertices) body.vertices.push_back(pose * x);
  for (const Eigen::Vector3i& t : piece.triangles)
    body.triangles.push_back(t + Eigen::Vector3i::Constant(first));
  for (const Box& box : piece.boxes) body.boxes.push_back({pose * box.pose, box.half});
}

Body box_body(const Vector3d& size, double round) {
  require_body_sizes({size.x(), size.y(), size.z()}, round);
  const Vector3d half = size / 2;
  Body body;
  if (round > 0) {
    if (!(round < half.minCoeff()))
      throw Error("is rounded by half of its smallest side or more", "", "a smaller 'round'");
    std::map<std::array<long long, 3>, int> vertices;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1., 1.}) add_rounded_side(body, half, round, axis, sign, vertices);
  } else {
    const std::array<Vector2d, 4> outline{Vector2d(-half.x(), -half.y()),
                                          {half.x(), -half.y()},
                                          {half.x(), half.y()},
                                          {-half.x(), half.y()}};
    append(body, prism_body(outline, size.z(), 0),
           Pose(Eigen::Translation3d(-half.z() * Vector3d::UnitZ())));
  }
  body.boxes.assign(1, {Pose::Identity(), half});
  return body;
}

Body lathe_body(std::span<const Vector2d> outline) {
  const std::vector<Vector2d> section = cleaned_outline(outline);
  Vector3d half = Vector3d::Zero();
  double low = section[0].y(), high = low;
  for (const Vector2d& p : section) {
    if (p.x() < 0)
      throw Error("is turned about an axis that crosses it", "", "radii of at least 0");
    half.x() = half.y() = std::max(half.x(), p.x());
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  std::vector<SweptStation> stations;
  for (int k = 0; k < kTurnSegments; ++k) {
    const double angle = -2 * std::numbers::pi * k / kTurnSegments;
    stations.push_back(
        {Vector3d::Zero(), {std::cos(angle), std::sin(angle), 0}, Vector3d::UnitZ()});
  }
  Body body;
  add_swept_surface(body, section, stations, true);
  drop_unused_vertices(body);
  half.z() = (high - low) / 2;
  body.boxes.push_back({Pose(Eigen::Translation3d(0, 0, (high + low) / 2)), half});
  return body;
}

Body cylinder_body(double radius, double top_radius, double length, double round) {
  require_body_sizes({length, std::max(radius, top_radius)}, round);
  if (!(std::min(radius, top_radius) >= 0)) throw Error("has a negative radius", "", "at least 0");
  const std::vector<Vector2d> outline = cleaned_outline(std::array<Vector2d, 4>{
      Vector2d(0, -length / 2), {radius, -length / 2}, {top_radius, length / 2}, {0, length / 2}});
  if (!(round > 0)) return lathe_body(outline);
  // Rounded with its mirror image, so that what lies on the axis is no corner.
  std::vector<Vector2d> whole;
  for (const Vector2d& p : outline)
    if (p.x() > 0) whole.push_back(p);
  const std::size_t right = whole.size();
  if (right < 2) throw Error("has a tip that cannot be rounded", "", "round = 0 or two radii");
  for (std::size_t i = right; i-- > 0;) whole.emplace_back(-whole[i].x(), whole[i].y());
  std::vector<Vector2d> half{{0, -length / 2}};
  for (const Vector2d& p : rounded_outline(whole, round))
    if (p.x() > 0) half.push_back(p);
  half.emplace_back(0, length / 2);
  return lathe_body(half);
}

Body sphere_body(double radius) {
  require_body_sizes({radius}, 0);
  std::vector<Vector2d> outline;
  constexpr int kHalf = kTurnSegments / 2;
  for (int k = 0; k <= kHalf; ++k) {
    const double angle = std::numbers::pi * (static_cast<double>(k) / kHalf - 0.5);
    const bool is_pole = k == 0 || k == kHalf;
    outline.emplace_back(is_pole ? 0 : radius * std::cos(angle), radius * std::sin(angle));
  }
  return lathe_body(outline);
}

Body prism_body(std::span<const Vector2d> outline, double height, double round) {
  require_body_sizes({height}, round);
  const std::vector<Vector2d> section = rounded_outline(cleaned_outline(outline), round);
  const std::vector<SweptStation> stations{
      {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()},
      {height * Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()}};
  Body body;
  add_swept_caps(body, section, stations[0], stations[1]);
  add_swept_surface(body, section, stations, false);
  body.boxes.push_back(body_box_around(body.vertices, Eigen::Matrix3d::Identity()));
  return body;
}

Body channel_body(std::span<const Vector3d> points, const SweptShape& shape) {
  require_body_sizes({shape.width, shape.height, shape.wall}, shape.round);
  const double inner = shape.width / 2, outer = inner + shape.wall;
  std::vector<Vector2d> section{
      {-outer, shape.height}, {-outer, -shape.wall}, {outer, -shape.wall}, {outer, shape.height}};
  // A groove that is not as deep as half its width is flatter than round.
  const double bottom = std::min(inner, shape.height);
  if (bottom < shape.height) section.emplace_back(inner, shape.height);
  for (int k = 0; k <= kGrooveSegments; ++k) {
    const double angle = -std::numbers::pi * k / kGrooveSegments;
    section.emplace_back(inner * std::cos(angle), bottom * (1 + std::sin(angle)));
  }
  if (bottom < shape.height) section.emplace_back(-inner, shape.height);
  section = rounded_outline(section, shape.round);
  for (Vector2d& p : section) p.x() += shape.offset;
  return swept_body(section, points);
}

Body rail_body(std::span<const Vector3d> points, const SweptShape& shape) {
  require_body_sizes({shape.width, shape.height}, shape.round);
  const double half = shape.width / 2;
  std::vector<Vector2d> section = rounded_outline(
      {{-half, 0}, {half, 0}, {half, shape.height}, {-half, shape.height}}, shape.round);
  for (Vector2d& p : section) p.x() += shape.offset;
  return swept_body(section, points);
}

}  // namespace geoprior::assembly
