#include "models/embryo/surface/field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"
#include "models/embryo/shape/curve.h"
#include "models/embryo/shape/smooth_minimum.h"
#include "tests/embryo/surface/samples.h"

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> scattered_points(int count, double reach) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  std::vector<Vector3d> out(count);
  for (Vector3d& p : out) p = {uniform(engine), uniform(engine), uniform(engine)};
  return out;
}

SolidField field_of(const Shape& shape) { return {{{0, shape, {}}}, 0}; }

/// Independent of spans' pieces and of Newton's steps: the least over 40 000 balls on the line.
double dense_duct_distance(const Shape& duct, const Vector3d& x) {
  const Curve curve(duct.points);
  double least = std::numeric_limits<double>::infinity();
  for (int s = 0; s < static_cast<int>(curve.spans().size()); ++s)
    for (int k = 0; k <= 2000; ++k) {
      const double t = k / 2000.0;
      const double radius = duct.radius + curve.fraction_at(s, t) * (duct.end_radius - duct.radius);
      least = std::min(least, (x - curve.spans()[s].at(t)).norm() - radius);
    }
  return least;
}

TEST(EmbryoField, OfABallAndARoundCylinderIsTheDistance) {
  const Shape ball = samples::ovoid({1, 0, 0}, {2, 2, 2});
  const Shape rod = samples::cylinder({0, 0, 0}, 0.5, 4);
  for (const Vector3d& x : scattered_points(200, 4)) {
    EXPECT_NEAR(ovoid_field(ball, x), (x - ball.center).norm() - 2, 1e-14);
    const double over = std::max(std::abs(x.z()) - 1.5, 0.0);
    EXPECT_NEAR(cylinder_field(rod, x), std::hypot(std::hypot(x.x(), x.y()), over) - 0.5, 1e-14);
  }
}

// 2000 balls a span of length 1 are 5e-4 apart: of the least distance they miss less than 1e-6. The
// rest, 3e-4 of the radius, is between the ends of pieces, where the radius is linear in t.
TEST(EmbryoField, OfADuctIsTheLeastDistanceFromItsBalls) {
  const Shape bent = samples::bent_duct();
  const SolidField field = field_of(bent);
  for (const Vector3d& x : scattered_points(60, 1.5)) {
    const Vector3d at = x + Vector3d(0.3, 0.4, 1.6);
    EXPECT_NEAR(field.value(at), dense_duct_distance(bent, at), 3e-5) << at.transpose();
  }
}

TEST(EmbryoField, OfATwoPointDuctIsThatOfTheCylinder) {
  const Shape rod = samples::cylinder({0, 0, 0}, 0.5, 4);
  const SolidField field = field_of(samples::duct({{0, 0, -1.5}, {0, 0, 1.5}}, 0.5));
  for (const Vector3d& x : scattered_points(200, 3))
    EXPECT_NEAR(field.value(x), cylinder_field(rod, x), 1e-13);
}

/// All kinds of members: an egg, a cut ovoid, a cylinder and two ducts, blended.
SolidField mixed_field() {
  const Shape cut = samples::ovoid({0, 1, 0}, {0.4, 0.7, 0.8});
  Septum septum;
  septum.point = cut.center;
  septum.thickness = 0.1;
  return {
      {{0, samples::turned(samples::ovoid({0.8, 0, 0.5}, {0.3, 0.5, 0.9}, -0.4), 1, {1, 2, 3}), {}},
       {1, cut, septum},
       {2, samples::bent_duct(), {}},
       {3, samples::turned(samples::cylinder({-0.5, 0, 1}, 0.2, 1.5), 1, {1, 0, 1}), {}},
       {4, samples::duct({{-1, -1, -1}, {0, -1, 0.3}, {1, 1, 1}}, 0.15, 0.05), {}}},
      0.15};
}

TEST(EmbryoField, ChangesByNoMoreThanItsBound) {
  const SolidField field = mixed_field();
  const std::vector<Vector3d> from = scattered_points(3000, 2);
  double most = 0;
  for (std::size_t i = 1; i < from.size(); ++i)
    for (const double step : {1.0, 0.1, 0.001}) {
      const Vector3d d = step * (from[i - 1] - from[i]);
      const double change = std::abs(field.value(from[i] + d) - field.value(from[i]));
      ASSERT_LE(change, field.change(d) + 1e-13) << from[i].transpose();
      most = std::max(most, change / field.change(d));
    }
  EXPECT_GT(most, 0.5) << "the bound is near what it bounds";
}

TEST(EmbryoField, AnEggChangesByNoMoreThanItsBound) {
  for (const double egg : {-0.5, 0.5}) {
    const SolidField field = field_of(samples::ovoid({0, 0, 0}, {0.4, 0.7, 1}, egg));
    const std::vector<Vector3d> from = scattered_points(3000, 3);
    for (std::size_t i = 1; i < from.size(); ++i) {
      const Vector3d d = 0.01 * (from[i - 1] - from[i]);
      ASSERT_LE(std::abs(field.value(from[i] + d) - field.value(from[i])), field.change(d));
    }
  }
}

