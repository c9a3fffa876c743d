#include "metrics/isometry/circular_arc.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "metrics/spacing/rim_cover.h"

namespace geoprior {
namespace {

Eigen::MatrixX3d arc_points(double radius, double from, double to, int count, double x = 0) {
  Eigen::MatrixX3d points(count, 3);
  for (int i = 0; i < count; ++i) {
    const double s = from + (to - from) * i / (count - 1);
    points.row(i) << x, radius * std::cos(s), radius * std::sin(s);
  }
  return points;
}

// The same circle drawn the other way about has the same axis; a tilt of 0.2 rad is told, and a
// radius of 2.1 for 2.
TEST(ArcDifference, TellsRadiusAndAxisWithoutSense) {
  const CircularArc truth = circular_arc(arc_points(2, 0, 2, 21));
  const CircularArc back = circular_arc(arc_points(2, 2, 0, 21, 5));
  EXPECT_NEAR(arc_difference(back, truth).axis, 0, 1e-9);
  EXPECT_NEAR(arc_difference(back, truth).radius, 0, 1e-9);
  Eigen::MatrixX3d tilted = arc_points(2.1, 0, 2, 21);
  for (int i = 0; i < 21; ++i) {
    const double y = tilted(i, 1);
    tilted.row(i).head<2>() << -std::sin(0.2) * y, std::cos(0.2) * y;
  }
  EXPECT_NEAR(arc_difference(circular_arc(tilted), truth).axis, 0.2, 1e-9);
  EXPECT_NEAR(arc_difference(circular_arc(tilted), truth).radius, 0.05, 1e-9);
}

// r times the angle, also beyond half a turn; a sum over the chords would be 0.4 % short.
TEST(CircularArc, HasTheLengthOfTheArcAndNotOfItsChords) {
  for (const double angle : {0.01, 1.0, 3.0, 5.5}) {
    const CircularArc arc = circular_arc(arc_points(2, 0.3, 0.3 + angle, 21));
    EXPECT_NEAR(arc.length, 2 * angle, 1e-10);
    EXPECT_NEAR(arc.radius, 2, 1e-7);
    EXPECT_NEAR(arc.off, 0, 1e-8);
    EXPECT_NEAR(arc.axis.x(), 1, 1e-12);
  }
}

TEST(CircularArc, SeesAPointThatIsOffTheCircleAndALine) {
  Eigen::MatrixX3d points = arc_points(1, 0, 2, 11);
  points(2, 0) += 0.1;
  EXPECT_NEAR(circular_arc(points).off, 0.1, 1e-12);
  Eigen::MatrixX3d line(3, 3);
  line << 0, 0, 0, 1, 1, 0, 3, 3, 0;
  EXPECT_NEAR(circular_arc(line).length, std::sqrt(18.0), 1e-15);
  EXPECT_TRUE(std::isinf(circular_arc(line).radius));
  EXPECT_THROW(circular_arc(line.topRows(2)), Error);
}

// A half cylinder below half of the rim's length leaves the other half uncovered.
TEST(RimCover, IsTheShareOfTheRimBelowWhichNothingLies) {
  const Eigen::MatrixX3d rim = arc_points(1, -1.5, 1.5, 101);
  const auto strip = [](double from, double to) {
    TriMesh mesh;
    mesh.V.resize(82, 3);
    mesh.V << arc_points(0.9, from, to, 41, -0.1), arc_points(0.9, from, to, 41, 0.1);
    mesh.F.resize(80, 3);
    for (int k = 0; k < 40; ++k) {
      mesh.F.row(2 * k) << k, k + 1, k + 41;
      mesh.F.row(2 * k + 1) << k + 1, k + 42, k + 41;
    }
    return mesh;
  };
  EXPECT_EQ(uncovered_share(rim, 0, strip(-1.6, 1.6)), 0);
  EXPECT_NEAR(uncovered_share(rim, 0, strip(0.001, 1.6)), 0.5, 0.011);
  TriMesh ahead = strip(-1.6, 1.6);
  ahead.V.col(0).array() += 0.2;
  EXPECT_EQ(uncovered_share(rim, 0.1, ahead), 1);
}

}  // namespace
}  // namespace geoprior
