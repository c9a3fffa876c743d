#include "models/embryo/surface/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "metrics/contact/self_contact.h"
#include "tests/embryo/surface/samples.h"

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

StructureMesh mesh_of(const Shape& shape, const SurfaceOptions& options = {}) {
  return solid_mesh(SolidField({{0, shape, {}}}, 0), options);
}

double volume_of(const StructureMesh& one) { return signed_volume(one.mesh.V, one.mesh.F); }

/// What every mesh must be.
void expect_good(const StructureMesh& one) {
  EXPECT_TRUE(samples::closed_manifold(one.mesh));
  EXPECT_EQ(intersecting_pairs(one.mesh.V, one.mesh.F), 0);
  EXPECT_GE(one.mesh.triangle_count(), 2000);
  EXPECT_GT(volume_of(one), 0);
  EXPECT_EQ(static_cast<int>(one.structure_of_triangle.size()), one.mesh.triangle_count());
}

void expect_sphere(const StructureMesh& one) {
  EXPECT_EQ(samples::euler_number(one.mesh), 2);
  EXPECT_EQ(samples::components(one.mesh), 1);
}

TEST(EmbryoMesh, EveryPrimitiveIsASphereOnItsAnalyticSurface) {
  const std::vector<Shape> shapes = {
      samples::turned(samples::ovoid({3, 0, 1}, {0.2, 0.5, 2}, 0.3), 1, {1, 2, 3}),
      samples::ovoid({0, 0, 0}, {1, 1, 1}), samples::cylinder({0, 1, 0}, 0.1, 3),
      samples::bent_duct(), samples::duct({{0, 0, 0}, {0, 0, 1}}, 0.3, 0.1)};
  for (const Shape& shape : shapes) {
    const StructureMesh one = mesh_of(shape);
    expect_good(one);
    expect_sphere(one);
    EXPECT_LE(one.deviation, 0.01 * smallest_radius(shape));
  }
}

// An inscribed polyhedron of edges about r/4 lacks less than 2 %; a capsule of edges about r/3
// less than 5 %.
TEST(EmbryoMesh, VolumesAreThoseOfEllipsoidsAndCapsules) {
  const double pi = std::numbers::pi;
  const double ellipsoid = 4 * pi / 3 * 0.5 * 0.7;
  EXPECT_NEAR(volume_of(mesh_of(samples::ovoid({0, 0, 0}, {0.5, 0.7, 1}))) / ellipsoid, 0.99, 0.01);
  // Of an egg: pi a b c times the integral of (1 + k w)^2 (1 - w^2) = 4/3 + 4/15 k^2.
  const double egg = pi * 0.5 * 0.7 * (4.0 / 3 + 4.0 / 15 * 0.16);
  EXPECT_NEAR(volume_of(mesh_of(samples::ovoid({0, 0, 0}, {0.5, 0.7, 1}, 0.4))) / egg, 0.99, 0.01);
  const double capsule = pi * 0.04 * (2 - 0.4) + 4 * pi / 3 * 0.008;
  EXPECT_NEAR(volume_of(mesh_of(samples::cylinder({0, 0, 0}, 0.2, 2))) / capsule, 0.975, 0.025);
  SurfaceOptions fine;
  fine.cell = 0.2;
  EXPECT_NEAR(volume_of(mesh_of(samples::cylinder({0, 0, 0}, 0.2, 2), fine)) / capsule, 1, 4e-3);
}

