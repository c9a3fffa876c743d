#include "metrics/shape/silhouette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using std::numbers::pi;
const Eigen::Matrix3d kFront = Eigen::Matrix3d::Identity();

PlanarLoop circle(double radius, const Eigen::Vector2d& centre, int n = 4000) {
  PlanarLoop loop;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * pi * i / n;
    loop.push_back(centre + radius * Eigen::Vector2d(std::cos(t), std::sin(t)));
  }
  return loop;
}

PlanarLoop rectangle_loop(double width, double height, const Eigen::Vector2d& centre = {0, 0}) {
  const double x = width / 2, y = height / 2;
  return {centre + Eigen::Vector2d(-x, -y), centre + Eigen::Vector2d(x, -y),
          centre + Eigen::Vector2d(x, y), centre + Eigen::Vector2d(-x, y)};
}

/// Area that two circles have in common, their centres d apart.
double lens_area(double r, double s, double d) {
  if (d >= r + s) return 0;
  if (d <= std::abs(r - s)) return pi * std::pow(std::min(r, s), 2);
  const double a = std::acos((d * d + r * r - s * s) / (2 * d * r));
  const double b = std::acos((d * d + s * s - r * r) / (2 * d * s));
  return r * r * (a - std::sin(2 * a) / 2) + s * s * (b - std::sin(2 * b) / 2);
}

/// A flat disc of chords that are shorter than a circle's by 1 / (6 n^2) pi^2.
TriMesh flat_disc(double radius) { return sheets::disc(radius, 4, 2000).mesh(); }

/// The disc without its inner half.
TriMesh flat_annulus(double radius) {
  TriMesh mesh = flat_disc(radius);
  const int spokes = 2000;
  mesh.F = mesh.F.bottomRows(mesh.F.rows() - 3 * spokes).eval();  // rings of a quarter each
  return mesh;
}

SilhouetteMatch match_of(const TriMesh& mesh, const PlanarLoop& loop,
                         const SilhouetteOptions& options = {}) {
  return silhouette_match(mesh, kFront, {&loop, 1}, options);
}

TEST(Silhouette, IouOfADiscAndAShiftedOneIsTheLens) {
  const TriMesh disc = flat_disc(1);
  for (const double shift : {0.0, 0.01, 0.5, 1.7}) {
    const PlanarLoop drawn = circle(1, {0.6 * shift, 0.8 * shift});
    const double common = lens_area(1, 1, shift);
    // Polygons of 2000 and 4000 corners: 1.6e-6 of the area; rows: less.
    EXPECT_NEAR(match_of(disc, drawn).iou, common / (2 * pi - common), 4e-6);
  }
}

TEST(Silhouette, IouOfAnAnnulusAndAShiftedOne) {
  // Inclusion and exclusion of four circles, radii 1 and 1/2.
  const TriMesh annulus = flat_annulus(1);
  for (const double d : {0.1, 0.3}) {
    const Eigen::Vector2d shift(0, d);
    const std::array drawn{circle(1, shift), circle(0.5, shift)};
    const double common = lens_area(1, 1, d) - 2 * lens_area(1, 0.5, d) + lens_area(0.5, 0.5, d);
    const double one = pi * 0.75;
    const SilhouetteMatch m = silhouette_match(annulus, kFront, drawn);
    EXPECT_NEAR(m.iou, common / (2 * one - common), 1e-5);
    EXPECT_NEAR(m.hausdorff, d, 1e-4);
  }
}

TEST(Silhouette, AreasArePrecise) {
  // Layers count once, edge-on walls nothing; the drawing's area is exact.
  const TriMesh box = shapes::box({-1, -0.5, 0}, {1, 0.5, 3});
  const Eigen::MatrixX2d points = projected_points(box, kFront);
  const PlanarLoop drawn = rectangle_loop(1.3, 0.7, {0.5, 0.1});
  for (const int rows : {1, 7, 1024}) {
    const SilhouetteArea a = silhouette_area(points, box.F, {&drawn, 1}, rows);
    EXPECT_NEAR(a.mesh, 2, 1e-13);
    EXPECT_NEAR(a.drawn, 1.3 * 0.7, 1e-13);
    EXPECT_NEAR(a.common, (1 - (0.5 - 0.65)) * 0.7, 1e-13);
  }
}

