#include "metrics/shape/projected_outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using std::numbers::pi;

std::vector<PlanarSegment> outline_of(const TriMesh& mesh, const Eigen::Matrix3d& view) {
  return projected_outline(projected_points(mesh, view), mesh.F);
}

double outline_length(const std::vector<PlanarSegment>& outline) {
  double sum = 0;
  for (const PlanarSegment& s : outline) sum += (s.b - s.a).norm();
  return sum;
}

/// A view along this direction.
Eigen::Matrix3d looking_from(const Eigen::Vector3d& eye) {
  Eigen::Matrix3d view;
  const Eigen::Vector3d z = eye.normalized();
  const Eigen::Vector3d x = Eigen::Vector3d(0.1, 1, 0.3).cross(z).normalized();
  view << x.transpose(), z.cross(x).transpose(), z.transpose();
  return view;
}

TEST(ProjectedOutline, OfACubeOverItsCornerIsAHexagon) {
  const TriMesh cube = shapes::box({0, 0, 0}, {1, 1, 1});
  const std::vector<PlanarSegment> outline = outline_of(cube, looking_from({1, 1, 1}));
  EXPECT_EQ(outline.size(), 6u);
  EXPECT_NEAR(outline_length(outline), 6 * std::sqrt(2.0 / 3), 1e-8);
}

TEST(ProjectedOutline, OfABoxSeenFromTheFrontHasEdgeOnSides) {
  // Both ends bound it: twice the perimeter, once a layer.
  const TriMesh box = shapes::box({0, 0, 0}, {2, 1, 3});
  EXPECT_NEAR(outline_length(outline_of(box, Eigen::Matrix3d::Identity())), 2 * 6, 1e-8);
}

TEST(ProjectedOutline, OfATorusHasAHole) {
  const int n = 48;
  const TriMesh torus = shapes::torus(1, 0.3, n, 24);  // vertices at both equators
  const double outer = 2 * n * 1.3 * std::sin(pi / n), inner = 2 * n * 0.7 * std::sin(pi / n);
  EXPECT_NEAR(outline_length(outline_of(torus, Eigen::Matrix3d::Identity())), outer + inner, 1e-7);
}

TEST(ProjectedOutline, WhatIsHiddenIsLeftOut) {
  // A small sphere before or behind a large plate, and one that sticks out to a half.
  TriMesh plate = sheets::rectangle(4, 4, 3, 3).mesh();
  for (const double z : {2.0, -2.0}) {
    const TriMesh inside = shapes::together(plate, shapes::sphere(0.5, {0.1, 0.2, z}, 3));
    EXPECT_NEAR(outline_length(outline_of(inside, Eigen::Matrix3d::Identity())), 16, 1e-7);
  }
  const TriMesh out = shapes::together(plate, shapes::sphere(0.5, {2, 0.2, 1}, 3));
  // The side of the plate is hidden over a diameter; the polygon of the sphere's equator is added.
  const int sides = 32;
  EXPECT_NEAR(outline_length(outline_of(out, Eigen::Matrix3d::Identity())),
              16 - 1 + sides * std::sin(pi / sides) / 2, 1e-7);
}

TEST(ProjectedOutline, ContoursInsideAreNoOutline) {
  // A sheet in a Z fold, seen from above: two folds lie over it and one sheet's width remains.
  sheets::Sheet s = sheets::rectangle(3, 1, 6, 2);
  const TriMesh fold = sheets::mapped(s, [](const Eigen::Vector2d& p) {
                         const double u = p(0) + 1.5;
                         const double x = u < 1 ? u : u < 2 ? 1.5 - u / 2 : u - 1.5;
                         return Eigen::Vector3d(x, p(1), u < 1 ? 0 : 0.1 * std::min(u - 1, 1.0));
                       }).mesh();
  // x runs from 0 to 1, back to 0.5 and on to 1.5. Sides in two or three layers coincide and count
  // once a layer: 3 - 0.5 long each in all, and two ends.
  EXPECT_NEAR(outline_length(outline_of(fold, Eigen::Matrix3d::Identity())), 2 * (1 + 0.5 + 1) + 2,
              1e-7);
}

TEST(ProjectedOutline, ACrackOfRoundOffIsNoOutline) {
  // Two halves that are not welded and miss each other by less than 1e-9.
  const TriMesh left = sheets::rectangle(1, 1, 3, 3, 0.2).mesh();
  TriMesh right = left;
  right.V.col(0).array() += 1 + 1e-12;
  const TriMesh both = shapes::together(left, right);
  EXPECT_NEAR(outline_length(outline_of(both, Eigen::Matrix3d::Identity())), 6, 1e-8);
  right.V.col(0).array() += 1e-3;
  EXPECT_NEAR(
      outline_length(outline_of(shapes::together(left, right), Eigen::Matrix3d::Identity())), 8,
      1e-8);
}

