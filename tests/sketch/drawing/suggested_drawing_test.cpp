#include "experiments/sketch/drawing/suggested_drawing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "experiments/sketch/drawing/drawing_file.h"
#include "experiments/sketch/measures.h"
#include "models/sketch/drawing/align_views.h"
#include "models/sketch/sketch_process.h"
#include "tests/sketch/pattern/flat_surfaces.h"
#include "tests/sketch/surface/drawn_solids.h"

namespace geoprior::sketch {
namespace {

/// A level circle around a cylinder of radius 0.05 at half height, with its outward normals.
SuggestedSeam belt() {
  SuggestedSeam seam;
  constexpr int kPoints = 120;
  Eigen::MatrixX3d points(kPoints + 1, 3), normals(kPoints + 1, 3);
  for (int i = 0; i <= kPoints; ++i) {
    const double a = 2 * std::numbers::pi * i / kPoints;
    normals.row(i) << std::sin(a), 0, std::cos(a);
    points.row(i) = 0.05 * normals.row(i) + Eigen::RowVector3d(0, 0.15, 0);
  }
  seam.lines.points = {points};
  seam.lines.normals = {normals};
  seam.lines.length = 2 * std::numbers::pi * 0.05;
  return seam;
}

TEST(SuggestedDrawing, IsADrawingWhoseSeamsLieWhereTheCutsDo) {
  const Drawing aligned = align_views(solids::drawn_cylinder(0.1, 0.3, 180), {});
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "suggested_drawing_test.svg";
  std::ofstream(file) << suggested_drawing_svg(aligned, {belt()});
  const Drawing read = align_views(read_drawing(file, {}).drawing, {});
  std::filesystem::remove(file);
  ASSERT_EQ(read.views.size(), aligned.views.size());
  double drawn = 0;
  for (const View& view : read.views) {
    const OutlinedView seen{view.kind, {}, view_frame(view.kind)};
    for (const Stroke* stroke : strokes_of(view, StrokeKind::seam)) {
      EXPECT_NE(view.kind, ViewKind::top);  // which sees the belt edge on
      for (const Eigen::Vector2d& p : stroke->points) EXPECT_NEAR(p.y(), 0.15, 1e-5);
      drawn += length(*stroke);
    }
  }
  // A quarter of the circle that faces a view within 45 degrees is drawn as long as its chord.
  EXPECT_NEAR(drawn, 4 * std::numbers::sqrt2 * 0.05, 0.05 * drawn);
}

TEST(SuggestedDrawing, AStrokeOfTheFarSideSaysSo) {
  const Drawing aligned = align_views(solids::drawn_cylinder(0.1, 0.3, 180), {});
  const std::string svg = suggested_drawing_svg(aligned, {belt()});
  EXPECT_NE(svg.find("data-depth=\"back\""), std::string::npos);
  EXPECT_NE(svg.find("data-depth=\"front\""), std::string::npos);
}

TEST(CutMeasures, OfAPipeIsTheLengthOfItsSeam) {
  PreparedSketch prepared;
  prepared.surface.hull.mesh = flats::tube(0.1, 0.1, 0.7, 24, 14);
  const TriMesh& mesh = prepared.surface.hull.mesh;
  prepared.surface.border_of.assign(mesh.vertex_count(), -1);
  Frame frame = sketch_frame(prepared, mesh.V, 0);
  EXPECT_FALSE(cut_measures({}, frame).seam_length);
  add_pattern(frame, make_pattern(mesh, flats::tube_seam(24, 14)));
  frame.parts["suggestions"] = suggestions_part({belt(), belt()});
  const CutMeasures measures = cut_measures({}, frame);
  EXPECT_NEAR(*measures.seam_length, 0.7, 1e-12);
  EXPECT_EQ(*measures.suggestions, 2);
  const double circle = 120 * 2 * 0.05 * std::sin(std::numbers::pi / 120);
  EXPECT_NEAR(*measures.first_suggestion_length, circle, 1e-12);
  EXPECT_NEAR(*measures.suggested_length, 2 * circle, 1e-12);
}

TEST(AddSeam, CutsTheSurfaceAndKeepsItsSilhouettes) {
  const Drawing drawing = align_views(solids::drawn_cylinder(0.1, 0.3, 180), {});
  SketchSurface surface = sketch_surface(drawing, visual_hull(drawing, {.triangles = 2000}));
  const TriMesh before = surface.hull.mesh;
  // From the middle of the lid to the middle of the base, on edges and across triangles.
  const SurfacePaths paths(before, Eigen::VectorXd::Ones(before.triangle_count()));
  const auto nearest = [&](const Eigen::RowVector3d& x) {
    Eigen::Index v = 0;
    (before.V.rowwise() - x).rowwise().squaredNorm().minCoeff(&v);
    return static_cast<int>(v);
  };
  std::vector<char> targets(before.vertex_count(), 0);
  targets[nearest({0, 0, 0})] = 1;
  const SurfacePath path = paths.shortest(nearest({0, 0.3, 0}), targets);
  ASSERT_FALSE(path.empty());
  Eigen::MatrixX3d X = 2 * before.V;
  add_seam(surface, X, {{path}}, "dart");
  EXPECT_GT(surface.hull.mesh.vertex_count(), before.vertex_count());
  EXPECT_EQ((X - 2 * surface.hull.mesh.V).cwiseAbs().maxCoeff(), 0);
  ASSERT_EQ(surface.seams.size(), 1u);
  EXPECT_TRUE(surface.seams[0].points.empty());
  for (const auto& places : surface.hull.places)
    EXPECT_EQ(static_cast<int>(places.size()), surface.hull.mesh.vertex_count());
  EXPECT_EQ(static_cast<int>(surface.border_of.size()), surface.hull.mesh.vertex_count());
  const std::vector<CutPiece> pieces = cut_surface(surface.hull.mesh, seam_edges(surface));
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(pieces[0].is_disc());  // a slit closed surface
}

TEST(HullSections, OfTheTopViewAreRoundWhereItIsRound) {
  // A cone's frustum: the views alone see a pyramid's with its corners cut.
  Drawing drawing = solids::drawn_cylinder(0.2, 0.1, 360);
  for (int v = 0; v < 2; ++v)
    drawing.views[v].strokes[0].points = {{0, 0}, {0.2, 0}, {0.15, 0.1}, {0.05, 0.1}};
  const Drawing aligned = align_views(drawing, {});
  const auto worst = [&](HullSections sections) {
    const TriMesh mesh = visual_hull(aligned, {4000, sections}).mesh;
    double most = 0;
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
      const double radius = 0.1 - 0.5 * mesh.V(v, 1);
      most = std::max(most, std::hypot(mesh.V(v, 0), mesh.V(v, 2)) - radius);
    }
    return most;
  };
  EXPECT_LT(worst(HullSections::top), 4e-4);  // chords, and sections that are 0.2 % larger
  EXPECT_GT(worst(HullSections::box), 0.01);  // sqrt 2 times the radius at the top, less
}

}  // namespace
}  // namespace geoprior::sketch
