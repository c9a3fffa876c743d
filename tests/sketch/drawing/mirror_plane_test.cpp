#include "solvers/sketch/drawing/mirror_plane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "core/random.h"
#include "solvers/sketch/drawing/symmetric_pairs.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Stroke plane_vector(const std::string& name, const Eigen::Vector2d& tail,
                    const Eigen::Vector3d& vector) {
  Stroke stroke;
  stroke.id = "stroke-" + name;
  stroke.kind = StrokeKind::plane_vector;
  stroke.points = {tail, tail + vector.head<2>()};
  stroke.side = vector.z() >= 0 ? DepthSide::front : DepthSide::back;
  stroke.name = name;
  return stroke;
}

/// Orthogonal vectors of one length in space, and the plane that they span.
struct VectorsInSpace {
  Eigen::Vector3d a, b, normal;
};

VectorsInSpace random_vectors(RandomStream& random) {
  Eigen::Quaterniond q(random.normal(), random.normal(), random.normal(), random.normal());
  const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
  const double length = 0.2 + random.uniform();
  Eigen::Vector3d normal = R.col(2);
  if (normal.z() < 0) normal = -normal;
  return {length * R.col(0), length * R.col(1), normal};
}

/// Whether the plane is more than three degrees from both ways in which it is refused.
bool is_generic(const VectorsInSpace& v) {
  return v.normal.z() > 0.05 && v.normal.head<2>().norm() > 0.05;
}

// The plane is known from the vectors in space; the drawing has their images only.
TEST(MirrorPlane, IsRecoveredFromTheImagesOfTwoOrthogonalVectors) {
  RandomStream random(3, "mirror planes");
  int checked = 0;
  for (int k = 0; k < 500; ++k) {
    const VectorsInSpace v = random_vectors(random);
    if (!is_generic(v)) continue;
    const Eigen::Vector2d tail(random.normal(), random.normal());
    const MirrorPlane plane =
        mirror_planes(plane_vector("sym-a", tail, v.a), plane_vector("sym-b", tail, v.b)).chosen;
    EXPECT_LT((plane.normal - v.normal).norm(), 1e-10) << "case " << k;
    EXPECT_NEAR(plane.offset, v.normal.head<2>().dot(tail), 1e-10);
    ++checked;
  }
  EXPECT_GT(checked, 400);
}

// Lying in the picture's plane a vector has depth 0 and its own mark says nothing: b's decides.
TEST(MirrorPlane, TakesTheSignOfBWhereALiesInThePicture) {
  const Eigen::Vector3d a(0, 1, 0), b(std::cos(0.7), 0, -std::sin(0.7));
  const MirrorPlanes planes =
      mirror_planes(plane_vector("sym-a", {0, 0}, a), plane_vector("sym-b", {0, 0}, b));
  Eigen::Vector3d normal = a.cross(b);
  normal *= normal.z() < 0 ? -1 : 1;
  EXPECT_LT((planes.chosen.normal - normal).norm(), 1e-12);
}

TEST(MirrorPlane, TheOtherReadingIsTheShapeMirroredInDepth) {
  const Eigen::Matrix3d R = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized().toRotationMatrix();
  const MirrorPlanes planes = mirror_planes(plane_vector("sym-a", {1, 2}, R.col(0)),
                                            plane_vector("sym-b", {1, 2}, R.col(1)));
  const Eigen::Vector3d n = planes.chosen.normal;
  EXPECT_LT((planes.other.normal - Eigen::Vector3d(-n.x(), -n.y(), n.z())).norm(), 1e-12);
}

TEST(MirrorPlane, TakesTheRatioOfLengthsFromTheCaller) {
  const Eigen::Matrix3d R = Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized().toRotationMatrix();
  Eigen::Vector3d normal = R.col(2);
  normal *= normal.z() < 0 ? -1 : 1;
  const Stroke a = plane_vector("sym-a", {0, 0}, 3 * R.col(0));
  const Stroke b = plane_vector("sym-b", {0, 0}, R.col(1));
  EXPECT_LT((mirror_planes(a, b, 3).chosen.normal - normal).norm(), 1e-10);
  EXPECT_GT((mirror_planes(a, b, 1).chosen.normal - normal).norm(), 0.1);
}

TEST(MirrorPlane, RefusesWhatDoesNotDetermineDepth) {
  const auto refusal = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return test::error_of([&] {
      mirror_planes(plane_vector("sym-a", {0, 0}, a), plane_vector("sym-b", {0, 0}, b));
    });
  };
  EXPECT_THAT(refusal({1, 1, 0.5}, {2, 2, -0.3}),
              AllOf(HasSubstr("edge on"), HasSubstr("stroke-sym-a"), HasSubstr("stroke-sym-b")));
  EXPECT_THAT(refusal({1, 0, 0}, {0, 1, 0}), HasSubstr("faces the eye"));
  EXPECT_THAT(refusal({0, 0, 1}, {0, 1, 0}),
              AllOf(HasSubstr("no length"), HasSubstr("stroke-sym-a")));
}

TEST(MirrorPlane, RefusesMissingAndRepeatedVectors) {
  View view;
  view.kind = ViewKind::photo;
  view.strokes = {plane_vector("sym-a", {0, 0}, {1, 0, 1})};
  EXPECT_THAT(test::error_of([&] { drawn_mirror_planes(view); }), HasSubstr("no vector sym-b"));
  view.strokes.push_back(view.strokes.front());
  EXPECT_THAT(test::error_of([&] { drawn_mirror_planes(view); }), HasSubstr("drawn twice"));
}

// Any point, mirrored in space, gives a pair whose depths are known.
TEST(SymmetricPairs, DepthIsExactForEveryPair) {
  RandomStream random(5, "pairs");
  for (int k = 0; k < 200; ++k) {
    const VectorsInSpace v = random_vectors(random);
    if (!is_generic(v)) continue;
    const MirrorPlane plane{v.normal, random.normal()};
    const Eigen::Vector3d p(random.normal(), random.normal(), random.normal());
    const Eigen::Vector3d image = mirrored(plane, p);
    const PairDepths depths = pair_depths(plane, p.head<2>(), image.head<2>());
    EXPECT_NEAR(depths.z, p.z(), 1e-10);
    EXPECT_NEAR(depths.z_image, image.z(), 1e-10);
  }
}

}  // namespace
}  // namespace geoprior::sketch
