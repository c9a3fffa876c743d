#include "solvers/sketch/several_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "metrics/developability/developability.h"
#include "models/sketch/drawing/traced_stroke.h"
#include "solvers/sketch/surface/pinned_transfer.h"
#include "solvers/sketch/surface/zippering.h"
#include "tests/sketch/surface/drawn_solids.h"
#include "tests/sketch/surface/flow_shapes.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;

/// A bottle: its belly is round from above, its neck narrower.
Drawing drawn_bottle() {
  Drawing drawing = solids::drawn_cylinder(0.1, 0.3, 180);
  for (int v = 0; v < 2; ++v) {
    std::vector<Eigen::Vector2d> p{{0, 0}, {0.1, 0}};
    for (int i = 0; i <= 40; ++i) {
      const double t = i / 40.0;
      p.emplace_back(0.1 - 0.03 * std::pow(std::sin(std::numbers::pi / 2 * t), 4), 0.3 * t);
    }
    for (int i = 40; i > 0; --i) {
      const double t = i / 40.0;
      p.emplace_back(0.03 * std::pow(std::sin(std::numbers::pi / 2 * t), 4), 0.3 * t);
    }
    drawing.views[v].strokes[0].points = p;
  }
  return drawing;
}

SketchInput input_of(Drawing drawing, int triangles) {
  SketchInput input;
  input.drawing = std::move(drawing);
  input.hull.triangles = triangles;
  input.smoothing.fixed_border = false;
  return input;
}

double total_defect(const Eigen::MatrixX3d& X, const PreparedSketch& prepared) {
  return developability_spread({X, prepared.surface.hull.mesh.F}).defect_sum;
}

