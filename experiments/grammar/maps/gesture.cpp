#include "experiments/grammar/maps/gesture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/error.h"
#include "core/random.h"
#include "experiments/grammar/maps/cage.h"
#include "experiments/grammar/maps/lattice.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

/// Where a tool's effect is half of what it is in the middle, over its radius.
constexpr double kHalfway = 0.314;
/// Points of a full circle that is drawn, and of the other curves.
constexpr int kCirclePoints = 48;
constexpr int kCurvePoints = 24;
/// Length of an arrow head's sides in radii of the tool.
constexpr double kArrowHead = 0.12;
/// Distance from the tool, in radii, of the arrows that show a twist or an inflation.
constexpr double kShownAt = 0.4;

void require_valid_strokes(const Gesture& gesture) {
  for (std::size_t i = 0; i < gesture.strokes.size(); ++i)
    require_valid(gesture.strokes[i], "strokes[" + std::to_string(i) + "]");
}

/// What is no cage, its map refuses.
void require_valid_gesture(const Gesture& gesture) {
  require_valid_strokes(gesture);
  if (gesture.lattice) require_valid(*gesture.lattice, "gesture");
  if (gesture.cage) CageMap(*gesture.cage, 1);
}

void append_line(DrawnGesture& out, const std::vector<Vector3d>& points) {
  std::vector<int>& line = out.lines.emplace_back();
  for (const Vector3d& x : points) {
    line.push_back(static_cast<int>(out.points.size()));
    out.points.push_back(x);
  }
}

/// Two sides at the end of a line, in the plane of its end and `beside`.
void append_arrow_head(DrawnGesture& out, const std::vector<Vector3d>& line, double size,
                       const Vector3d& beside) {
  const Vector3d end = line.back();
  Vector3d back = Vector3d::Zero();
  for (auto x = line.rbegin(); x != line.rend() && back.norm() < size; ++x) back = *x - end;
  if (back.norm() == 0) return;
  back.normalize();
  Vector3d side = beside - beside.dot(back) * back;
  if (side.norm() < 1e-3 * beside.norm()) side = back.unitOrthogonal();
  side.normalize();
  append_line(out, {end + size * (back + 0.5 * side), end, end + size * (back - 0.5 * side)});
}

/// Part of a circle about `centre`, from its point `from`.
std::vector<Vector3d> arc_points(const Vector3d& centre, const Vector3d& from, const Vector3d& axis,
                                 double angle, int count) {
  std::vector<Vector3d> out;
  for (int i = 0; i <= count; ++i)
    out.push_back(centre + Eigen::AngleAxisd(angle * i / count, axis) * (from - centre));
  return out;
}

/// The line along a bend through the tool, as the whole stroke bends it.
std::vector<Vector3d> bent_line(const Stroke& stroke) {
  std::vector<Dab> dabs;
  append_dabs(stroke, 1, dabs);
  const Vector3d along = dabs.front().along;
  const StrokeMap map(std::move(dabs));
  std::vector<Vector3d> out;
  for (int i = -kCurvePoints; i <= kCurvePoints; ++i)
    out.push_back(map.at(stroke.path.front() + stroke.radius * i / kCurvePoints * along));
  return out;
}

/// What a tool does that no path shows: the arc of a twist, the line of a bend, the arrows out of
/// or into an inflation.
void draw_effect(const Stroke& stroke, const Vector3d& axis, DrawnGesture& out) {
  const Vector3d centre = stroke.path.front(), side = axis.unitOrthogonal();
  const double head = kArrowHead * stroke.radius;
  if (stroke.kind == Stroke::Kind::twist) {
    const std::vector<Vector3d> arc = arc_points(centre, centre + kShownAt * stroke.radius * side,
                                                 axis, stroke.amount, kCurvePoints);
    append_line(out, arc);
    append_arrow_head(out, arc, head, side);
  } else if (stroke.kind == Stroke::Kind::bend) {
    const std::vector<Vector3d> line = bent_line(stroke);
    append_line(out, line);
    append_arrow_head(out, line, head, axis.cross(line.back() - line.front()));
  } else if (stroke.kind == Stroke::Kind::inflate) {
    for (int i = 0; i < 4; ++i) {
      const Vector3d out_of = Eigen::AngleAxisd(kFullTurn * i / 4, axis) * side;
      const double near = kShownAt * stroke.radius;
      const double far = near * (1 + stroke.amount);
      const std::vector<Vector3d> arrow{centre + near * out_of, centre + far * out_of};
      append_line(out, arrow);
      append_arrow_head(out, arrow, head, axis.cross(out_of));
    }
  }
}

void draw_stroke(const Stroke& stroke, DrawnGesture& out) {
  const Vector3d start = stroke.path.front();
  const bool grabs = stroke.kind == Stroke::Kind::grab;
  Vector3d axis = grabs ? stroke.path.back() - start : stroke.axis;
  if (axis.norm() == 0) axis = Vector3d::UnitZ();
  axis.normalize();
  append_line(out, arc_points(start, start + kHalfway * stroke.radius * axis.unitOrthogonal(), axis,
                              kFullTurn, kCirclePoints));
  if (stroke.path.size() > 1) {
    append_line(out, stroke.path);
    append_arrow_head(out, stroke.path, kArrowHead * stroke.radius, Vector3d::UnitZ());
  }
  draw_effect(stroke, axis, out);
}