// Distance by 20 000 points of the ellipsoid's own surface, 2 % of its smallest radius apart.
TEST(EmbryoMesh, AnOvoidsVerticesAreWithinAHundredthOfItsSmallestRadius) {
  const Vector3d radii(0.5, 0.7, 1);
  const StructureMesh one = mesh_of(samples::ovoid({0, 0, 0}, radii));
  std::vector<Vector3d> surface;
  for (int i = 0; i < 20000; ++i) {
    const double z = 1 - (i + 0.5) / 10000, turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double ring = std::sqrt(1 - z * z);
    surface.push_back(
        radii.cwiseProduct(Vector3d(ring * std::cos(turn), ring * std::sin(turn), z)));
  }
  for (int v = 0; v < one.mesh.vertex_count(); v += 17) {
    const Vector3d x = one.mesh.V.row(v);
    const auto nearer = [&](const Vector3d& a, const Vector3d& b) {
      return (a - x).squaredNorm() < (b - x).squaredNorm();
    };
    const Vector3d foot = *std::min_element(surface.begin(), surface.end(), nearer);
    const Vector3d normal = foot.cwiseQuotient(radii.cwiseProduct(radii)).normalized();
    EXPECT_LE(std::abs((x - foot).dot(normal)), 0.01 * 0.5);
  }
}

TEST(EmbryoMesh, AHorseshoeIsOneSurfaceOfThreeStructures) {
  const std::vector<StructureMesh> meshes = day_meshes(samples::horseshoe());
  ASSERT_EQ(meshes.size(), 1u);
  expect_good(meshes[0]);
  expect_sphere(meshes[0]);
  EXPECT_EQ(meshes[0].structures, (std::vector<int>{0, 1, 2}));
  for (const int structure : {0, 1, 2})
    EXPECT_GT(std::count(meshes[0].structure_of_triangle.begin(),
                         meshes[0].structure_of_triangle.end(), structure),
              100);
  DayState apart = samples::horseshoe();
  apart.fused.clear();
  EXPECT_EQ(day_meshes(apart).size(), 3u) << "what touches does not fuse by itself";
}

// The septum's tip leaves the ovoid at a progress of 2.1 / 2.2; the rounded edge has eaten the last
// 3 % of the neck before, at 0.940.
TEST(EmbryoMesh, ASeptumDividesAnOvoidWhenItIsThroughAndNotBefore) {
  for (const double progress : {0.0, 0.3, 0.7, 0.9, 0.939}) {
    const std::vector<StructureMesh> meshes = day_meshes(samples::divided_ovoid(progress));
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_TRUE(samples::closed_manifold(meshes[0].mesh));
    expect_sphere(meshes[0]);
    if (progress == 0.7) expect_good(meshes[0]);
  }
  for (const double progress : {0.941, 1.0}) {
    const StructureMesh through = day_meshes(samples::divided_ovoid(progress)).at(0);
    expect_good(through);
    EXPECT_EQ(samples::components(through.mesh), 2);
    EXPECT_EQ(samples::euler_number(through.mesh), 4);
  }
}

TEST(EmbryoMesh, HalvesAreTheTwoComponentsOfTheWhole) {
  const std::vector<StructureMesh> halves = day_meshes(samples::halved_ovoid());
  ASSERT_EQ(halves.size(), 2u);
  for (const StructureMesh& half : halves) {
    expect_good(half);
    expect_sphere(half);
  }
  EXPECT_EQ(halves[0].structures, std::vector<int>{1});
  EXPECT_GT(halves[0].mesh.V.col(1).minCoeff(), 0.1 + 0.049) << "beyond the septum";
  EXPECT_LT(halves[1].mesh.V.col(1).maxCoeff(), 0.1 - 0.049);
  const double both = volume_of(halves[0]) + volume_of(halves[1]);
  const double whole = volume_of(day_meshes(samples::divided_ovoid(1))[0]);
  EXPECT_NEAR(both / whole, 1, 0.02);
}

TEST(EmbryoMesh, APlaneBesideTheWholeLeavesNothingAndSaysSo) {
  DayState day = samples::halved_ovoid();
  day.halves[0].cut.point.y() += 2;
  EXPECT_THROW(day_meshes(day), Error);
}

TEST(EmbryoMesh, ASeptumWiderThanTheWholeLeavesNothingAndSaysSo) {
  DayState day = samples::divided_ovoid(1);
  day.cuts[0].thickness = 2;
  EXPECT_THROW(day_meshes(day), Error);
}