TEST(Silhouette, ErrorOfTheRowsIsOfSecondOrder) {
  // A disc has no horizontal edges: refining the rows by 4 divides the error by about 16.
  const TriMesh disc = sheets::turned_pattern(sheets::disc(1, 2, 400), 0).mesh();
  const Eigen::MatrixX2d points = projected_points(disc, kFront);
  const double exact = 400 * std::sin(2 * pi / 400) / 2;
  const PlanarLoop drawn{{-2, -1.01}, {2, -1.013}, {0.1, 1.017}};
  const auto error = [&](int rows) {
    return std::abs(silhouette_area(points, disc.F, {&drawn, 1}, rows).mesh - exact) / exact;
  };
  EXPECT_LT(error(1024), 2e-5);
  EXPECT_LT(error(1024), error(64) / 30);
}

TEST(Silhouette, OfASphereAgainstACircle) {
  // The outline of the subdivided octahedron is the polygon of its equator.
  const TriMesh sphere = shapes::sphere(0.5, {3, 4, 5}, 5);
  const int sides = 4 * 32;
  const SilhouetteMatch m = match_of(sphere, circle(0.5, {3, 4}));
  EXPECT_NEAR(m.iou, sides * std::sin(2 * pi / sides) / (2 * pi), 1e-5);
  EXPECT_NEAR(m.hausdorff, 0.5 * (1 - std::cos(pi / sides)), 1e-6);
  EXPECT_EQ(m.gap_share, 0);
  EXPECT_EQ(m.gap_longest, 0);
}

TEST(Silhouette, HausdorffOfConcentricCirclesIsTheDifference) {
  const SilhouetteMatch m = match_of(flat_disc(0.3), circle(0.31, {0, 0}));
  EXPECT_NEAR(m.drawn_to_mesh, 0.01, 1e-6);
  EXPECT_NEAR(m.mesh_to_drawn, 0.01, 1e-6);
  EXPECT_NEAR(m.hausdorff_percent, 100 * 0.01 / (0.62 * std::sqrt(2.0)), 1e-3);
  EXPECT_NEAR(m.iou, std::pow(0.3 / 0.31, 2), 1e-5);
  EXPECT_EQ(m.gap_share, 1);  // 1.1 % everywhere, above half a per cent
  EXPECT_NEAR(m.gap_longest, 2 * pi * 0.31, 1e-5);
}

TEST(Silhouette, AMissingStrapIsSeenByDistancesRatherThanByArea) {
  // A square with a strap of 0.01 x 1 drawn on its top that the mesh lacks.
  TriMesh plate = sheets::rectangle(1, 1, 5, 5).mesh();
  const PlanarLoop drawn{{-0.5, -0.5}, {0.5, -0.5},   {0.5, 0.5},    {0.005, 0.5},
                         {0.005, 1.5}, {-0.005, 1.5}, {-0.005, 0.5}, {-0.5, 0.5}};
  SilhouetteOptions options;
  const double diagonal = std::hypot(1, 2), tolerance = 0.05;
  options.gap_tolerance = tolerance / diagonal;
  const SilhouetteMatch m = match_of(plate, drawn, options);
  EXPECT_NEAR(m.iou, 1 / 1.01, 1e-9);
  EXPECT_NEAR(m.drawn_to_mesh, 1, 1e-12);
  // The plate's outline under the strap's foot: half its width away from a corner of it.
  EXPECT_NEAR(m.mesh_to_drawn, 0.005, options.sampling * diagonal);
  const double gap = 2 * (1 - tolerance) + 0.01;
  EXPECT_NEAR(m.gap_longest, gap, 1e-6);
  EXPECT_NEAR(m.gap_share, gap / (4 + 2), 1e-6);
}

