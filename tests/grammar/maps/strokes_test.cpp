// Strokes of sculpting tools, by closed forms at the tool and by what holds everywhere.

#include "models/grammar/maps/strokes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/grammar/maps/sampled_map.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geoprior::test::expect_error;
using Kind = Stroke::Kind;

const Vector3d kTool{0.3, -0.2, 4};

/// One stroke of each kind, of amounts that take several dabs where the kind does.
std::vector<Stroke> strokes_of_all_kinds() {
  return {{.kind = Kind::grab, .path = {kTool, {1.5, 0, 4.5}, {2, 1, 5}}, .radius = 4},
          {.kind = Kind::inflate, .path = {kTool}, .radius = 4, .amount = 1},
          {.kind = Kind::inflate, .path = {kTool, {1, 1, 5}}, .radius = 4, .amount = -0.6},
          {.kind = Kind::twist, .path = {kTool}, .radius = 4, .axis = {1, 2, 3}, .amount = 2},
          {.kind = Kind::bend,
           .path = {kTool},
           .radius = 4,
           .axis = {0, 1, 0},
           .along = {0.2, 0.5, 1},
           .amount = 1.2}};
}

StrokeMap map_of_stroke(const Stroke& stroke, double fraction = 1) {
  require_valid(stroke, "stroke");
  std::vector<Dab> dabs;
  append_dabs(stroke, fraction, dabs);
  return StrokeMap(std::move(dabs));
}

TEST(GrammarStrokes, FalloffIsOneAtTheToolAndFlatAtBothEnds) {
  EXPECT_EQ(falloff(0), 1);
  EXPECT_EQ(falloff(1), 0);
  constexpr double kStep = 1e-4;
  EXPECT_NEAR((falloff(kStep) - falloff(0)) / kStep, 0, 11 * kStep);  // w'' = -20 at the tool
  EXPECT_NEAR((falloff(1) - falloff(1 - kStep)) / kStep, 0, 1e-10);
  double steepest = 0;
  for (double s = kStep; s < 1; s += kStep)
    steepest = std::max(steepest, (falloff(s - kStep) - falloff(s)) / kStep);
  EXPECT_NEAR(steepest, 20 * 0.25 * 0.421875, 1e-6);  // at 1/4
}

TEST(GrammarStrokes, JacobianIsTheDerivative) {
  const std::vector<Vector3d> points = samples::points_in(samples::kSampledBox, 400, 1);
  for (const Stroke& stroke : strokes_of_all_kinds())
    EXPECT_LT(samples::jacobian_error(map_of_stroke(stroke), points), 1e-7);
}

TEST(GrammarStrokes, IdentityBitForBitOutsideTheSupport) {
  const Eigen::AlignedBox3d wide(Vector3d(-9, -9, -6), Vector3d(9, 9, 14));
  for (const Stroke& stroke : strokes_of_all_kinds()) {
    const StrokeMap map = map_of_stroke(stroke);
    int outside = 0;
    for (const Vector3d& x : samples::points_in(wide, 1000, 2)) {
      if (map.support()->contains(x)) continue;
      ++outside;
      EXPECT_EQ(map.at(x), x);
      EXPECT_EQ(map.with_jacobian(x).jacobian, Matrix3d::Identity());
    }
    EXPECT_GT(outside, 400);
  }
}

TEST(GrammarStrokes, SupportHoldsWhatRoundingPutsIntoTheBall) {
  const StrokeMap map = map_of_stroke({.path = {{1e6, 0, 0}, {1e6, 0.1, 0}}, .radius = 1});
  double x = 1e6 + 1;
  for (int i = 0; i < 20000; ++i, x = std::nextafter(x, 2e6)) {
    const Vector3d point(x, 0, 0);
    if (map.support()->contains(point)) continue;
    EXPECT_EQ(map.at(point), point);
  }
}

TEST(GrammarStrokes, NeverTurnsSpaceInsideOut) {
  const std::vector<Vector3d> points = samples::points_in(samples::kSampledBox, 2000, 3);
  for (const Stroke& stroke : strokes_of_all_kinds())
    EXPECT_GT(samples::least_determinant(map_of_stroke(stroke), points), 0.01);
}

/// The bounds of the header, by kind: 1 - 0.2 * 2.11, e^-1.2, 1 and 1 - 0.3.
TEST(GrammarStrokes, DabsKeepTheirDistanceFromAFold) {
  const std::array<double, 4> least{0.578, 0.301, 1 - 1e-12, 0.7 - 1e-12};
  for (const Stroke& stroke : strokes_of_all_kinds()) {
    std::vector<Dab> dabs;
    append_dabs(stroke, 1, dabs);
    for (const Dab& dab : dabs)
      EXPECT_GT(samples::least_determinant(StrokeMap({dab}),
                                           samples::points_in(samples::kSampledBox, 2000, 4)),
                least[static_cast<std::size_t>(stroke.kind)]);
  }
}

