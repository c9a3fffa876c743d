#include "models/sketch/ridges/ridge_flips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "baselines/sketch/visual_hull/rounded_hull.h"
#include "core/geometry/topology.h"
#include "metrics/developability/crease_turning.h"
#include "metrics/developability/developability.h"
#include "models/sketch/sketch_process.h"
#include "solvers/sketch/several_views.h"
#include "tests/sketch/surface/drawn_solids.h"

namespace geoprior::sketch {
namespace {

SketchInput hull_input(Drawing drawing, int triangles, bool ridges) {
  SketchInput input;
  input.drawing = std::move(drawing);
  input.hull.triangles = triangles;
  input.hull.ridges = ridges;
  input.smoothing.fixed_border = false;
  return input;
}

/// Drawn from the front as an arch and from the side as a lens: ridges that are curves in space.
Drawing drawn_arch() {
  Drawing arch = solids::drawn_box(0.2, 0.3, 0.2);
  for (int v = 0; v < 2; ++v) {
    std::vector<Eigen::Vector2d> p{{0, 0}, {0.2, 0}};
    const double height = 0.3, low = v == 0 ? 0.2 : 0.1;
    for (int i = 0; i <= 24; ++i) {
      const double a = std::numbers::pi * i / 24;
      p.emplace_back(0.1 + 0.1 * std::cos(a), low + (height - low) * std::sin(a));
    }
    arch.views[v].strokes[0].points = p;
  }
  return arch;
}

TEST(RidgeFlips, EdgesOfTheHullRunAlongItsRidges) {
  const TriMesh teeth = prepare_sketch(hull_input(drawn_arch(), 3000, false)).surface.hull.mesh;
  TriMesh flipped = teeth;
  EXPECT_GT(flip_to_ridges(flipped), 20);
  EXPECT_TRUE(non_manifold_edges(flipped.F).empty());
  EXPECT_EQ((flipped.V - teeth.V).norm(), 0);
  const CreaseMeasures before = crease_measures(teeth), after = crease_measures(flipped);
  EXPECT_LT(after.rest_p95, before.rest_p95 + 1e-12);
  EXPECT_LT(after.saw_share * after.turning, 0.7 * before.saw_share * before.turning);
  // Nothing is left to flip.
  EXPECT_EQ(flip_to_ridges(flipped), 0);
}

TEST(RoundedHull, OfABoxHasFilletsOfTheRadiusAndFacesInPlace) {
  const PreparedSketch prepared =
      prepare_sketch(hull_input(solids::drawn_box(0.2, 0.3, 0.2), 4000, true));
  const VisualHull& hull = prepared.surface.hull;
  const double r = 0.05;
  const Eigen::MatrixX3d X = rounded_hull(prepared.surface, r);
  EXPECT_EQ((rounded_hull(prepared.surface, 0) - hull.mesh.V).norm(), 0);
  const Eigen::RowVector3d low = hull.mesh.V.colwise().minCoeff();
  const Eigen::RowVector3d high = hull.mesh.V.colwise().maxCoeff();
  int in_fillets = 0;
  for (Eigen::Index v = 0; v < X.rows(); ++v) {
    const Eigen::RowVector3d inner =
        X.row(v).cwiseMax((low.array() + r).matrix()).cwiseMin((high.array() - r).matrix());
    const Eigen::RowVector3d from = X.row(v) - inner;  // from the box of the ball's centres
    const double in_plan = std::hypot(from(0), from(2));
    if (std::abs(from(1)) > 1e-12 || std::abs(from(0)) < 1e-9 || std::abs(from(2)) < 1e-9) continue;
    EXPECT_NEAR(in_plan, r, 1e-3 * r);
    ++in_fillets;
  }
  EXPECT_GT(in_fillets, 100);
}

// The thesis' cones alone leave a saw; with averages along rulings first it is gone, and there are
// fewer angle defects for it.
TEST(RulingAverage, LeavesFewerCreasesAndFewerAngleDefectsThanConesAlone) {
  const PreparedSketch prepared = prepare_sketch(hull_input(drawn_arch(), 3000, true));
  RunContext context;
  const auto after = [&](double share) {
    SeveralViewsOptions options;
    options.fairing.share = share;
    const auto method = make_several_views(prepared, options);
    for (int i = 0; i < options.iterations; ++i) method->step(context);
    return TriMesh{method->positions(), prepared.surface.hull.mesh.F};
  };
  const TriMesh cones = after(0), fair = after(0.5);
  EXPECT_LT(crease_measures(fair).turning, 0.8 * crease_measures(cones).turning);
  EXPECT_LT(crease_measures(fair).rest_p95, 6 * kDegree);
  EXPECT_LT(developability_spread(fair).defect_sum, 1.1 * developability_spread(cones).defect_sum);
}

}  // namespace
}  // namespace geoprior::sketch