// The short cut of the fast kernel against the formula over all pieces.
TEST(EmbryoField, OfTheNearPiecesIsThatOfAllPiecesBitForBit) {
  const SolidField field = mixed_field();
  SolidField::Near near, nearer;
  std::size_t kept = 0, tried = 0;
  for (const Vector3d& center : scattered_points(150, 1.5)) {
    field.narrow(field.all_pieces(), center, 0.4, near);
    field.narrow(near, center, 0.1, nearer);
    kept += nearer.size();
    tried += field.all_pieces().size();
    for (const Vector3d& d : scattered_points(20, 0.1 / std::sqrt(3)))
      ASSERT_EQ(field.value(center + d, nearer), field.value(center + d));
  }
  EXPECT_LT(2 * kept, tried) << "pieces are left out";
}

TEST(EmbryoField, SupportsReachWhereTheSolidEnds) {
  const SolidField field = mixed_field();
  for (const Vector3d& x : scattered_points(5000, 3)) {
    if (field.value(x) > 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(x[axis], field.support(Vector3d::Unit(axis)));
      EXPECT_GE(x[axis], -field.support(-Vector3d::Unit(axis)));
    }
  }
  const SolidField rod = field_of(samples::cylinder({1, 0, 0}, 0.5, 4));
  EXPECT_NEAR(rod.support(Vector3d::UnitZ()), 2, 1e-14);
}

/// Within k of the bound the slope falls from 1 to 0; the largest loss, k/4, is at the bound.
TEST(EmbryoField, SmoothMinimumIsExactAwayAndContinuouslyDifferentiable) {
  EXPECT_EQ(smooth_minimum(0.5, 1, 0.5), 0.5);
  EXPECT_EQ(smooth_minimum(1, 2, 0.5), 1);
  EXPECT_EQ(smooth_minimum(1, 1.1, 0), 1);
  EXPECT_DOUBLE_EQ(smooth_minimum(1, 1, 0.5), 1 - 0.125);
  EXPECT_EQ(smooth_minimum(1.5, 1, 0.5), 1);
  EXPECT_EQ(smooth_minimum(2, 2, 0.4), 1.9);
  EXPECT_EQ(smooth_minimum(1.2, 1, 0), 1);
  EXPECT_EQ(smooth_maximum(2, 2, 0.4), 2.1);
  const double h = 1e-6;
  // One-sided slopes at the end of the blend: both 1.
  EXPECT_NEAR((smooth_minimum(1.5 + h, 2, 0.5) - smooth_minimum(1.5, 2, 0.5)) / h, 1, 1e-5);
  for (double value = 0; value < 2; value += 0.05) {
    EXPECT_LE(smooth_minimum(value, 1, 0.5), 1);
    const double at = smooth_minimum(value, 1, 0.5);
    const double before = (at - smooth_minimum(value - h, 1, 0.5)) / h;
    const double after = (smooth_minimum(value + h, 1, 0.5) - at) / h;
    EXPECT_NEAR(before, after, 2.1 * h);
  }
}

TEST(EmbryoField, ASeptumOpensASlotOfItsThicknessUpToItsTip) {
  const DayState day = samples::divided_ovoid(0.5);  // the tip is at the centre
  Septum septum{{0, 1, 0}, day.cuts[0].point, {0, 0, -1}, day.cuts[0].tip, 0.1, 0};
  const SolidField field({{0, day.structures[0].shape, septum}}, 0);
  const Vector3d center = day.structures[0].shape.center;
  EXPECT_GT(field.value(center + Vector3d(0, 0.04, 0.4)), 0) << "in the slot";
  EXPECT_LT(field.value(center + Vector3d(0, 0.06, 0.4)), 0) << "beside it";
  EXPECT_LT(field.value(center + Vector3d(0, 0, -0.1)), 0) << "below the tip";
}

TEST(EmbryoField, RefusesWhatBoundsNoSolid) {
  Shape plane;
  plane.primitive = Primitive::plane;
  EXPECT_THROW(field_of(plane), Error);
  EXPECT_THROW(field_of(samples::ovoid({0, 0, 0}, {1, 0, 1})), Error);
  EXPECT_THROW(field_of(samples::ovoid({0, 0, 0}, {1, 1, 1}, 0.6)), Error);
  EXPECT_THROW(field_of(samples::duct({}, 1)), Error);
  EXPECT_THROW(SolidField({}, 0), Error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(field_of(samples::ovoid({nan, 0, 0}, {1, 1, 1})), Error);
  try {
    SolidField({{17, samples::cylinder({0, 0, 0}, -1, 2), {}}}, 0);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("structure 17"));
  }
}

}  // namespace
}  // namespace geoprior::embryo