TEST(PinnedTransfer, TurnsTheWholeSurfaceWithItsPins) {
  const SketchInput input = input_of(drawn_bottle(), 1000);
  const PreparedSketch prepared = prepare_sketch(input);
  const TriMesh mesh{prepared.start, prepared.surface.hull.mesh.F};
  const Eigen::Matrix3d R(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  const Eigen::MatrixX3d turned = mesh.V * R.transpose();
  CoordinatePins pins(mesh.vertex_count());
  for (int c = 0; c < 3; ++c) pins.set(3 + c, c, turned(3 + c, c));
  PinnedTransfer transfer(mesh.F, mesh.vertex_count());
  const std::vector<Eigen::Matrix3d> rotations(mesh.F.rows(), R);
  EXPECT_LT((transfer.solve(mesh.V, rotations, pins) - turned).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(PinnedTransfer, MeetsPinsExactlyAndKeepsTheMeanOfAFreeCoordinate) {
  const PreparedSketch prepared = prepare_sketch(input_of(drawn_bottle(), 1000));
  const Eigen::MatrixX3d& X = prepared.start;
  CoordinatePins pins(static_cast<int>(X.rows()));
  pins.set(10, 0, 0.25);
  pins.set(90, 0, -0.5);
  PinnedTransfer transfer(prepared.surface.hull.mesh.F, static_cast<int>(X.rows()));
  const std::vector<Eigen::Matrix3d> still(prepared.surface.hull.mesh.F.rows(),
                                           Eigen::Matrix3d::Identity());
  const Eigen::MatrixX3d solved = transfer.solve(X, still, pins);
  EXPECT_EQ(solved(10, 0), 0.25);
  EXPECT_EQ(solved(90, 0), -0.5);
  EXPECT_LT((solved.col(1) - X.col(1)).cwiseAbs().maxCoeff(), 1e-10);
}

// Thesis, equation 2.1 as it stands: on a round patch the axis is the mean normal, a needle, and
// the outer normals are turned towards it or away. A cylinder asks for nothing with either guard.
TEST(DevelopableRotation, LeavesACylinderAlone) {
  TriMesh tube;
  tube.V.resize(60 * 10, 3);
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 10; ++j) {
      const double a = 2 * std::numbers::pi * i / 60;
      tube.V.row(i * 10 + j) << std::cos(a), std::sin(a), 0.1 * j;
    }
  }
  tube.F.resize(60 * 9 * 2, 3);
  for (int i = 0, t = 0; i < 60; ++i) {
    for (int j = 0; j < 9; ++j) {
      const int a = i * 10 + j, b = (i + 1) % 60 * 10 + j;
      tube.F.row(t++) << a, b, a + 1;
      tube.F.row(t++) << b, b + 1, a + 1;
    }
  }
  const DevelopableRotation guarded(tube.F, tube.vertex_count(), {});
  for (const Eigen::Matrix3d& R : guarded.rotations(triangle_normals(tube)))
    EXPECT_LT((R - Eigen::Matrix3d::Identity()).norm(), 1e-6);
}

/// Sum of |angle defect| that the iterations add to a surface given in a drawing's place.
double added_defect(const TriMesh& mesh, double fairing = 0) {
  SketchInput input;
  input.surface = mesh;
  const PreparedSketch prepared = prepare_sketch(input);
  SeveralViewsOptions options;
  options.fairing.share = fairing;
  const auto method = make_several_views(prepared, options);
  RunContext context;
  for (int i = 0; i < options.iterations; ++i) method->step(context);
  return total_defect(method->positions(), prepared) - total_defect(mesh.V, prepared);
}

// What is developable already has nothing to be turned for; what is not, is changed. Averages along
// rulings lie on one side of a triangle at a border, and bend it a little.
TEST(SeveralViews, DevelopableInputStays) {
  EXPECT_LT(added_defect(flow_shapes::cone()), 1e-3);
  EXPECT_LT(added_defect(flow_shapes::cylinder()), 1e-3);
  EXPECT_LT(added_defect(flow_shapes::tent()), 1e-3);
  EXPECT_LT(added_defect(flow_shapes::cone(), 0.5), 0.1);
  EXPECT_LT(added_defect(flow_shapes::cylinder(), 0.5), 0.1);
  EXPECT_GT(std::abs(added_defect(flow_shapes::noisy(flow_shapes::cylinder(), 0.002))), 0.1);
}

TEST(DevelopableRotation, LiteralFitDivergesWhereTheGuardedOneConverges) {
  const PreparedSketch prepared = prepare_sketch(input_of(drawn_bottle(), 3000));
  RunContext context;
  const double start = total_defect(prepared.start, prepared);
  const auto after = [&](ConeFit fit) {
    SeveralViewsOptions options;
    options.developability = {.fit = fit, .relaxation = 1};
    options.fairing.share = 0;
    const auto method = make_several_views(prepared, options);
    for (int i = 0; i < 10; ++i) method->step(context);
    return total_defect(method->positions(), prepared);
  };
  EXPECT_LT(after(ConeFit::guarded), 0.9 * start);
  EXPECT_GT(after(ConeFit::literal), 1.2 * start);
}

TEST(Zippering, CoversTheWholeSilhouetteOfTheHull) {
  const PreparedSketch prepared = prepare_sketch(input_of(drawn_bottle(), 3000));
  const VisualHull& hull = prepared.surface.hull;
  const EdgeConnectivity edges(hull.mesh.F);
  for (std::size_t view = 0; view < hull.views.size(); ++view) {
    const Zippering zippering(hull.views[view], hull.places[view], edges.edges());
    const ZippedSilhouette zipped = zippering.close(hull.mesh.V, prepared.start);
    EXPECT_TRUE(zipped.gaps.empty());
    EXPECT_GT(zipped.edges.size(), 20U);
  }
}

// Of two edges over the same stretch the one that was pushed outward is chosen.
TEST(Zippering, ChoosesTheEdgeThatProtrudesMost) {
  const VisualHull hull =
      visual_hull(align_views(solids::drawn_box(0.2, 0.3, 0.1)), {.triangles = 600});
  const EdgeConnectivity edges(hull.mesh.F);
  const Zippering zippering(hull.views[0], hull.places[0], edges.edges());
  // All vertices retreat along x, but for those of one depth.
  Eigen::MatrixX3d X = hull.mesh.V;
  const double depth = hull.mesh.V.col(2).maxCoeff();
  for (Eigen::Index v = 0; v < X.rows(); ++v) {
    if (std::abs(X(v, 2) - depth) > 1e-12) X(v, 0) *= 0.9;
  }
  int at_depth = 0, elsewhere = 0;
  for (const Edge& e : zippering.close(hull.mesh.V, X).edges) {
    const bool upright = std::abs(std::abs(hull.mesh.V(e[0], 0)) - 0.1) < 1e-9 &&
                         std::abs(std::abs(hull.mesh.V(e[1], 0)) - 0.1) < 1e-9;
    if (!upright) continue;
    const bool near = std::abs(hull.mesh.V(e[0], 2) - depth) < 1e-9 &&
                      std::abs(hull.mesh.V(e[1], 2) - depth) < 1e-9;
    ++(near ? at_depth : elsewhere);
  }
  EXPECT_GT(at_depth, 0);
  EXPECT_EQ(elsewhere, 0);
}

TEST(SeveralViews, SurfaceEndsAtTheSilhouettesAndBordersStayOnTheirStrokes) {
  Drawing drawing = drawn_bottle();
  drawing.views[0].strokes.push_back(
      solids::stroke_of("mouth", StrokeKind::border, {{0.03, 0.3}, {0.07, 0.3}}, false));
  drawing.views[1].strokes.push_back(drawing.views[0].strokes.back());
  const PreparedSketch prepared = prepare_sketch(input_of(drawing, 3000));
  EXPECT_FALSE(boundary_edges(prepared.surface.hull.mesh.F).empty());
  SeveralViewsOptions options;
  options.iterations = 4;
  const auto method = make_several_views(prepared, options);
  RunContext context;
  for (int i = 0; i < options.iterations; ++i) method->step(context);
  for (const Edge& e : boundary_edges(prepared.surface.hull.mesh.F))
    EXPECT_NEAR(method->positions()(e[0], 1), 0.3, 1e-12);
  // What lies between chosen edges is off by what chords of the bottom's circle are, h^2 / 8r.
  const double chord = prepared.surface.hull.spacing * prepared.surface.hull.spacing / 0.4;
  EXPECT_NEAR(method->positions().col(0).maxCoeff(), 0.05, chord);
  EXPECT_NEAR(method->positions().col(1).minCoeff(), 0, chord);
}

TEST(SeveralViews, GivesTheSameBytesAtAnyThreadCount) {
  const auto run = [](int threads) {
    Eigen::MatrixX3d X;
    with_threads(threads, [&] {
      const PreparedSketch prepared = prepare_sketch(input_of(drawn_bottle(), 2000));
      const auto method = make_several_views(prepared, {});
      RunContext context;
      for (int i = 0; i < 4; ++i) method->step(context);
      X = method->positions();
    });
    return X;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(SketchSurface, SeamAroundABoxIsAClosedPathThatCutsIt) {
  Drawing drawing = solids::drawn_box(0.2, 0.3, 0.1);
  Stroke belt = solids::stroke_of("belt", StrokeKind::seam, {{0, 0.1}, {0.2, 0.14}}, false);
  belt.side = DepthSide::both;
  drawing.views[0].strokes.push_back(belt);
  const PreparedSketch prepared = prepare_sketch(input_of(drawing, 1500));
  const StrokePath& seam = prepared.surface.seams.at(0);
  std::map<int, int> degree;
  for (const Edge& e : seam.edges) {
    for (const int v : e) ++degree[v];
  }
  for (const auto& [v, count] : degree) EXPECT_EQ(count, 2);
  const Eigen::MatrixX3d& V = prepared.surface.hull.mesh.V;
  const MadePattern made =
      make_pattern({V, prepared.surface.hull.mesh.F}, seam_edges(prepared.surface), {});
  EXPECT_EQ(made.pattern.pieces.size(), 2U);
}

TEST(SketchSurface, NamesStrokesThatLeaveTheSurface) {
  const auto refusal = [](Stroke stroke) {
    Drawing drawing = solids::drawn_box(0.2, 0.3, 0.1);
    drawing.views[0].strokes.push_back(std::move(stroke));
    try {
      prepare_sketch(input_of(drawing, 600));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal(solids::stroke_of("s1", StrokeKind::seam, {{0.1, 0.1}, {0.9, 0.1}}, false)),
              HasSubstr("view front, stroke 's1': leaves the surface"));
  EXPECT_THAT(refusal(solids::stroke_of("f1", StrokeKind::fold, {{0.5, 0.1}, {0.9, 0.1}}, false)),
              HasSubstr("view front, stroke 'f1': leaves the surface"));
  EXPECT_THAT(
      refusal(solids::stroke_of("b1", StrokeKind::border, {{0.1, 0.1}, {0.15, 0.1}}, false)),
      HasSubstr("view front, stroke 'b1': is not drawn along the silhouette"));
  EXPECT_THAT(refusal(solids::stroke_of("b2", StrokeKind::border, {{0, 0.1}, {0.2, 0.1}}, false)),
              HasSubstr("view front, stroke 'b2': is not drawn along the silhouette"))
      << "from rim to rim across the front";
}

// A fold across the front of a box asks for 60 degrees between normal and view direction.
TEST(FoldRotation, TurnsTrianglesOnAFoldToItsAngle) {
  Drawing drawing = solids::drawn_box(0.2, 0.3, 0.1);
  drawing.views[0].strokes.push_back(
      solids::stroke_of("f1", StrokeKind::fold, {{0.02, 0.15}, {0.18, 0.15}}, false));
  const PreparedSketch prepared = prepare_sketch(input_of(drawing, 1500));
  const FoldRotation fold(prepared.surface, {});
  ASSERT_FALSE(fold.empty());
  const TriMesh& mesh = prepared.surface.hull.mesh;
  const Eigen::MatrixX3d normals = triangle_normals(mesh);
  std::vector<Eigen::Matrix3d> rotations(mesh.F.rows(), Eigen::Matrix3d::Identity());
  fold.blend(mesh.V, normals, rotations);
  for (const int t : fold.on_fold()) {
    const Eigen::Vector3d turned = rotations[t] * normals.row(t).transpose();
    EXPECT_NEAR(turned.z(), 0.5, 1e-9);
  }
  double least = 1;
  for (const FoldRotation::Demand& demand : fold.demands()) least = std::min(least, demand.weight);
  EXPECT_LT(least, 0.2) << "fades";
}

}  // namespace
}  // namespace geoprior::sketch
