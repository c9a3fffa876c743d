#include "models/embryo/shape/curve.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

const std::vector<Vector3d>& bent_points() {
  static const std::vector<Vector3d> points = {
      {0, 0, 0}, {1, 0.5, 0}, {1.5, 2, 0.3}, {1.2, 2.4, 1}, {0, 3, 4}};
  return points;
}

TEST(EmbryoCurve, PassesItsControlPointsWithOneTangentOnBothSides) {
  const Curve curve(bent_points());
  ASSERT_EQ(curve.spans().size(), 4u);
  for (int s = 0; s < 4; ++s) {
    EXPECT_LT((curve.spans()[s].at(0) - bent_points()[s]).norm(), 1e-15);
    EXPECT_LT((curve.spans()[s].at(1) - bent_points()[s + 1]).norm(), 1e-14);
  }
  for (int s = 0; s < 3; ++s) {
    const Vector3d in = curve.spans()[s].derivative(1).normalized(),
                   out = curve.spans()[s + 1].derivative(0).normalized();
    EXPECT_LT((in - out).norm(), 1e-14) << "span " << s;
  }
}

TEST(EmbryoCurve, TwoPointsAreAStraightLineAtConstantSpeed) {
  const std::vector<Vector3d> ends = {{1, 2, 3}, {4, 6, 3}};
  const Curve curve(ends);
  EXPECT_NEAR(curve.length(), 5, 1e-14);
  EXPECT_LT((curve.at_fraction(0.25) - Vector3d(1.75, 3, 3)).norm(), 1e-14);
  EXPECT_LT((curve.at_fraction(7) - ends[1]).norm(), 1e-14) << "fractions are clamped";
}

// Independent: a poly-line of 4000 pieces a span is 1e-8 of the length too short.
TEST(EmbryoCurve, FractionsAreThoseOfTheArc) {
  const Curve curve(bent_points());
  const std::vector<Vector3d> fine = curve.polyline(4000);
  double length = 0;
  for (std::size_t i = 1; i < fine.size(); ++i) length += (fine[i] - fine[i - 1]).norm();
  EXPECT_NEAR(curve.length(), length, 1e-6 * length);
  double arc = 0;
  for (int i = 1; i < static_cast<int>(fine.size()); ++i) {
    arc += (fine[i] - fine[i - 1]).norm();
    if (i % 1700 != 0) continue;
    EXPECT_LT((curve.at_fraction(arc / length) - fine[i]).norm(), 1e-6 * length);
    EXPECT_NEAR(curve.fraction_at(i / 4000, i % 4000 / 4000.0), arc / length, 1e-7);
  }
}

// Among points at equal steps the middle of a span is (9 (P1 + P2) - P0 - P3) / 16.
TEST(EmbryoCurve, BetweenPointsOfACircleLiesWhereCatmullAndRomPutIt) {
  const double step = std::numbers::pi / 8;
  std::vector<Vector3d> points;
  for (int k = 0; k <= 16; ++k) points.emplace_back(std::cos(k * step), std::sin(k * step), 0);
  const Curve curve(points);
  const double radius = (9 * std::cos(step / 2) - std::cos(1.5 * step)) / 8;
  for (int s = 1; s < 15; ++s) EXPECT_NEAR(curve.spans()[s].at(0.5).norm(), radius, 1e-14);
}

TEST(EmbryoCurve, AMirroredCurveIsTheMirrorImageBitForBit) {
  std::vector<Vector3d> mirrored = bent_points();
  for (Vector3d& p : mirrored) p.x() = -p.x();
  const std::vector<Vector3d> a = Curve(bent_points()).polyline(7), b = Curve(mirrored).polyline(7);
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(Vector3d(-a[i].x(), a[i].y(), a[i].z()), b[i]);
}

TEST(EmbryoCurve, RepeatedPointsAreOneAndOnePointIsACurveOfNoLength) {
  const std::vector<Vector3d> repeated = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(Curve(repeated).spans().size(), 1u);
  const std::vector<Vector3d> one = {{3, 2, 1}};
  EXPECT_EQ(Curve(one).length(), 0);
  EXPECT_EQ(Curve(one).at_fraction(0.5), one[0]);
  EXPECT_THROW(Curve(std::vector<Vector3d>{}), Error);
  const std::vector<Vector3d> bad = {{0, 0, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_THROW(Curve{bad}, Error);
}

}  // namespace
}  // namespace geoprior::embryo