TEST(ProjectedOutline, OfManyOverlappingBallsIsTheUnionsArcs) {
  // Balls of radius 1 in a row, 1 apart: each inner one shows two arcs of 60 degrees, the outer
  // ones 240; inscribed polyhedra fall short by their sagitta.
  TriMesh row = shapes::sphere(1, {0, 0, 0}, 5);
  for (int i = 1; i < 4; ++i)
    row = shapes::together(row, shapes::sphere(1, {double(i), 0, 0.3 * i}, 5));
  EXPECT_NEAR(outline_length(outline_of(row, Eigen::Matrix3d::Identity())),
              2 * (4 * pi / 3) + 2 * 2 * pi / 3, 5e-3);
}

/// Ends of the union of the triangles along the horizontal line at height y, by brute force.
std::vector<double> ends_along(const Eigen::MatrixX2d& points, const Eigen::MatrixX3i& F,
                               double y) {
  std::vector<std::array<double, 2>> spans;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    std::vector<double> x;
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector2d a = points.row(F(t, k)), b = points.row(F(t, (k + 1) % 3));
      if ((a.y() < y) == (b.y() < y)) continue;
      x.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
    }
    if (x.size() == 2) spans.push_back({std::min(x[0], x[1]), std::max(x[0], x[1])});
  }
  std::sort(spans.begin(), spans.end());
  std::vector<double> ends;
  for (const auto& [begin, end] : spans) {
    if (ends.empty() || begin > ends.back()) {
      ends.push_back(begin);
      ends.push_back(end);
    }
    ends.back() = std::max(ends.back(), end);
  }
  return ends;
}

/// Places where the outline passes the line.
std::vector<double> passes_along(const std::vector<PlanarSegment>& outline, double y) {
  std::vector<double> x;
  for (const PlanarSegment& s : outline) {
    if ((s.a.y() < y) != (s.b.y() < y))
      x.push_back(s.a.x() + (y - s.a.y()) / (s.b.y() - s.a.y()) * (s.b.x() - s.a.x()));
  }
  std::sort(x.begin(), x.end());
  return x;
}

TEST(ProjectedOutline, OfLooseTrianglesIsWhereTheirUnionEnds) {
  // No edge is shared, so every edge may bound the union; lines across it say which parts do.
  RandomStream random(11, "triangles");
  const int n = 300;
  Eigen::MatrixX2d points(3 * n, 2);
  Eigen::MatrixX3i F(n, 3);
  for (int t = 0; t < n; ++t) {
    const double x = random.uniform(), y = random.uniform();
    for (int k = 0; k < 3; ++k) {
      points.row(3 * t + k) << x + 0.1 * random.uniform(), y + 0.1 * random.uniform();
      F(t, k) = 3 * t + k;
    }
  }
  const std::vector<PlanarSegment> outline = projected_outline(points, F);
  for (int line = 0; line < 200; ++line) {
    const double y = 0.05 + random.uniform();
    const std::vector<double> expected = ends_along(points, F, y);
    const std::vector<double> found = passes_along(outline, y);
    ASSERT_EQ(found.size(), expected.size()) << "y = " << y;
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-12);
  }
}

TEST(ProjectedOutline, WallsThatAreEdgeOnToRoundOffAddNothing) {
  // A tube seen along its axis, in any place: each of its wall's triangles is a sliver of either
  // side, or of none. All that is found lies on the polygon.
  const int n = 40;
  TriMesh tube = shapes::periodic_grid(n, 12, [](double u, double v) {
    const double radius = std::cos(v) > 0 ? 1 : 0.5;  // walls at v = 0 and pi, and between them
    return Eigen::Vector3d(radius * std::cos(u), radius * std::sin(u), std::sin(v));
  });
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  tube.V = (tube.V * R.transpose()).rowwise() + Eigen::RowVector3d(3, 5, -4);
  const Eigen::Matrix3d view = R.transpose();
  const Eigen::Vector2d centre = (view * Eigen::Vector3d(3, 5, -4)).head<2>();
  bool outer = false, inner = false;
  for (const PlanarSegment& s : outline_of(tube, view)) {
    const double middle = ((s.a + s.b) / 2 - centre).norm();
    const double chord = std::cos(pi / n);
    const bool is_outer = std::abs(middle - chord) < 4e-3;
    EXPECT_TRUE(is_outer || std::abs(middle - chord / 2) < 2e-3);
    outer = outer || is_outer;
    inner = inner || !is_outer;
  }
  EXPECT_TRUE(outer && inner);
}

TEST(ProjectedOutline, RefusesWhatHasNone) {
  TriMesh plate = sheets::rectangle(1, 1, 2, 2).mesh();
  Eigen::Matrix3d edge_on;
  edge_on << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  EXPECT_THROW(outline_of(plate, edge_on), Error);
  EXPECT_THROW(outline_of(plate, 2 * Eigen::Matrix3d::Identity()), Error);
}

}  // namespace
}  // namespace geoprior