TEST(EmbryoMesh, LandmarksHaveNoMesh) {
  DayState day = samples::horseshoe();
  Shape plane;
  plane.primitive = Primitive::plane;
  day.structures.push_back({3, plane});
  EXPECT_EQ(day_meshes(day).size(), 1u);
  EXPECT_TRUE(day_meshes(DayState{}).empty());
}

TEST(EmbryoMesh, TheSameBytesOnOneThreadAndOnTwo) {
  DayState day = samples::horseshoe();
  for (int i = 3; i < 12; ++i)
    day.structures.push_back({i, samples::cylinder({0, 2.0 * i, 0}, 0.1 * i, 0.7 * i)});
  std::vector<StructureMesh> one, two;
  with_threads(1, [&] { one = day_meshes(day); });
  with_threads(2, [&] { two = day_meshes(day); });
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].mesh.V, two[i].mesh.V);
    EXPECT_EQ(one[i].mesh.F, two[i].mesh.F);
    EXPECT_EQ(one[i].structure_of_triangle, two[i].structure_of_triangle);
  }
}

// Right from left by the mirror x -> -x: the vertices are each other's images to round-off.
TEST(EmbryoMesh, AMirroredStructureHasTheMirroredMesh) {
  for (const Shape& left :
       {samples::turned(samples::ovoid({1, 0.2, 0}, {0.4, 0.5, 0.9}, 0.2), 0.8, {1, 2, 3}),
        samples::bent_duct()}) {
    const StructureMesh a = mesh_of(left), b = mesh_of(samples::mirrored(left));
    ASSERT_EQ(a.mesh.vertex_count(), b.mesh.vertex_count());
    ASSERT_EQ(a.mesh.triangle_count(), b.mesh.triangle_count());
    EXPECT_NEAR(volume_of(a), volume_of(b), 1e-12);
    // By a slanted coordinate that no two vertices share.
    const Vector3d slant(0.31, 0.73, 0.61);
    Eigen::VectorXd from = a.mesh.V * slant,
                    image = b.mesh.V * slant.cwiseProduct(Vector3d(-1, 1, 1));
    std::sort(from.begin(), from.end());
    std::sort(image.begin(), image.end());
    EXPECT_LT((from - image).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(EmbryoMesh, AThinDuctIsFoundInOnePiece) {
  const Shape thread = samples::duct({{0, 0, 0}, {1, 0.3, 0.2}, {2, -0.2, 0.5}}, 0.004);
  const StructureMesh one = mesh_of(thread);
  expect_sphere(one);
  EXPECT_LE(one.deviation, 0.01 * 0.004);
}

TEST(EmbryoMesh, AskedForMoreTrianglesHasThem) {
  SurfaceOptions options;
  options.triangles = 20000;
  EXPECT_GE(mesh_of(samples::bent_duct(), options).mesh.triangle_count(), 20000);
  options.triangles = 200;
  EXPECT_GE(mesh_of(samples::ovoid({0, 0, 0}, {1, 1, 1}), options).mesh.triangle_count(), 200);
}

/// A small ovoid beside a large one that it blends with; the next is swallowed, and not waited for.
TEST(EmbryoMesh, EachStructureOfAGroupHasItsTriangles) {
  for (const double centre : {1.2, 0.5}) {
    DayState day;
    day.structures.push_back({0, samples::ovoid({0, 0, 0}, {1, 1, 1})});
    day.structures.push_back({1, samples::ovoid({centre, 0, 0}, {0.4, 0.4, 0.4})});
    day.fused.push_back({{0, 1}, 0.05});
    const auto meshes = day_meshes(day);
    ASSERT_EQ(meshes.size(), 1u);
    const auto& of = meshes[0].structure_of_triangle;
    EXPECT_GE(std::count(of.begin(), of.end(), 0), 2000);
    if (centre > 1) {
      EXPECT_GE(std::count(of.begin(), of.end(), 1), 2000);
    } else {
      EXPECT_LE(of.size(), 20000u);
    }
  }
}

}  // namespace
}  // namespace geoprior::embryo
