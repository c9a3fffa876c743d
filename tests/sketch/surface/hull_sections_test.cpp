// Sections of the hull: round where a drawn border says that a tube is open, the top view's where
// it is seen, boxes where corners are drawn.

#include "models/sketch/sections/hull_sections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/connectivity.h"
#include "core/geometry/topology.h"
#include "experiments/sketch/drawing/drawing_file.h"
#include "experiments/sketch/truth/known_solid.h"
#include "models/sketch/drawing/align_views.h"
#include "models/sketch/sketch_process.h"
#include "models/sketch/surface/cut_surface.h"
#include "models/sketch/surface/sketch_surface.h"
#include "tests/sketch/surface/drawn_solids.h"

namespace geoprior::sketch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct SolidCase {
  std::string name;
  KnownSolidOptions solid;
  double box_excess = 0.02;  ///< by which the box hull's area is off at least
};

class KnownSolids : public ::testing::TestWithParam<SolidCase> {
 protected:
  const KnownSolid solid_ = known_solid(GetParam().solid);
  const Drawing aligned_ = align_views(solid_.drawing);
  [[nodiscard]] SketchSurface surface(HullSections sections) const {
    return sketch_surface(aligned_, visual_hull(aligned_, {3000, sections}));
  }
  [[nodiscard]] double area_error(HullSections sections) const {
    const TriMesh mesh = surface(sections).hull.mesh;
    return triangle_areas(mesh.V, mesh.F).sum() / solid_.area - 1;
  }
};

INSTANTIATE_TEST_SUITE_P(
    Shapes, KnownSolids,
    ::testing::Values(SolidCase{"Lampshade", {SolidShape::lampshade}, 0.1},
                      SolidCase{"LampshadeOfTwoViews", {SolidShape::lampshade, false}, 0.2},
                      SolidCase{"Skirt", {SolidShape::skirt}, 0.05},
                      SolidCase{"SkirtOfTwoViews", {SolidShape::skirt, false}, 0.2},
                      SolidCase{"Sleeve", {SolidShape::sleeve}, 0.1},
                      SolidCase{"SleeveOfTwoViews", {SolidShape::sleeve, false}, 0.1},
                      SolidCase{"CuffOfTwoViews", {SolidShape::cuff, false}, 0.2},
                      SolidCase{"MittenOfTwoViews", {SolidShape::mitten, false}, 0.1}),
    [](const auto& solid) { return solid.param.name; });

TEST_P(KnownSolids, HaveTheirAreaWithinTwoPercent) {
  EXPECT_NEAR(area_error(HullSections::automatic), 0, 0.02);
  EXPECT_GT(area_error(HullSections::box), GetParam().box_excess);
}

TEST_P(KnownSolids, AreManifoldAndFillTheirSilhouettes) {
  const SketchSurface made = surface(HullSections::automatic);
  EXPECT_TRUE(non_manifold_edges(made.hull.mesh.F).empty());
  for (const OutlinedView& view : made.hull.views) {
    double low = 0, high = 0;
    for (Eigen::Index v = 0; v < made.hull.mesh.V.rows(); ++v) {
      const Eigen::Vector2d q = view.project(made.hull.mesh.V.row(v).transpose());
      EXPECT_LT(view.outline.nearest(q).distance, 0.01 * made.hull.spacing);
      low = std::min(low, q.x());
      high = std::max(high, q.x());
    }
    EXPECT_NEAR(low, std::min(0.0, view.outline.lowest().x()), 0.3 * made.hull.spacing);
    EXPECT_NEAR(high, view.outline.highest().x(), 0.3 * made.hull.spacing);
  }
}

// Corners in the top view are corners of the bag; without that view an opening is taken as round.
TEST(HullSections, OfABagWithCornersAreBoxes) {
  const KnownSolid bag = known_solid({SolidShape::bag});
  const Drawing aligned = align_views(bag.drawing);
  const SketchSurface surface = sketch_surface(aligned, visual_hull(aligned, {3000}));
  EXPECT_NEAR(triangle_areas(surface.hull.mesh.V, surface.hull.mesh.F).sum(), bag.area,
              0.005 * bag.area);
}

// Where sections are not the top view's, it still bounds them from the end of their axis.
TEST(TubeSections, GrowIntoTheCornersThatAViewFromTheEndShows) {
  KnownSolid bag = known_solid({SolidShape::bag});
  const Drawing aligned = align_views(bag.drawing);
  const std::vector<OutlinedView> views = outlined_views(aligned);
  const TubeSections tubes(views, rims_of(aligned, views), 1);
  ASSERT_FALSE(tubes.exponents().empty());
  for (const double n : tubes.exponents()[0]) EXPECT_GT(n, kBoxExponent);
}

TEST(TubeSections, OfACircleSeenFromTheEndKeepTheirExponent) {
  const Drawing aligned = align_views(known_solid({SolidShape::lampshade}).drawing);
  const std::vector<OutlinedView> views = outlined_views(aligned);
  const TubeSections tubes(views, rims_of(aligned, views), 1);
  EXPECT_EQ(tubes.tubes(), 1);
  for (const double n : tubes.exponents()[0]) EXPECT_EQ(n, 2);
}