TEST(GrammarStrokes, GrabCarriesWhatIsUnderTheToolAlongThePath) {
  const Stroke stroke = strokes_of_all_kinds()[0];
  EXPECT_LT((map_of_stroke(stroke).at(kTool) - stroke.path.back()).norm(), 1e-14);
  const Vector3d halfway = map_of_stroke(stroke, 0.5).at(kTool);
  const Vector3d corner = stroke.path[1];
  EXPECT_LT(std::min((halfway - corner).norm(), (halfway - kTool).norm()), 1.5);
}

TEST(GrammarStrokes, InflationStretchesByItsStrainAtTheTool) {
  const Matrix3d J = map_of_stroke(strokes_of_all_kinds()[1]).with_jacobian(kTool).jacobian;
  EXPECT_LT((J - 2 * Matrix3d::Identity()).norm(), 1e-12);
}

TEST(GrammarStrokes, TwistTurnsByItsAmountAtTheToolAndKeepsVolume) {
  const Stroke stroke = strokes_of_all_kinds()[3];
  const StrokeMap map = map_of_stroke(stroke);
  const Eigen::AngleAxisd turn(2, stroke.axis.normalized());
  EXPECT_LT((map.with_jacobian(kTool).jacobian - turn.toRotationMatrix()).norm(), 1e-12);
  for (const Vector3d& x : samples::points_in(samples::kSampledBox, 500, 5)) {
    EXPECT_NEAR(map.with_jacobian(x).jacobian.determinant(), 1, 1e-12);
    EXPECT_NEAR((map.at(x) - kTool).norm(), (x - kTool).norm(), 1e-13);
  }
}

/// Both sides of a bend of one dab turn the same way from the line along it, at most by its amount.
TEST(GrammarStrokes, BendTurnsBothSidesByAtMostItsAmount) {
  const StrokeMap map = map_of_stroke({.kind = Kind::bend,
                                       .path = {{0, 0, 0}},
                                       .radius = 1,
                                       .axis = {0, 1, 0},
                                       .along = {0, 0, 1},
                                       .amount = 0.25});
  double above = 0, below = 0;
  for (double z = 0.005; z < 1; z += 0.005) {
    const Vector3d up = map.at({0, 0, z}), down = map.at({0, 0, -z});
    above = std::max(above, std::atan2(up.x(), up.z()));
    below = std::max(below, std::atan2(down.x(), -down.z()));
  }
  EXPECT_NEAR(above, 0.25, 1e-4);
  EXPECT_NEAR(below, 0.25, 1e-4);
}

TEST(GrammarStrokes, MovesOnContinuouslyWithItsFraction) {
  constexpr double kStep = 1e-6;
  const std::vector<Vector3d> points = samples::points_in(samples::kSampledBox, 30, 6);
  for (const Stroke& stroke : strokes_of_all_kinds()) {
    for (double f = 0; f + kStep <= 1; f += 0.0099999) {
      const StrokeMap before = map_of_stroke(stroke, f), after = map_of_stroke(stroke, f + kStep);
      for (const Vector3d& x : points) EXPECT_LT((after.at(x) - before.at(x)).norm(), 30 * kStep);
    }
  }
}

TEST(GrammarStrokes, RefusesWhatIsNoStroke) {
  const auto refuses = [](const Stroke& stroke, const std::string& part) {
    expect_error([&] { require_valid(stroke, "stroke 7"); }, {"stroke 7", part});
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  refuses({.path = {kTool}}, "path of 1 points");
  refuses({.kind = Kind::twist, .path = {}}, "path of 0 points");
  refuses({.path = {kTool, {kNan, 0, 0}}}, "not finite");
  refuses({.path = {kTool, {1, 0, 0}}, .radius = 0}, "radius");
  refuses({.path = {kTool, {1, 0, 0}}, .radius = kNan}, "radius");
  refuses({.path = {kTool, {1, 0, 0}}, .radius = 1e-9}, "dabs of a stroke");
  refuses({.kind = Kind::inflate, .path = {kTool}, .amount = -1}, "strain");
  refuses({.kind = Kind::twist, .path = {kTool}, .axis = {0, 0, 0}}, "axis");
  refuses({.kind = Kind::bend, .path = {kTool}, .axis = {0, 0, 2}, .along = {0, 0, -1}}, "along");
}

}  // namespace
}  // namespace geoprior::grammar
