#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <vector>

#include "baselines/sketch/flatten/lscm.h"
#include "baselines/sketch/visual_hull/exact_hull.h"
#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "experiments/sketch/fabrication/cloth_files.h"
#include "experiments/sketch/garment_measures.h"
#include "experiments/sketch/truth/closed_form_surface.h"
#include "metrics/developability/developability.h"
#include "metrics/isometry/flattening.h"
#include "models/sketch/sketch_process.h"
#include "models/sketch/surface/collapse_edges.h"
#include "solvers/sketch/several_views.h"
#include "solvers/sketch/surface/fold_rotation.h"
#include "solvers/sketch/surface/zippering.h"
#include "testbed/formats/mesh/obj_reader.h"
#include "tests/sketch/surface/drawn_solids.h"

namespace geoprior::sketch {
namespace {

SketchInput garment_input(Drawing drawing, int triangles) {
  SketchInput input;
  input.drawing = std::move(drawing);
  input.hull.triangles = triangles;
  input.smoothing.fixed_border = false;
  return input;
}

Drawing box_with(Stroke stroke) {
  Drawing drawing = solids::drawn_box(0.2, 0.3, 0.1);
  drawing.views[0].strokes.push_back(std::move(stroke));
  return drawing;
}

Stroke inner_border(std::vector<Eigen::Vector2d> points, bool closed) {
  Stroke stroke = solids::stroke_of("opening", StrokeKind::border, std::move(points), closed);
  stroke.inside = true;
  return stroke;
}

int euler_characteristic(const TriMesh& mesh) {
  const EdgeConnectivity edges(mesh.F);
  return mesh.vertex_count() - edges.edge_count() + mesh.triangle_count();
}

double surface_area(const TriMesh& mesh) {
  double area = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::RowVector3d u = mesh.V.row(mesh.F(t, 1)) - a, v = mesh.V.row(mesh.F(t, 2)) - a;
    area += u.cross(v).norm() / 2;
  }
  return area;
}

// A sphere with a slit is a disc.
TEST(InnerBorder, AnOpenLineIsASlitWithTwoSides) {
  const PreparedSketch prepared = prepare_sketch(
      garment_input(box_with(inner_border({{0.1, 0.05}, {0.1, 0.25}}, false)), 1500));
  const TriMesh& mesh = prepared.surface.hull.mesh;
  EXPECT_EQ(euler_characteristic(mesh), 1);
  double length = 0;
  for (const Edge& e : boundary_edges(mesh.F)) {
    length += (mesh.V.row(e[0]) - mesh.V.row(e[1])).norm();
    for (const int v : e) {
      EXPECT_NEAR(mesh.V(v, 2), 0.05, 1e-9) << "on the front alone";
      EXPECT_GE(prepared.surface.border_of[v], 0);
    }
  }
  // Ends are met to the nearest vertex, on both sides.
  EXPECT_NEAR(length, 2 * 0.2, 4 * prepared.surface.hull.spacing);
}

// The front loses what lies within, up to where the path of edges leaves the line by a sixth of an
// edge; the back loses nothing.
TEST(InnerBorder, AClosedLineIsAHoleInItsSide) {
  const PreparedSketch whole =
      prepare_sketch(garment_input(solids::drawn_box(0.2, 0.3, 0.1), 3000));
  const PreparedSketch open = prepare_sketch(garment_input(
      box_with(inner_border({{0.05, 0.1}, {0.15, 0.1}, {0.15, 0.2}, {0.05, 0.2}}, true)), 3000));
  const TriMesh& mesh = open.surface.hull.mesh;
  EXPECT_EQ(euler_characteristic(mesh), 1);
  const double lost = surface_area(whole.surface.hull.mesh) - surface_area(mesh);
  EXPECT_NEAR(lost, 0.01, 0.4 * open.surface.hull.spacing / 6);
  for (const Edge& e : boundary_edges(mesh.F)) EXPECT_NEAR(mesh.V(e[0], 2), 0.05, 1e-9);
}

std::vector<Eigen::Vector3d> turned_normals(std::optional<FoldSide> side, DepthSide depth) {
  Stroke stroke = solids::stroke_of("f", StrokeKind::fold, {{0.1, 0.02}, {0.1, 0.28}}, false);
  stroke.fold_side = side;
  stroke.side = depth;
  const PreparedSketch prepared = prepare_sketch(garment_input(box_with(stroke), 1500));
  const FoldRotation fold(prepared.surface, {});
  const TriMesh& mesh = prepared.surface.hull.mesh;
  const Eigen::MatrixX3d normals = triangle_normals(mesh);
  std::vector<Eigen::Matrix3d> rotations(mesh.F.rows(), Eigen::Matrix3d::Identity());
  fold.blend(mesh.V, normals, rotations);
  std::vector<Eigen::Vector3d> turned;
  for (const int t : fold.on_fold()) turned.push_back(rotations[t] * normals.row(t).transpose());
  return turned;
}

// Drawn upwards on a front that faces the eye: 60 degrees to the left is (-sin 60, 0, cos 60), and
// on the back it is the same side of the page.
TEST(FoldRotation, FallsAwayToTheDrawnSide) {
  const double sine = std::sqrt(3.0) / 2;
  for (const Eigen::Vector3d& n : turned_normals(FoldSide::left, DepthSide::front))
    EXPECT_LT((n - Eigen::Vector3d(-sine, 0, 0.5)).norm(), 0.02);
  for (const Eigen::Vector3d& n : turned_normals(FoldSide::right, DepthSide::front))
    EXPECT_LT((n - Eigen::Vector3d(sine, 0, 0.5)).norm(), 0.02);
  for (const Eigen::Vector3d& n : turned_normals(FoldSide::left, DepthSide::back))
    EXPECT_LT((n - Eigen::Vector3d(-sine, 0, -0.5)).norm(), 0.02);
}

TEST(FoldRotation, AllOfAFoldFallsToOneSide) {
  const std::vector<Eigen::Vector3d> turned = turned_normals({}, DepthSide::front);
  ASSERT_GT(turned.size(), 20U);
  const double side = turned.front().x();
  for (const Eigen::Vector3d& n : turned) EXPECT_GT(n.x() * side, 0.7);
}

// On the upright sides of a box all edges cover as well: the planar choice takes those in the
// middle of its depth.
TEST(Zippering, PlanarChoiceTakesEdgesOfTheMiddle) {
  const VisualHull hull =
      visual_hull(align_views(solids::drawn_box(0.2, 0.3, 0.1)), {.triangles = 600});
  const EdgeConnectivity edges(hull.mesh.F);
  const Zippering zippering(hull.views[0], hull.places[0], edges.edges(), SilhouetteChoice::planar);
  const ZippedSilhouette zipped = zippering.close(hull.mesh.V, hull.mesh.V);
  ASSERT_FALSE(zipped.edges.empty());
  for (const Edge& e : zipped.edges) {
    EXPECT_LT(std::abs(hull.mesh.V(e[0], 2)), 1.5 * hull.spacing);
    EXPECT_LT(std::abs(hull.mesh.V(e[1], 2)), 1.5 * hull.spacing);
  }
}

// Octahedron whose lower tip is split into an edge of length 1e-6: its collapse leaves the
// octahedron. A tetrahedron has nothing to lose.
TEST(CollapseShortEdges, MergesCoincidentVerticesAndStaysAManifold) {
  TriMesh mesh;
  mesh.V.resize(7, 3);
  mesh.V << 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0, 0, 0, 1, 5e-7, 0, -1, -5e-7, 0, -1;
  mesh.F.resize(10, 3);
  mesh.F << 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 0, 3, 5, 2, 1, 6, 3, 2, 6, 1, 5, 6, 3, 6,
      5;
  require_closed_manifold(mesh, "octahedron", "test");
  EXPECT_EQ(collapse_short_edges(mesh, 1e-3), 1);
  EXPECT_EQ(mesh.V.rows(), 6);
  EXPECT_EQ(mesh.F.rows(), 8);
  EXPECT_NO_THROW(require_closed_manifold(mesh, "octahedron", "test"));
  EXPECT_NEAR(signed_volume(mesh.V, mesh.F), 4.0 / 3, 1e-5);
  TriMesh tetrahedron;
  tetrahedron.V.resize(4, 3);
  tetrahedron.V << 0, 0, 0, 1e-6, 0, 0, 0, 1, 0, 0, 0, 1;
  tetrahedron.F.resize(4, 3);
  tetrahedron.F << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  EXPECT_EQ(collapse_short_edges(tetrahedron, 1e-3), 0);
}

TEST(ExactHull, OfABoxIsTheBox) {
  const VisualHull hull =
      exact_hull(align_views(solids::drawn_box(0.2, 0.3, 0.1)), {.triangles = 1000});
  EXPECT_NO_THROW(require_closed_manifold(hull.mesh, "hull", "test"));
  EXPECT_NEAR(signed_volume(hull.mesh.V, hull.mesh.F), 0.2 * 0.3 * 0.1, 1e-12);
  EXPECT_GT(hull.mesh.F.rows(), 600);
  EXPECT_LT(hull.mesh.F.rows(), 1600);
}

// Both hulls of a drawn cylinder are the prism over the drawn polygon.
TEST(ExactHull, AgreesWithTheHullOfSignedDistances) {
  const Drawing aligned = align_views(solids::drawn_cylinder(0.1, 0.2, 90));
  const VisualHull exact = exact_hull(aligned, {.triangles = 4000});
  const VisualHull ours = visual_hull(aligned, {.triangles = 4000});
  EXPECT_NEAR(signed_volume(ours.mesh.V, ours.mesh.F) / signed_volume(exact.mesh.V, exact.mesh.F),
              1, 2e-3);
}

TEST(KnownSurface, VerticesLieOnTheirShapes) {
  ClosedFormOptions cap{.radius = 0.2, .angle_deg = 50, .rings = 30};
  const TriMesh sphere = closed_form_surface(cap);
  for (Eigen::Index v = 0; v < sphere.V.rows(); ++v)
    EXPECT_NEAR(sphere.V.row(v).norm(), 0.2, 1e-15);
  const double area = 2 * std::numbers::pi * 0.04 * (1 - std::cos(50 * kDegree));
  EXPECT_NEAR(surface_area(sphere) / area, 1, 1e-3);
  for (Eigen::Index t = 0; t < sphere.F.rows(); ++t)
    EXPECT_GT(triangle_normals(sphere).row(t).dot(sphere.V.row(sphere.F(t, 0))), 0);
  EXPECT_THROW(closed_form_surface(
                   {.shape = ClosedFormShape::cone_sector, .angle_deg = 160, .wrap_deg = 90}),
               Error);
}

/// Flattening of a surface that is one piece.
FlatteningSummary flattened(const TriMesh& mesh, const PatternOptions& options) {
  const MadePattern made = make_pattern(mesh, {}, options);
  const PatternPiece& piece = made.pattern.pieces.at(0);
  FlatPiece flat{piece.points, Eigen::MatrixX3d(piece.points.rows(), 3), piece.triangles};
  for (Eigen::Index v = 0; v < piece.points.rows(); ++v)
    flat.x.row(v) = mesh.V.row(piece.surface_vertex[v]);
  return flattening({&flat, 1});
}

// A cone's mesh is developable up to chords; a cap's rim is shorter than any flat disc's with its
// area: whatever lays it flat stretches.
TEST(KnownSurface, TheConeIsLaidFlatAndTheCapIsNot) {
  PatternOptions lscm;
  lscm.lay_disc = [](const TriMesh& disc) { return flatten_lscm(disc); };
  const TriMesh cone =
      closed_form_surface({.shape = ClosedFormShape::cone_sector, .angle_deg = 90, .rings = 30});
  EXPECT_LT(flattened(cone, {}).stretch_mean - 1, 1e-3);
  EXPECT_LT(flattened(cone, lscm).stretch_mean - 1, 5e-3);
  const TriMesh cap = closed_form_surface({.angle_deg = 60, .rings = 20});
  const double rigid = flattened(cap, {}).stretch_mean - 1;
  EXPECT_GT(rigid, 0.02);
  EXPECT_GT(flattened(cap, lscm).stretch_mean - 1, rigid) << "conformal maps keep no lengths";
}

/// A box with a seam around it and a fold, as a frame of its hull.
struct BoxScene {
  SketchScene scene;
  PreparedSketch prepared;
};
BoxScene box_scene() {
  BoxScene made;
  Drawing drawing =
      box_with(solids::stroke_of("f", StrokeKind::fold, {{0.02, 0.2}, {0.18, 0.2}}, false));
  Stroke belt = solids::stroke_of("belt", StrokeKind::seam, {{0, 0.1}, {0.2, 0.1}}, false);
  belt.side = DepthSide::both;
  drawing.views[0].strokes.push_back(belt);
  made.scene.input = garment_input(drawing, 1500);
  made.scene.aligned = align_views(drawing);
  for (const OutlinedView& view : outlined_views(made.scene.aligned))
    made.scene.silhouettes.push_back({view.kind, view.frame, view.outline.points()});
  made.prepared = prepare_sketch(made.scene.input);
  return made;
}

// The front of a box faces the eye: 60 degrees from the 60 that a fold asks for.
TEST(GarmentMeasures, OfABoxAreKnown) {
  const BoxScene box = box_scene();
  const Eigen::MatrixX3d& V = box.prepared.surface.hull.mesh.V;
  Frame frame = sketch_frame(box.prepared, V, 0);
  const FoldMeasures fold = fold_measures(box.scene, frame);
  EXPECT_NEAR(fold.mean_deg.value(), 60, 1e-9);
  EXPECT_NEAR(fold.max_deg.value(), 60, 1e-9);
  EXPECT_FALSE(generator_measures(box.scene, frame).range) << "no pattern yet";
  add_pattern(frame, make_pattern({V, box.prepared.surface.hull.mesh.F},
                                  seam_edges(box.prepared.surface), {}));
  // The hull cuts edges of the box by a part of its spacing; a box beside the plane is off by twice
  // its way.
  EXPECT_LT(mirror_percent(box.scene, frame).value(), 1);
  const double diagonal = std::sqrt(0.04 + 0.09 + 0.01);
  frame.parts.at("surface").points.col(0).array() += 0.05 * diagonal;
  EXPECT_NEAR(mirror_percent(box.scene, frame).value(), 10, 1);
  frame.parts.at("surface").points.col(0).array() -= 0.05 * diagonal;
  EXPECT_NEAR(generator_measures(box.scene, frame).range.value(), 0, 1e-9);
  EXPECT_GT(gauss_measures(box.scene, frame).great.value(), 0.05) << "five faces of a box";
  EXPECT_GE(seam_point_measures(box.scene, frame).shift_percent.value(), 0);
}

// Seams are pinned to their stroke; moved by a hundredth of the diagonal they are off by 1 %.
TEST(GarmentMeasures, PinResidualIsTheDistanceFromTheStroke) {
  const BoxScene box = box_scene();
  Eigen::MatrixX3d X = box.prepared.surface.hull.mesh.V;
  const double diagonal = std::hypot(0.2, 0.3);
  for (const Edge& e : box.prepared.surface.seams.at(0).edges) {
    for (const int v : e) X(v, 1) = 0.1;
  }
  EXPECT_NEAR(stroke_measures(box.scene, sketch_frame(box.prepared, X, 0)).off_percent.value(), 0,
              1e-9);
  for (const Edge& e : box.prepared.surface.seams.at(0).edges) {
    for (const int v : e) X(v, 1) = 0.1 + diagonal / 100;
  }
  EXPECT_NEAR(stroke_measures(box.scene, sketch_frame(box.prepared, X, 0)).off_percent.value(), 1,
              1e-9);
}

// Each group as the OBJ reader sees it: material distances are those of the pattern, and what is
// sewn together coincides in space.
TEST(ClothFiles, KeepMaterialDistancesAndSeams) {
  const BoxScene box = box_scene();
  const TriMesh mesh = box.prepared.surface.hull.mesh;
  const MadePattern made = make_pattern(mesh, seam_edges(box.prepared.surface), {});
  const std::vector<FabricationFile> files = cloth_files(made.pattern, mesh.V);
  ASSERT_EQ(files.size(), 2U);
  const TriMesh read = parse_obj(files[0].bytes, files[0].name).mesh;
  std::vector<Eigen::Vector2d> material;
  std::istringstream lines(files[0].bytes);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    Eigen::Vector2d p;
    if (words >> word && word == "vt" && words >> p.x() >> p.y()) material.push_back(p);
  }
  ASSERT_EQ(std::ssize(material), read.V.rows());
  std::size_t first = 0;
  Eigen::Index t = 0;
  for (const PatternPiece& piece : made.pattern.pieces) {
    for (Eigen::Index i = 0; i < piece.triangles.rows(); ++i, ++t) {
      for (int k = 0; k < 3; ++k) {
        const int a = piece.triangles(i, k), b = piece.triangles(i, (k + 1) % 3);
        ASSERT_EQ(read.F(t, k), static_cast<int>(first) + a);
        EXPECT_NEAR((material[first + a] - material[first + b]).norm(),
                    (piece.points.row(a) - piece.points.row(b)).norm(), 1e-6);
        EXPECT_EQ(read.V.row(read.F(t, k)), mesh.V.row(piece.surface_vertex[a]));
      }
    }
    first += static_cast<std::size_t>(piece.points.rows());
  }
  const nlohmann::json sewn = nlohmann::json::parse(files[1].bytes);
  int pairs = 0;
  for (const auto& seam : sewn["seams"]) {
    for (const auto& pair : seam["pairs"]) {
      EXPECT_NE(pair[0], pair[1]);
      EXPECT_EQ(read.V.row(pair[0].get<int>()), read.V.row(pair[1].get<int>()));
      ++pairs;
    }
  }
  EXPECT_GT(pairs, 20);
}

}  // namespace
}  // namespace geoprior::sketch
