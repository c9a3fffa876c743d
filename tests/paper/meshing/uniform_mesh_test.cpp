#include "models/paper/meshing/uniform_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include "baselines/paper/dense.h"
#include "core/error.h"
#include "core/mesh.h"
#include "tests/paper/contact/plane_shapes.h"

namespace geoprior::paper {
namespace {

struct Case {
  std::string name;
  Pattern pattern;
  UniformLayout layout;
};

/// Without it the name of a test would list the bytes of its case, addresses included.
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class UniformMesh : public ::testing::TestWithParam<Case> {};

std::vector<Case> cases() {
  const Pattern sheet = rectangle_pattern(0.21, 0.297);
  return {{"StructuredRectangle", sheet, UniformLayout::structured},
          {"EquilateralRectangle", sheet, UniformLayout::equilateral},
          {"DelaunayRectangle", sheet, UniformLayout::delaunay},
          {"EquilateralDisc", disc_pattern(0.1, 40), UniformLayout::equilateral},
          {"DelaunayDisc", disc_pattern(0.1, 40), UniformLayout::delaunay},
          {"AutomaticEll", plane_shapes::ell_pattern(), UniformLayout::automatic},
          {"EquilateralEll", plane_shapes::ell_pattern(), UniformLayout::equilateral},
          {"DelaunayEll", plane_shapes::ell_pattern(), UniformLayout::delaunay},
          {"AutomaticRing", plane_shapes::ring_pattern(), UniformLayout::automatic},
          {"DelaunayRing", plane_shapes::ring_pattern(), UniformLayout::delaunay}};
}

/// Points inside, on an edge and at a corner of a pattern.
std::vector<Eigen::Vector2d> some_anchors(const Pattern& pattern) {
  const Eigen::Vector2d corner = pattern.border[0];
  const Eigen::Vector2d side = 0.63 * pattern.border[0] + 0.37 * pattern.border[1];
  const Eigen::Vector2d inside = side + 0.031 * Eigen::Vector2d(-1, 1).normalized();
  std::vector<Eigen::Vector2d> anchors{corner, side};
  for (const auto& hole : pattern.holes) {
    anchors.push_back(hole[1]);
    anchors.push_back(0.37 * hole[1] + 0.63 * hole[2]);
  }
  for (const double t : {0.0, 0.001, 0.004}) {
    const Eigen::Vector2d p = inside + t * Eigen::Vector2d(1, 2);
    if (contains(pattern, p)) anchors.push_back(p);
  }
  return anchors;
}

TEST_P(UniformMesh, CoversThePatternExactly) {
  for (const int triangles : {8, 100, 1500}) {
    SCOPED_TRACE(triangles);
    plane_shapes::expect_covers(
        uniform_mesh(GetParam().pattern, triangles, GetParam().layout, {}, 1), GetParam().pattern);
  }
}

TEST_P(UniformMesh, HasAboutAsManyTrianglesAsAskedFor) {
  for (const int triangles : {200, 1500}) {
    const ShellMesh mesh = uniform_mesh(GetParam().pattern, triangles, GetParam().layout, {}, 1);
    EXPECT_NEAR(mesh.triangle_count(), triangles, 0.1 * triangles);
  }
}

TEST_P(UniformMesh, HasAVertexAtEveryAnchor) {
  const std::vector<Eigen::Vector2d> anchors = some_anchors(GetParam().pattern);
  ASSERT_GE(anchors.size(), 3U);
  for (const int triangles : {8, 100, 1500}) {
    SCOPED_TRACE(triangles);
    const ShellMesh mesh =
        uniform_mesh(GetParam().pattern, triangles, GetParam().layout, anchors, 1);
    plane_shapes::expect_covers(mesh, GetParam().pattern);
    for (const Eigen::Vector2d& p : anchors)
      EXPECT_LT(plane_shapes::distance_to_vertices(mesh, p), 1e-12);
  }
}

// A triangle's shape 4 sqrt(3) area / (sum of squared edges): 1 equilateral, 0.87 half a square.
TEST_P(UniformMesh, TrianglesHaveAGoodShape) {
  const ShellMesh mesh = uniform_mesh(GetParam().pattern, 800, GetParam().layout, {}, 3);
  double worst = 1;
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    double edges = 0;
    for (int k = 0; k < 3; ++k) {
      edges += (mesh.pattern.row(mesh.triangles(f, k)) -
                mesh.pattern.row(mesh.triangles(f, (k + 1) % 3)))
                   .squaredNorm();
    }
    worst = std::min(worst, 2 * std::sqrt(3.0) * plane_shapes::twice_area(mesh, f) / edges);
  }
  EXPECT_GT(worst, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Layouts, UniformMesh, ::testing::ValuesIn(cases()),
                         [](const auto& p) { return p.param.name; });

TEST(StructuredMesh, DiagonalsAlternate) {
  const ShellMesh mesh = uniform_mesh(rectangle_pattern(1, 1), 8, UniformLayout::structured, {}, 1);
  ASSERT_EQ(mesh.triangle_count(), 8);
  // All four diagonals of a 2 x 2 grid meet at its centre or none does: valence 8 or 4.
  const int centre = 4;
  EXPECT_EQ((mesh.triangles.array() == centre).count(), 8);
}

TEST(StructuredMesh, MovesTheNearestVertexToAnAnchor) {
  const Pattern pattern = rectangle_pattern(1, 1);
  const ShellMesh plain = uniform_mesh(pattern, 200, UniformLayout::structured, {}, 1);
  const ShellMesh moved =
      uniform_mesh(pattern, 200, UniformLayout::structured, {{0.12, 0.09}, {-0.5, 0.02}}, 1);
  EXPECT_EQ(moved.triangles, plain.triangles);
  EXPECT_EQ(((moved.pattern - plain.pattern).rowwise().norm().array() > 0).count(), 2);
}

TEST(StructuredMesh, RefusesWhatIsNoUprightRectangle) {
  EXPECT_THROW(uniform_mesh(disc_pattern(1, 8), 100, UniformLayout::structured, {}, 1), Error);
}

// An upright rectangle is the only pattern that the structured layout has.
TEST(AutomaticMesh, IsStructuredOnAnUprightRectangleOnly) {
  const auto same = [](const Pattern& pattern, UniformLayout layout) {
    const ShellMesh a = uniform_mesh(pattern, 200, UniformLayout::automatic, {}, 1);
    const ShellMesh b = uniform_mesh(pattern, 200, layout, {}, 1);
    return same_triangles(a.triangles, b.triangles) && a.pattern == b.pattern;
  };
  EXPECT_EQ(DenseOptions{}.layout, UniformLayout::automatic);
  EXPECT_TRUE(same(rectangle_pattern(0.3, 0.2), UniformLayout::structured));
  EXPECT_TRUE(same(disc_pattern(0.1, 40), UniformLayout::equilateral));
  EXPECT_TRUE(same(plane_shapes::ell_pattern(), UniformLayout::equilateral));
}

TEST(EquilateralMesh, GoesAroundTwoHoles) {
  const Pattern pattern = plane_shapes::pierced_square();
  for (const int triangles : {20, 200, 2000})
    plane_shapes::expect_covers(uniform_mesh(pattern, triangles, UniformLayout::equilateral, {}, 1),
                                pattern);
}

TEST(StructuredMesh, RefusesARectangleWithAHole) {
  Pattern pierced = rectangle_pattern(1, 1);
  pierced.holes = {{{0, 0}, {0, 0.1}, {0.1, 0}}};
  EXPECT_THROW(uniform_mesh(pierced, 100, UniformLayout::structured, {}, 1), Error);
  EXPECT_NO_THROW(uniform_mesh(pierced, 100, UniformLayout::automatic, {}, 1));
}

TEST(UniformMeshErrors, NameAnAnchorInAHole) {
  EXPECT_THROW(
      uniform_mesh(plane_shapes::pierced_square(), 100, UniformLayout::delaunay, {{1, 1}}, 1),
      Error);
}

TEST(UniformMeshErrors, NameAnAnchorOutside) {
  try {
    uniform_mesh(rectangle_pattern(1, 1), 100, UniformLayout::delaunay, {{0, 0}, {0.6, 0}}, 1);
    FAIL() << "accepted an anchor outside the pattern";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("anchor 1"), std::string::npos);
  }
}

TEST(DelaunayMesh, DependsOnTheSeedAlone) {
  const Pattern disc = disc_pattern(0.1, 40);
  const ShellMesh a = uniform_mesh(disc, 300, UniformLayout::delaunay, {}, 1);
  const ShellMesh b = uniform_mesh(disc, 300, UniformLayout::delaunay, {}, 1);
  const ShellMesh c = uniform_mesh(disc, 300, UniformLayout::delaunay, {}, 2);
  EXPECT_EQ(a.pattern, b.pattern);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_FALSE(a.pattern.rows() == c.pattern.rows() && a.pattern == c.pattern);
}

// Interior edges of a hexagonal lattice whose rows divide the sides of the rectangle.
TEST(EquilateralMesh, InteriorEdgesHaveOneLength) {
  const ShellMesh mesh =
      uniform_mesh(rectangle_pattern(1, 0.9), 600, UniformLayout::equilateral, {}, 1);
  double shortest = 1, longest = 0;
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d p = mesh.pattern.row(mesh.triangles(f, k)),
                            q = mesh.pattern.row(mesh.triangles(f, (k + 1) % 3));
      if (std::max(std::abs(p.x()), std::abs(q.x())) > 0.42) continue;
      shortest = std::min(shortest, (p - q).norm());
      longest = std::max(longest, (p - q).norm());
    }
  }
  EXPECT_LT(longest / shortest, 1.06);
}

}  // namespace
}  // namespace geoprior::paper