TEST(Silhouette, AGapOverTheStartOfTheLoopIsOne) {
  // The same outline, whichever of its points comes first.
  TriMesh plate = sheets::rectangle(1, 1, 3, 3).mesh();
  PlanarLoop drawn{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {0.1, 0.5},
                   {0, 0.9},     {-0.1, 0.5}, {-0.5, 0.5}};
  const SilhouetteMatch first = match_of(plate, drawn);
  for (std::size_t i = 1; i < drawn.size(); ++i) {
    std::rotate(drawn.begin(), drawn.begin() + 1, drawn.end());
    const SilhouetteMatch m = match_of(plate, drawn);
    EXPECT_NEAR(m.gap_longest, first.gap_longest, 1e-12);
    EXPECT_NEAR(m.gap_share, first.gap_share, 1e-12);
  }
  EXPECT_GT(first.gap_longest, 0.7);
  EXPECT_LT(first.gap_longest, 2 * std::hypot(0.1, 0.4));
}

TEST(Silhouette, FollowsTheView) {
  // Seen from +x, right is -z: a box that reaches from z = 0 to 3 lies left of the middle.
  const TriMesh box = shapes::box({-1, -0.5, 0}, {1, 0.5, 3});
  Eigen::Matrix3d side;
  side << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  const PlanarLoop drawn = rectangle_loop(3, 1, {-1.5, 0});
  const SilhouetteMatch m = silhouette_match(box, side, {&drawn, 1});
  EXPECT_NEAR(m.iou, 1, 1e-12);
  EXPECT_LT(m.hausdorff, 1e-8);
}

TEST(Silhouette, AHoleThatIsDrawnMustBeOpen) {
  const TriMesh plate = sheets::rectangle(2, 2, 4, 4).mesh();
  const std::array drawn{rectangle_loop(2, 2), rectangle_loop(1, 1)};
  const SilhouetteMatch m = silhouette_match(plate, kFront, drawn);
  EXPECT_NEAR(m.iou, 0.75, 1e-12);
  EXPECT_NEAR(m.drawn_to_mesh, 0.5, 1e-9);
  EXPECT_LT(m.mesh_to_drawn, 1e-9);
  EXPECT_NEAR(m.gap_share, 4.0 / 12, 1e-9);
}

TEST(Silhouette, IsTheSameAtAnyNumberOfThreads) {
  const TriMesh torus = shapes::torus(1, 0.35, 90, 50);
  Eigen::Matrix3d view;
  view = Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, -1).normalized());
  const PlanarLoop drawn = circle(1.2, {0.1, 0}, 300);
  SilhouetteMatch one, many;
  with_threads(1, [&] { one = silhouette_match(torus, view, {&drawn, 1}); });
  with_threads(4, [&] { many = silhouette_match(torus, view, {&drawn, 1}); });
  EXPECT_EQ(one.iou, many.iou);
  EXPECT_EQ(one.hausdorff, many.hausdorff);
  EXPECT_EQ(one.gap_share, many.gap_share);
  EXPECT_EQ(one.gap_longest, many.gap_longest);
}

TEST(Silhouette, RefusesWhatItCannotCompare) {
  const TriMesh plate = sheets::rectangle(1, 1, 2, 2).mesh();
  EXPECT_THROW(silhouette_match(plate, kFront, {}), Error);
  EXPECT_THROW(match_of(plate, {{0, 0}, {1, 0}}), Error);
  EXPECT_THROW(match_of(plate, {{0, 0}, {1, 0}, {2, 0}}), Error);  // no area
  EXPECT_THROW(match_of(TriMesh{}, rectangle_loop(1, 1)), Error);
  SilhouetteOptions options;
  options.rows = 0;
  EXPECT_THROW(match_of(plate, rectangle_loop(1, 1), options), Error);
  options = {};
  options.sampling = 0;
  EXPECT_THROW(match_of(plate, rectangle_loop(1, 1), options), Error);
}

}  // namespace
}  // namespace geoprior
