#include <cmath>

#include "core/angles.h"
#include "core/error.h"
#include "core/random.h"
#include "models/grammar/maps/gesture.h"

namespace geoprior::grammar {
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