// A tube of width w tilted by 30 degrees, cut at right angles: between the rims' corners its slices
// go on as if it were longer.
TEST(ViewSlices, GoOnBeyondASlantedRim) {
  const double c = std::cos(std::numbers::pi / 6), s = 0.5;
  const Eigen::Vector2d along(c, s), across(-s, c);
  const std::vector<Eigen::Vector2d> p{-0.1 * across, along - 0.1 * across, along + 0.1 * across,
                                       0.1 * across};
  Drawing drawing{"tube",
                  {View{ViewKind::front, {solids::stroke_of("o", StrokeKind::silhouette, p, true)}},
                   View{ViewKind::top, {solids::rectangle(c + 0.1, 0.2)}}}};
  drawing.views[0].strokes.push_back(
      solids::stroke_of("cuff", StrokeKind::border, {p[1], p[2]}, false));
  const std::vector<OutlinedView> views = outlined_views(drawing);
  const std::vector<Rim> rims = rims_of(drawing, views);
  ASSERT_EQ(rims.size(), 1U);
  EXPECT_EQ(rims[0].axis, 0);
  EXPECT_EQ(rims[0].id, "cuff");
  const ViewSlices with(views[0], 0, rims, 0), without(views[0], 0);
  EXPECT_NEAR(with.at(c).at(0).width(), 0.2 / c, 1e-9);
  EXPECT_LT(without.at(c).at(0).width(), 0.11 / c);
  EXPECT_NEAR(with.at(0.5).at(0).width(), 0.2 / c, 1e-9);
}

SectionReport report_of_drawing(const Drawing& drawing) {
  const Drawing aligned = align_views(drawing);
  return SectionBounds(aligned, outlined_views(aligned), HullSections::automatic).report();
}

TEST(SectionReport, SaysWhatWasDecided) {
  EXPECT_THAT(report_of_drawing(known_solid({SolidShape::lampshade}).drawing).text(),
              HasSubstr("the top view's outline at every height"));
  EXPECT_THAT(
      report_of_drawing(known_solid({SolidShape::lampshade, false}).drawing).text(),
      AllOf(HasSubstr("round across y (1 tube, exponent 2.0; ends: 'lower-rim', 'upper-rim')"),
            Not(HasSubstr("top view"))));
  EXPECT_THAT(report_of_drawing(known_solid({SolidShape::sleeve}).drawing).text(),
              HasSubstr("round across x"));
  EXPECT_THAT(report_of_drawing(solids::drawn_box(1, 1, 1)).text(), HasSubstr("boxes"));
}

// A boot's shaft is round, its foot is what the views see; a tunic's sleeves lie along x.
TEST(SectionReport, OfShippedDrawings) {
  const auto of_file = [](const std::string& name) {
    return report_of_drawing(
        read_drawing(std::string(GEOPRIOR_SOURCE_DIR) + "/experiments/sketch/" + name, {}).drawing);
  };
  const SectionReport boot = of_file("boot.svg");
  EXPECT_FALSE(boot.from_top);
  ASSERT_EQ(boot.tubes.size(), 1U);
  EXPECT_EQ(boot.tubes[0].axis, 1);
  EXPECT_LT(boot.tubes[0].most_exponent, 4);
  EXPECT_TRUE(of_file("hat-1.svg").from_top);
  const SectionReport tunic = of_file("tunic.svg");
  ASSERT_EQ(tunic.tubes.size(), 2U);
  EXPECT_EQ(tunic.tubes[0].axis, 0);
  EXPECT_EQ(tunic.tubes[0].count, 2);
}

// A brim runs out under the silhouettes of front and side, its cells near to those of both: none of
// them goes up to the crown, and a seam between the two makes two pieces.
TEST(TopSections, OfAHatHaveABrimWithoutSpikes) {
  const std::string file = std::string(GEOPRIOR_SOURCE_DIR) + "/experiments/sketch/hat-2.svg";
  const Drawing hat = align_views(read_drawing(file, {}).drawing);
  for (const int triangles : {3000, 6000, 8000}) {
    const VisualHull hull = visual_hull(hat, {triangles, HullSections::top});
    const EdgeConnectivity edges(hull.mesh.F);
    for (const Edge& e : edges.edges()) {
      const Eigen::RowVector3d a = hull.mesh.V.row(e[0]), b = hull.mesh.V.row(e[1]);
      const bool is_upright = std::max(a.y(), b.y()) < 0.1 && std::min(a.y(), b.y()) > 0.001;
      if (!is_upright) continue;
      EXPECT_LT((a - b).norm(), 4 * hull.spacing) << triangles << ": " << a;
    }
    const SketchSurface surface = sketch_surface(hat, hull);
    EXPECT_EQ(cut_surface(surface.hull.mesh, seam_edges(surface)).size(), 2U) << triangles;
  }
}

// The cuff's perimeter by Ramanujan's series is right to 1e-9 here.
TEST(KnownSolidAreas, OfAnEllipticCylinderIsPerimeterTimesHeight) {
  const double a = 0.06, b = 0.045, h = std::pow((a - b) / (a + b), 2);
  const double perimeter = std::numbers::pi * (a + b) * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h)));
  EXPECT_NEAR(known_solid({SolidShape::cuff}).area, 0.08 * perimeter, 1e-5 * 0.08 * perimeter);
}

}  // namespace
}  // namespace geoprior::sketch
