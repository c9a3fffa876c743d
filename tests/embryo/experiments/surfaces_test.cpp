// What the measures of surfaces say of boxes and balls whose numbers are known.
#include "experiments/embryo/measures/surfaces.h"

#include <gtest/gtest.h>

#include "tests/embryo/experiments/planted.h"

namespace geoprior::embryo {
namespace {

using planted::add_line;
using planted::add_shape;
using planted::add_surface;
using planted::box;
using planted::empty_frame;
using planted::scene_of;

const Eigen::Vector3d kZero(0, 0, 0), kOne(1, 1, 1);

TEST(EmbryoSurfaces, AClosedBoxHasNoDefectAndIsASphere) {
  const EmbryoScene scene = scene_of({"a"});
  Frame frame = empty_frame(40);
  add_surface(frame, 0, box(kZero, kOne));
  const SurfaceMeasures m = surface_measures(scene, frame);
  EXPECT_EQ(m.structures, 1);
  EXPECT_EQ(m.triangles, 12);
  EXPECT_EQ(m.least_triangles, 12);
  EXPECT_EQ(m.defects, 0);
  EXPECT_EQ(m.not_spheres, 0);
  EXPECT_EQ(m.pieces, 1);
}

TEST(EmbryoSurfaces, AMissingTriangleIsSeen) {
  const EmbryoScene scene = scene_of({"a"});
  Frame frame = empty_frame(40);
  TriMesh open = box(kZero, kOne);
  open.F.conservativeResize(11, 3);
  add_surface(frame, 0, open);
  const SurfaceMeasures m = surface_measures(scene, frame);
  EXPECT_EQ(m.defects, 3) << "border edges";
  EXPECT_EQ(m.not_spheres, 1);
}

TEST(EmbryoSurfaces, OverlapsCountOnlyWithoutADeclaredContact) {
  EmbryoScene scene = scene_of({"a", "b", "c"});
  Frame frame = empty_frame(40);
  add_surface(frame, 0, box(kZero, kOne));
  add_surface(frame, 1, box({0.9, 0.2, 0.2}, {1.9, 0.8, 0.8}));
  add_surface(frame, 2, box({3, 0, 0}, {4, 1, 1}));
  EXPECT_NEAR(surface_measures(scene, frame).overlap.value(), 0.1, 1e-12);
  scene.ontology.structures[1].touches = {0};
  EXPECT_EQ(surface_measures(scene, frame).overlap.value(), 0);
}

TEST(EmbryoSurfaces, PiecesWithKidneysAreCounted) {
  EmbryoScene scene = scene_of({"a", "b", "c"});
  scene.ontology.structures[0].kind = scene.ontology.structures[1].kind = "kidney";
  Frame apart = empty_frame(40);
  add_surface(apart, 0, box(kZero, kOne));
  add_surface(apart, 1, box({2, 0, 0}, {3, 1, 1}));
  add_surface(apart, 2, box({4, 0, 0}, {5, 1, 1}));
  EXPECT_EQ(surface_measures(scene, apart).kidney_pieces.value(), 2);
  Frame fused = empty_frame(40);
  add_surface(fused, 0, box(kZero, kOne));
  Eigen::MatrixXd& codes = fused.parts.at(recorded::kSurface).arrays.front().values;
  codes.bottomRows(6).setConstant(1);
  const SurfaceMeasures m = surface_measures(scene, fused);
  EXPECT_EQ(m.kidney_pieces.value(), 1);
  EXPECT_EQ(m.structures, 2);
  EXPECT_NEAR(m.seam_deg.value(), 90, 1e-9) << "the structures meet along edges of the box";
}

TEST(EmbryoSurfaces, PiecesOfADivisionAreThoseOfTheWholeAndOfItsProducts) {
  EmbryoScene scene = scene_of({"half", "other half", "whole"});
  ProcessEntry division;
  division.kind = ProcessKind::division;
  division.acts_on = {2};
  division.produces = {0, 1};
  scene.ontology.processes = {division};
  Frame frame = empty_frame(40);
  add_surface(frame, 2, box(kZero, kOne));
  EXPECT_EQ(surface_measures(scene, frame).cloaca_pieces.value(), 1);
  Frame after = empty_frame(50);
  add_surface(after, 0, box(kZero, kOne));
  add_surface(after, 1, box({2, 0, 0}, {3, 1, 1}));
  EXPECT_EQ(surface_measures(scene, after).cloaca_pieces.value(), 2);
}

/// An octahedron's corners are on the ball; its triangles are not looked at.
TriMesh octahedron(const Eigen::Vector3d& radii) {
  TriMesh mesh;
  mesh.V.resize(6, 3);
  mesh.V << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  mesh.V = mesh.V * radii.asDiagonal();
  mesh.F.resize(8, 3);
  mesh.F << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
  return mesh;
}

TEST(EmbryoSurfaces, DistanceFromAnOvoidIsFirstOrderExact) {
  const EmbryoScene scene = scene_of({"a"});
  const Eigen::Vector3d radii(1, 2, 3);
  Frame on = empty_frame(40);
  add_surface(on, 0, octahedron(radii));
  add_shape(on, 0, Primitive::ovoid, kZero, radii);
  EXPECT_NEAR(surface_measures(scene, on).surface_error.value(), 0, 1e-12);
  Frame off = empty_frame(40);
  add_surface(off, 0, octahedron({1, 2, 3.03}));
  add_shape(off, 0, Primitive::ovoid, kZero, radii);
  EXPECT_NEAR(surface_measures(scene, off).surface_error.value(), 0.03, 1e-3)
      << "over the smallest radius, 1";
}

TEST(EmbryoSurfaces, DistanceFromADuctIsThatOfRoundCones) {
  const EmbryoScene scene = scene_of({"a"});
  Frame frame = empty_frame(40);
  add_surface(frame, 0, octahedron({1, 1, 3}));
  add_shape(frame, 0, Primitive::duct, kZero, kZero);
  Eigen::MatrixX3d line(2, 3);
  line << 0, 0, -2, 0, 0, 2;
  add_line(frame, 0, line, 1);
  EXPECT_NEAR(surface_measures(scene, frame).surface_error.value(), 0, 1e-12)
      << "a capsule of radius 1 from -3 to 3 has all six corners";
}

}  // namespace
}  // namespace geoprior::embryo
