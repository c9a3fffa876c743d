#include "metrics/developability/crease_turning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/connectivity.h"
#include "core/error.h"
#include "tests/metrics/sampled_surfaces.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

/// A strip of length 4 with edges at u = -1, 0 and 1, folded there by a right angle each: three
/// edges of a box of width 1, of height 1.
TriMesh box_strip() {
  const sheets::Map fold = [](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    const double u = p(0) + 2;
    if (u <= 1) return {0, u, p(1)};
    if (u <= 2) return {u - 1, 1, p(1)};
    if (u <= 3) return {1, 3 - u, p(1)};
    return {4 - u, 0, p(1)};
  };
  return sheets::mapped(sheets::rectangle(4, 1, 32, 8), fold).mesh();
}

/// Two half planes that meet at `angle`, the corner replaced by a cylinder of `strips` strips of
/// the mesh's own width.
TriMesh fold_over_strips(int strips, double angle) {
  const double cell = 1.0 / 16, radius = strips * cell / angle;
  const sheets::Map bend = [=](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    const double turned = std::clamp(p(0) / radius + angle / 2, 0.0, angle);
    const double past = p(0) - radius * (turned - angle / 2);
    return {radius * std::sin(turned) + past * std::cos(turned), p(1),
            radius * (1 - std::cos(turned)) + past * std::sin(turned)};
  };
  return sheets::mapped(sheets::rectangle(2, 1, 32, 16), bend).mesh();
}

TEST(CreaseTurning, OfAFoldedStripIsItsAngleTimesItsLength) {
  const TriMesh fold = sheets::folded(2, 1, 16, 8, 50 * kDegree).mesh();
  const CreaseMeasures m = crease_measures(fold);
  EXPECT_NEAR(m.turning, 50 * kDegree, 1e-9);
  EXPECT_NEAR(m.length, 1, 1e-9);
  EXPECT_NEAR(m.clean_length, 1, 1e-9);
  EXPECT_EQ(m.saw_share, 0);
  EXPECT_NEAR(m.rest_p95, 0, 1e-9) << "the fold is less than a twentieth of all edges";
  const TriMesh coarse = sheets::folded(2, 1, 4, 2, 50 * kDegree).mesh();
  EXPECT_NEAR(crease_measures(coarse).rest_p95, 50 * kDegree, 1e-9) << "and here more";
}

TEST(CreaseTurning, OfABoxIsThatOfItsEdgesButForADrawnFold) {
  const TriMesh box = box_strip();
  const CreaseMeasures all = crease_measures(box);
  EXPECT_NEAR(all.turning, 3 * std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(all.clean_length, 3, 1e-9);
  // The middle edge is a fold that was drawn.
  std::vector<bool> drawn(box.V.rows());
  for (Eigen::Index v = 0; v < box.V.rows(); ++v)
    drawn[v] = box.V(v, 0) > 1 - 1e-9 && box.V(v, 1) > 1 - 1e-9;
  const CreaseMeasures rest = crease_measures(box, kCreaseTurn, drawn);
  EXPECT_NEAR(rest.turning, 2 * std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(rest.length, 2, 1e-9);
}

TEST(CreaseTurning, OfACylinderIsNoneHoweverFewItsSides) {
  // 24 sides turn by 15 degrees each.
  for (const int sides : {24, 60}) {
    const CreaseMeasures m = crease_measures(sampled::prism(1, 0.5, sides, sides / 2));
    EXPECT_EQ(m.turning, 0) << sides;
    EXPECT_LT(m.rest_p95, 0.5 * kDegree) << sides;
  }
  const TriMesh irregular =
      sheets::mapped(sheets::rectangle(1, 1, 24, 24, 0.2), sheets::cylinder(0.5)).mesh();
  EXPECT_LT(crease_measures(irregular).rest_p95, 2.5 * kDegree);
}

TEST(CreaseTurning, OfARoundedFoldIsNoneFromFiveStripsOn) {
  const double sharp = crease_measures(fold_over_strips(1, 90 * kDegree)).turning;
  const double two = crease_measures(fold_over_strips(2, 90 * kDegree)).turning;
  EXPECT_GT(sharp, 1);
  EXPECT_LT(two, sharp);
  EXPECT_EQ(crease_measures(fold_over_strips(6, 90 * kDegree)).turning, 0);
}

// Vertices of the ridge lie beside it by turns, so that each second edge cuts its corner.
TEST(CreaseTurning, SeesASawWhereARidgeHasTeeth) {
  TriMesh saw = sheets::folded(2, 1, 16, 16, 90 * kDegree).mesh();
  for (Eigen::Index v = 0; v < saw.V.rows(); ++v) {
    const bool ridge = std::abs(saw.V(v, 0)) < 1e-9 && std::abs(saw.V(v, 2)) < 1e-9;
    const auto row = std::lround((saw.V(v, 1) + 0.5) * 16);
    if (ridge && row % 2 == 1) saw.V(v, 0) -= 0.07;
  }
  const CreaseMeasures m = crease_measures(saw);
  EXPECT_GT(m.saw_share, 0.95);
  EXPECT_GT(m.length, 1);
  EXPECT_LT(m.clean_length, 0.2);
}

TEST(CreaseTurning, SignsConvexAndConcaveEdgesAndScalesWithLength) {
  const TriMesh cube = shapes::box({0, 0, 0}, {1, 1, 1});
  int convex = 0;
  for (const EdgeTurn& turn : edge_turns(cube)) convex += turn.angle > 1 ? 1 : 0;
  EXPECT_EQ(convex, 12);
  const TriMesh fold = sheets::folded(2, 1, 16, 8, 50 * kDegree).mesh();
  EXPECT_NEAR(crease_measures({3 * fold.V, fold.F}).turning, 3 * 50 * kDegree, 1e-9);
}

TEST(CreaseTurning, RefusesAThresholdAndAMaskThatSayNothing) {
  const TriMesh cube = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(crease_measures(cube, 0), Error);
  EXPECT_THROW(crease_measures(cube, kCreaseTurn, std::vector<bool>(7)), Error);
}

}  // namespace
}  // namespace geoprior
