#include "solvers/sketch/pattern/seam_suggestion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "metrics/developability/developability.h"
#include "models/sketch/surface/split.h"
#include "solvers/sketch/pattern/conformal_scale.h"
#include "solvers/sketch/pattern/cut_candidates.h"
#include "solvers/sketch/pattern/cut_trial.h"
#include "solvers/sketch/pattern/level_lines.h"
#include "tests/sketch/pattern/flat_surfaces.h"

namespace geoprior::sketch {
namespace {

/// Circular cone about y of slant 1, its apex at the top; `sine` of the angle between axis and
/// side.
TriMesh cone(double sine, int segments, int rows) {
  TriMesh mesh;
  const double height = std::sqrt(1 - sine * sine);
  mesh.V.resize(1 + segments * rows, 3);
  mesh.V.row(0) << 0, height, 0;
  std::vector<Eigen::Vector3i> triangles;
  for (int j = 1; j <= rows; ++j) {
    const double s = static_cast<double>(j) / rows;
    for (int i = 0; i < segments; ++i) {
      const double a = 2 * std::numbers::pi * i / segments;
      mesh.V.row(1 + (j - 1) * segments + i) << s * sine * std::sin(a), (1 - s) * height,
          s * sine * std::cos(a);
    }
  }
  for (int i = 0; i < segments; ++i) {
    const int next = (i + 1) % segments;
    triangles.emplace_back(0, 1 + i, 1 + next);
    for (int j = 1; j < rows; ++j) {
      const int a = 1 + (j - 1) * segments, b = a + segments;
      triangles.emplace_back(a + i, b + i, b + next);
      triangles.emplace_back(a + i, b + next, a + next);
    }
  }
  mesh.F.resize(triangles.size(), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) mesh.F.row(t) = triangles[t].transpose();
  return mesh;
}

/// Dome over the unit disc: half of a sphere about y, squeezed along y.
TriMesh dome(double height) {
  TriMesh mesh = flats::hemisphere(4);
  const Eigen::MatrixX3d V = mesh.V;
  mesh.V.col(1) = height * V.col(2);
  mesh.V.col(2) = -V.col(1);
  return mesh;
}

TEST(SurfacePaths, OfAPlaneIsStraight) {
  const TriMesh plane =
      flats::grid(20, 20, [](int i, int j) { return Eigen::Vector3d(0.05 * i, 0.05 * j, 0); });
  const SurfacePaths paths(plane, Eigen::VectorXd::Ones(plane.triangle_count()));
  std::vector<char> targets(plane.vertex_count(), 0);
  targets[15 * 21 + 19] = 1;                                     // (0.95, 0.75)
  const SurfacePath path = paths.shortest(2 * 21 + 1, targets);  // from (0.05, 0.10)
  EXPECT_NEAR(length(path, plane.V), std::hypot(0.9, 0.65), 1e-3 * std::hypot(0.9, 0.65));
}

TEST(SurfacePaths, BendsAtAChangeOfPriceAsLightDoes) {
  // Snell: price times the sine of the angle with the normal of the line y = 0.5 is kept. From
  // (0.2, 0.1) at price 2 to (0.8, 0.9) at price 1.
  const TriMesh plane =
      flats::grid(40, 40, [](int i, int j) { return Eigen::Vector3d(0.025 * i, 0.025 * j, 0); });
  Eigen::VectorXd price = Eigen::VectorXd::Ones(plane.triangle_count());
  price.head(price.size() / 2).setConstant(2);
  const SurfacePaths paths(plane, price);
  std::vector<char> targets(plane.vertex_count(), 0);
  targets[36 * 41 + 32] = 1;
  const SurfacePath path = paths.shortest(4 * 41 + 8, targets);
  double least = 1e9;
  for (int i = 0; i <= 10000; ++i) {
    const double x = 0.2 + 0.6 * i / 10000;
    least = std::min(least, 2 * std::hypot(x - 0.2, 0.4) + std::hypot(0.8 - x, 0.4));
  }
  EXPECT_NEAR(paths.cost(path), least, 5e-3 * least);
}

TEST(SplitAlong, KeepsTheAreaAndHasThePathAsEdges) {
  const TriMesh plane =
      flats::grid(10, 10, [](int i, int j) { return Eigen::Vector3d(0.1 * i, 0.1 * j, 0); });
  const SurfacePaths paths(plane, Eigen::VectorXd::Ones(plane.triangle_count()));
  std::vector<char> targets(plane.vertex_count(), 0);
  targets[7 * 11 + 10] = 1;
  const SurfacePath path = paths.shortest(2 * 11 + 3, targets);
  const auto split = split_along(plane, std::vector<SurfacePath>{path});
  ASSERT_TRUE(split);
  const Eigen::MatrixX3d V = split->interpolated(plane.V);
  const Eigen::VectorXd areas = triangle_areas(V, split->triangles);
  EXPECT_NEAR(areas.sum(), 1, 1e-12);
  EXPECT_GT(areas.minCoeff(), 0);
  double sum = 0;
  for (const Edge& e : split->path) sum += (V.row(e[0]) - V.row(e[1])).norm();
  EXPECT_NEAR(sum, length(path, plane.V), 0.03);
  EXPECT_GT(split->added.size(), 3u);
}

/// Of triangles in the plane z = 0, counter-clockwise ones positive.
Eigen::VectorXd signed_areas(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) {
  Eigen::VectorXd areas(F.rows());
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::RowVector3d a = V.row(F(t, 1)) - V.row(F(t, 0)),
                             b = V.row(F(t, 2)) - V.row(F(t, 0));
    areas(t) = a.cross(b).z() / 2;
  }
  return areas;
}

// Slanted lines over a grid and a jittered one: paths keep to them where vertices stand in for
// crossings, too, and no triangle is turned over or loses all of its area.
TEST(SplitAlong, VerticesThatStandInForCrossingsGoThere) {
  for (const double jitter : {0.0, 0.025}) {
    RandomStream random(1, "jittered grid");
    const TriMesh plane = flats::grid(10, 10, [&](int i, int j) {
      const bool inside = i > 0 && j > 0 && i < 10 && j < 10;
      const double dx = inside ? jitter * (2 * random.uniform() - 1) : 0;
      const double dy = inside ? jitter * (2 * random.uniform() - 1) : 0;
      return Eigen::Vector3d(0.1 * i + dx, 0.1 * j + dy, 0);
    });
    const double least = 0.02 * signed_areas(plane.V, plane.F).mean();
    int moved = 0, nodes = 0, off_line = 0;
    for (int k = 0; k < 60; ++k) {
      const double slope = -1 + 2.0 * k / 59, start = 0.13 + (slope < 0 ? 0.6 : 0.1);
      const auto off = [&](const Eigen::RowVector3d& x) { return x.y() - (start + slope * x.x()); };
      Eigen::VectorXd value(plane.vertex_count());
      for (int v = 0; v < plane.vertex_count(); ++v) value(v) = off(plane.V.row(v));
      const std::vector<SurfacePath> line = level_lines(plane, value, 0);
      ASSERT_EQ(line.size(), 1u);
      const auto split = split_along(plane, line);
      ASSERT_TRUE(split) << "slope " << slope;
      moved += static_cast<int>(split->moved.size());
      const Eigen::MatrixX3d V = split->interpolated(plane.V);
      const Eigen::VectorXd areas = signed_areas(V, split->triangles);
      EXPECT_NEAR(areas.sum(), 1, 1e-12);
      EXPECT_GT(areas.minCoeff(), least) << "slope " << slope;
      for (const Edge& e : split->path) {
        for (const int v : e) {
          const bool is_end = v == line[0].front().edge[0] || v == line[0].back().edge[0];
          ++nodes;
          if (!is_end && std::abs(off(V.row(v))) > 1e-12) ++off_line;
        }
      }
    }
    EXPECT_GT(moved, 60);
    EXPECT_LT(off_line, 0.02 * nodes);
  }
}

TEST(SplitAlong, VerticesOfKeptEdgesAndOfOtherPathsStay) {
  const TriMesh plane =
      flats::grid(10, 10, [](int i, int j) { return Eigen::Vector3d(0.1 * i, 0.1 * j, 0); });
  Eigen::VectorXd value(plane.vertex_count());
  for (int v = 0; v < plane.vertex_count(); ++v)
    value(v) = plane.V(v, 1) - (0.112 + 0.73 * plane.V(v, 0));
  std::vector<SurfacePath> paths = level_lines(plane, value, 0);
  const auto split = split_along(plane, paths);
  ASSERT_TRUE(split);
  ASSERT_FALSE(split->moved.empty());
  const int v = split->moved.front().first;
  const Edge& at = split->moved.front().second.edge;
  const Edge kept{v, at[at[0] == v ? 1 : 0]};
  const auto held = split_along(plane, paths, {&kept, 1});
  ASSERT_TRUE(held);
  EXPECT_EQ(held->triangles, split->triangles);
  EXPECT_EQ(held->interpolated(plane.V).row(v), plane.V.row(v));
  paths.push_back({at_vertex(at[0]), at_vertex(at[1])});
  const auto passed = split_along(plane, paths);
  ASSERT_TRUE(passed);
  EXPECT_EQ(passed->interpolated(plane.V).row(v), plane.V.row(v));
}

TEST(SplitAlong, WhatRunsAlongTwoSidesOfATriangleTakesTheThird) {
  const TriMesh plane =
      flats::grid(10, 10, [](int i, int j) { return Eigen::Vector3d(0.1 * i, 0.1 * j, 0); });
  const EdgeConnectivity edges(plane.F);
  // Up a column of vertices, once around the corner of a triangle beside it.
  SurfacePath path;
  for (int j = 1; j <= 8; ++j) {
    path.push_back(at_vertex(11 * j + 5));
    const int beside = 11 * j + (edges.find(11 * j + 6, 11 * (j + 1) + 5) ? 6 : 4);
    if (j == 4 && edges.find(beside, 11 * (j + 1) + 5)) path.push_back(at_vertex(beside));
  }
  ASSERT_EQ(path.size(), 9u);
  const auto split = split_along(plane, std::vector<SurfacePath>{path});
  ASSERT_TRUE(split);
  EXPECT_EQ(split->path.size(), 7u);
  for (const Edge& e : split->path) EXPECT_NEAR(plane.V(e[0], 0), plane.V(e[1], 0), 1e-12);
}

TEST(ConformalScale, OfAConeIsTheLogarithmOfTheRadius) {
  // A cone of angle 2 pi s at its apex is flattened by r -> r^(1/s): dlog/dr of the scale is
  // (1/s - 1)/r, and u = -log scale with u = 0 at r = 1 is (1/s - 1) log(1/r) … here times s, since
  // L u = K holds on the cone: 2 pi s r u' = -K = -2 pi (1 - s), so u = (1 - s)/s log(1/r).
  const double s = 0.6;
  const TriMesh mesh = cone(s, 96, 40);
  const Eigen::VectorXd u = conformal_scale(mesh);
  for (const int j : {8, 20, 30}) {
    EXPECT_NEAR(u(1 + (j - 1) * 96), (1 - s) / s * std::log(40.0 / j), 0.02) << j;
  }
}

TEST(ConformalScale, KnowsTheDefectsOfTheMetric) {
  const TriMesh mesh = cone(0.6, 48, 10);
  EXPECT_LT((angle_defects(mesh) - angle_defect(mesh)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(PanelsOf, CloseTheSeamsThatSewAPieceToItself) {
  // A tube slit along its side is one piece with one border; its panel is the ring again.
  const SeamedSurface slit{flats::tube(0.5, 0.4, 1, 24, 8), flats::tube_seam(24, 8)};
  ASSERT_EQ(cut_surface(slit.mesh, slit.seams).front().border_count(), 1);
  const std::vector<Panel> panels = panels_of(slit);
  ASSERT_EQ(panels.size(), 1u);
  EXPECT_EQ(panels[0].piece.border_count(), 2);
  EXPECT_EQ(panels[0].inner.size(), 8u);
  // Two halves of a sphere are sewn to each other: nothing is closed.
  const TriMesh sphere = geoprior::shapes::sphere(2);
  const std::vector<Panel> halves = panels_of({sphere, flats::great_circle(sphere, 0, 0)});
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_TRUE(halves[0].inner.empty());
  EXPECT_EQ(halves[1].piece.border_count(), 1);
}

TEST(SeamedSurface, ACutAcrossASeamSplitsItsEdges) {
  SeamedSurface slit{flats::tube(0.5, 0.5, 1, 24, 8), flats::tube_seam(24, 8)};
  // Half way up the edges of one ring of triangles, all around: it crosses the seam once.
  SurfacePath around;
  for (int i = 0; i <= 24; ++i) {
    const int a = 4 * 24 + i % 24;
    around.push_back({{a, a + 24}, 0.5});
    if (i < 24) {
      const int beyond = 5 * 24 + (i + 1) % 24;  // across the diagonal of the cell
      around.push_back({{a, beyond}, 0.5});
    }
  }
  ASSERT_TRUE(slit.cut(std::vector<SurfacePath>{around}, 1));
  EXPECT_EQ(std::count_if(slit.seams.begin(), slit.seams.end(),
                          [](const SeamEdge& e) { return e.seam == 0; }),
            9);
  EXPECT_EQ(cut_surface(slit.mesh, slit.seams).size(), 2u);
}

TEST(SuggestSeams, ConeWantsOneDartFromItsApexToItsBorder) {
  const TriMesh mesh = cone(0.6, 48, 16);
  const auto suggested = suggest_seams(mesh, {}, {});
  ASSERT_EQ(suggested.size(), 1u);
  EXPECT_TRUE(suggested[0].is_dart);
  EXPECT_NEAR(suggested[0].lines.length, 1, 1e-3);  // the slant
  EXPECT_LT(suggested[0].share_before, 0.2);
  EXPECT_NEAR(suggested[0].share_after, 1, 1e-12);
  ASSERT_EQ(suggested[0].lines.points.size(), 1u);
  // Left and right are alike: it lies in the plane between them.
  EXPECT_LT(suggested[0].lines.points[0].col(0).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SuggestSeams, WhatIsDevelopableWantsNone) {
  EXPECT_TRUE(suggest_seams(flats::tube(0.5, 0.5, 1, 40, 10), {}, {}).empty());
  EXPECT_TRUE(suggest_seams(cone(1, 40, 10), {}, {}).empty());  // a flat disc
  const TriMesh slit = cone(0.6, 48, 16);
  std::vector<int> path{0};
  for (int j = 0; j < 16; ++j) path.push_back(1 + j * 48);
  EXPECT_TRUE(suggest_seams(slit, flats::seam_along(path, 0), {}).empty());
}

// A strip that winds round an axis by more than a turn is developable, and lies on itself when it
// is laid flat.
TEST(SuggestSeams, WhatLiesOnItselfIsCutApart) {
  const TriMesh strip = flats::grid(90, 6, [](int i, int j) {
    const double turn = 2.6 * std::numbers::pi * i / 90, radius = 1 - 0.05 * j;
    return Eigen::Vector3d(radius * std::cos(turn), radius * std::sin(turn), 0.01 * turn);
  });
  const auto overlaps = [](const SeamedSurface& surface) {
    std::size_t count = 0;
    for (const CutTrial& of : measured_panels(panels_of(surface), trial_options({}, 0.02)))
      count += of.flat.sound ? 0 : 1;
    return count;
  };
  SeamedSurface surface{strip, {}};
  ASSERT_EQ(overlaps(surface), 1U);
  const auto suggested = suggest_seams(strip, {}, {});
  ASSERT_EQ(suggested.size(), 1U);
  ASSERT_TRUE(surface.cut(suggested[0].cut, 0));
  EXPECT_EQ(overlaps(surface), 0U);
}

TEST(SuggestSeams, MoreGoresFitAHemisphereBetter) {
  // k gores of half width pi/k: what is left of their error falls with 1/k^2.
  const TriMesh mesh = dome(1);
  SeamSuggestionOptions options;
  options.count = 2;
  options.length_weight = 0.001;
  const auto suggested = suggest_seams(mesh, {}, options);
  ASSERT_FALSE(suggested.empty());
  EXPECT_FALSE(suggested[0].is_dart);
  EXPECT_GT(suggested[0].share_after, suggested[0].share_before + 0.3);
  EXPECT_LT(suggested[0].strain_after, 0.3 * suggested[0].strain_before);
}

TEST(SuggestSeams, MirroredSurfacesGetMirroredSuggestions) {
  TriMesh mesh = cone(0.6, 48, 16);
  for (int v = 0; v < mesh.vertex_count(); ++v)  // two bumps, left and right
    mesh.V(v, 1) += 0.1 * std::exp(-30 * (std::pow(std::abs(mesh.V(v, 0)) - 0.3, 2) +
                                          std::pow(mesh.V(v, 2) - 0.1, 2)));
  const auto suggested = suggest_seams(mesh, {}, {});
  TriMesh image = mesh;
  image.V.col(0) *= -1;
  image.F.col(1).swap(image.F.col(2));
  const auto mirrored = suggest_seams(image, {}, {});
  ASSERT_EQ(suggested.size(), mirrored.size());
  ASSERT_FALSE(suggested.empty());
  for (std::size_t i = 0; i < suggested.size(); ++i) {
    EXPECT_NEAR(suggested[i].lines.length, mirrored[i].lines.length,
                0.03 * suggested[i].lines.length);
    EXPECT_NEAR(suggested[i].share_after, mirrored[i].share_after, 0.03);
  }
}

TEST(SuggestSeams, PiecesThatAreMirrorImagesAreCutAlike) {
  const TriMesh mesh = dome(1);
  const auto suggested = suggest_seams(mesh, flats::great_circle(mesh, 0, 0), {.count = 1});
  ASSERT_EQ(suggested.size(), 1u);
  const std::vector<Eigen::MatrixX3d>& lines = suggested[0].lines.points;
  ASSERT_GE(lines.size(), 2u);
  ASSERT_EQ(lines.size() % 2, 0u);
  for (std::size_t i = 0; i < lines.size() / 2; ++i) {
    const Eigen::MatrixX3d &left = lines[i], &right = lines[lines.size() / 2 + i];
    for (const Eigen::Index end : {Eigen::Index{0}, Eigen::Index{1}}) {
      const Eigen::RowVector3d a = end == 0 ? left.row(0) : left.row(left.rows() - 1);
      const Eigen::RowVector3d b = end == 0 ? right.row(0) : right.row(right.rows() - 1);
      EXPECT_NEAR(a.x(), -b.x(), 1e-9);
      EXPECT_NEAR(a.y(), b.y(), 1e-9);
      EXPECT_NEAR(a.z(), b.z(), 1e-9);
    }
  }
}

TEST(SuggestSeams, PiecesThatCostMoreAreFewer) {
  const TriMesh mesh = dome(1);
  SeamSuggestionOptions cheap, dear;
  cheap.count = dear.count = 2;
  cheap.share = dear.share = 1;
  cheap.piece_weight = 0;
  dear.piece_weight = 1;
  const auto pieces = [&](const SeamSuggestionOptions& options) {
    SeamedSurface surface{mesh, {}};
    int seam = 0;
    for (const SuggestedSeam& suggested : suggest_seams(mesh, {}, options))
      EXPECT_TRUE(surface.cut(suggested.cut, seam++));
    return cut_surface(surface.mesh, surface.seams).size();
  };
  EXPECT_LT(pieces(dear), pieces(cheap));
}

TEST(SuggestSeams, IsTheSameAtAnyNumberOfThreads) {
  const TriMesh mesh = dome(0.7);
  std::vector<SuggestedSeam> one, all;
  SeamSuggestionOptions options;
  options.count = 1;
  with_threads(1, [&] { one = suggest_seams(mesh, {}, options); });
  all = suggest_seams(mesh, {}, options);
  ASSERT_EQ(one.size(), all.size());
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].strain_after, all[0].strain_after);
  EXPECT_EQ(one[0].lines.length, all[0].lines.length);
}

TEST(SuggestSeams, CutsByLotAreAsLongAndTakeOutLess) {
  const TriMesh mesh = cone(0.6, 48, 16);
  SeamSuggestionOptions options;
  options.rule = SuggestionRule::chance;
  options.count = 1;
  const auto by_lot = suggest_seams(mesh, {}, options);
  ASSERT_EQ(by_lot.size(), 1u);
  EXPECT_NEAR(by_lot[0].lines.length, 1, 1.0 / 16);  // an edge
  EXPECT_LT(by_lot[0].share_after, 0.5);
}

}  // namespace
}  // namespace geoprior::sketch