/// The lines of control points along the axes, where they go.
void draw_lattice(const Lattice& lattice, DrawnGesture& out) {
  const Eigen::Vector3i n = Eigen::Vector3i::Map(lattice.points.data());
  const Eigen::Vector3i stride(1, n.x(), n.x() * n.y());
  const auto moved = [&](const Eigen::Vector3i& i) -> Vector3d {
    const Vector3d u = i.cast<double>().cwiseQuotient((n.array() - 1).matrix().cast<double>());
    return lattice.low + u.cwiseProduct(lattice.high - lattice.low) + lattice.shifts[i.dot(stride)];
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    Eigen::Vector3i i = Eigen::Vector3i::Zero();
    for (i[third] = 0; i[third] < n[third]; ++i[third]) {
      for (i[second] = 0; i[second] < n[second]; ++i[second]) {
        std::vector<Vector3d> line;
        for (i[axis] = 0; i[axis] < n[axis]; ++i[axis]) line.push_back(moved(i));
        append_line(out, line);
      }
    }
  }
}

void draw_cage(const Cage& cage, DrawnGesture& out) {
  const EdgeConnectivity edges(cage.rest.F);
  for (const Edge& edge : edges.edges())
    append_line(out, {cage.moved.row(edge[0]), cage.moved.row(edge[1])});
}

}  // namespace

std::vector<Dab> dabs_of(const Gesture& gesture, double fraction) {
  require_valid_strokes(gesture);
  if (!(fraction >= 0 && fraction <= 1))
    throw Error("is asked for a fraction of " + std::to_string(fraction), "gesture", "0 to 1");
  std::vector<Dab> dabs;
  const double strokes = static_cast<double>(gesture.strokes.size());
  for (std::size_t i = 0; i < gesture.strokes.size(); ++i)
    append_dabs(gesture.strokes[i],
                std::clamp(fraction * strokes - static_cast<double>(i), 0.0, 1.0), dabs);
  return dabs;
}

std::shared_ptr<const SpatialMap> map_of(const Gesture& gesture, double fraction) {
  require_valid_gesture(gesture);
  std::vector<Dab> dabs = dabs_of(gesture, fraction);
  std::shared_ptr<const SpatialMap> map;
  const auto then = [&](std::shared_ptr<const SpatialMap> next) {
    map = map ? std::make_shared<ComposedMap>(map, std::move(next)) : std::move(next);
  };
  if (!dabs.empty()) then(std::make_shared<StrokeMap>(std::move(dabs)));
  if (gesture.lattice && fraction > 0)
    then(std::make_shared<LatticeMap>(*gesture.lattice, fraction));
  if (gesture.cage && fraction > 0) then(std::make_shared<CageMap>(*gesture.cage, fraction));
  if (!map) map = std::make_shared<StrokeMap>(std::vector<Dab>{});
  return map;
}

DrawnGesture drawn(const Gesture& gesture) {
  require_valid_gesture(gesture);
  DrawnGesture out;
  for (const Stroke& stroke : gesture.strokes) draw_stroke(stroke, out);
  if (gesture.lattice) draw_lattice(*gesture.lattice, out);
  if (gesture.cage) draw_cage(*gesture.cage, out);
  return out;
}

namespace {

using Eigen::Vector3d;

/// Part of the box, about its middle, that tools are put into.
constexpr double kToolBox = 0.9;
/// Shares of axes that are upright, or horizontal; the rest has any direction.
constexpr double kUprightAxes = 0.4, kHorizontalAxes = 0.4;

double drawn_between(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// Uniform on the sphere (Archimedes).
Vector3d drawn_direction(RandomStream& random) {
  const double z = drawn_between(random, -1, 1), turn = kFullTurn * random.uniform();
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

Vector3d drawn_horizontal(RandomStream& random) {
  const double turn = kFullTurn * random.uniform();
  return {std::cos(turn), std::sin(turn), 0};
}

/// The axis of a twist or a bend, and a direction across it: the upright one for a horizontal axis,
/// about which things lean.
void draw_axes(RandomStream& random, Stroke& stroke) {
  const double kind = random.uniform();
  if (kind < kUprightAxes) {
    stroke.axis = Vector3d::UnitZ();
    stroke.along = drawn_horizontal(random);
  } else if (kind < kUprightAxes + kHorizontalAxes) {
    stroke.axis = drawn_horizontal(random);
    stroke.along = Vector3d::UnitZ();
  } else {
    stroke.axis = drawn_direction(random);
    const Vector3d side = stroke.axis.unitOrthogonal();
    stroke.along = Eigen::AngleAxisd(kFullTurn * random.uniform(), stroke.axis) * side;
  }
}

}  // namespace

Gesture random_gesture(std::uint64_t seed, int number, const Eigen::AlignedBox3d& box) {
  if (box.isEmpty() || !(box.diagonal().norm() > 0))
    throw Error("is a box without extent", "random gesture", "one of a positive diagonal");
  RandomStream random(seed ^ fnv1a("gesture"), static_cast<std::uint64_t>(number));
  const double diagonal = box.diagonal().norm();
  Stroke stroke;
  stroke.kind = static_cast<Stroke::Kind>(random.below(4));
  Vector3d place;
  for (double& x : place) x = drawn_between(random, -kToolBox / 2, kToolBox / 2);
  const Vector3d centre = box.center() + place.cwiseProduct(box.sizes());
  stroke.path = {centre};
  stroke.radius = drawn_between(random, 0.5, 1.2) * diagonal;
  switch (stroke.kind) {
    case Stroke::Kind::grab: {
      const double length = drawn_between(random, 0.08, 0.3) * diagonal;
      stroke.path.push_back(centre + length * drawn_direction(random));
      break;
    }
    case Stroke::Kind::inflate:
      stroke.amount = drawn_between(random, -0.25, 0.4);
      break;
    case Stroke::Kind::twist:
    case Stroke::Kind::bend:
      draw_axes(random, stroke);
      stroke.amount = drawn_between(random, -0.9, 0.9);
      break;
  }
  return {{stroke}, {}, {}};
}

}  // namespace geoprior::grammar
