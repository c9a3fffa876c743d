// Details that are sampled or read: what a pattern promises holds on planes and on spheres.
#include "experiments/details/scene/pattern.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/details/scene/surfaces.h"
#include "models/details/surface_walk.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::details {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

using Points = std::vector<Eigen::Vector3d>;

Points points_of(const TriMesh& mesh, const std::vector<Detail>& details) {
  Points points;
  for (const Detail& d : details) points.push_back(position_of(d.at, mesh.V, mesh.F));
  return points;
}

std::vector<Detail> sampled(const TriMesh& mesh, const DetailPatternOptions& options) {
  return scatter(mesh, options, gradient_density(mesh, options.density));
}

/// Distance of each point to its nearest other one.
std::vector<double> nearest_distances(const Points& points) {
  std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < points.size(); ++j)
      if (i != j) nearest[i] = std::min(nearest[i], (points[i] - points[j]).norm());
  }
  return nearest;
}

double smallest(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

TEST(DetailPattern, PoissonDiskKeepsItsRadiusAndReachesItsCount) {
  const TriMesh plane = plane_surface(2, 1, 0.05);
  DetailPatternOptions options;
  options.count = 600;
  const Points points = points_of(plane, sampled(plane, options));
  EXPECT_EQ(points.size(), 600U);
  // Density 600 / 2 per m^2.
  EXPECT_GE(smallest(nearest_distances(points)), 0.78 / std::sqrt(300.0));
}

TEST(DetailPattern, PoissonDiskKeepsItsRadiusOnASphere) {
  const TriMesh sphere = sphere_surface(0.5, 0.05);
  DetailPatternOptions options;
  options.count = 400;
  const Points points = points_of(sphere, sampled(sphere, options));
  EXPECT_EQ(points.size(), 400U);
  const double area = triangle_areas(sphere.V, sphere.F).sum();
  EXPECT_GE(smallest(nearest_distances(points)), 0.78 * std::sqrt(area / 400));
}

// Density 1 at the left to 3 at the right: the left half has (1 + 2) / 2 of (1 + 3), 37.5 %, with a
// standard deviation of sqrt(0.375 x 0.625 / n).
TEST(DetailPattern, DensityFollowsTheGradient) {
  const TriMesh plane = plane_surface(1, 1, 0.1);
  DetailPatternOptions options;
  options.density = {DensityKind::gradient, {1, 0, 0}, 1, 3, ""};
  const auto left_share = [&] {
    const Points points = points_of(plane, sampled(plane, options));
    const auto left = std::count_if(points.begin(), points.end(),
                                    [](const Eigen::Vector3d& p) { return p.x() < 0; });
    return static_cast<double>(left) / static_cast<double>(points.size());
  };
  options.kind = PatternKind::uniform;
  options.count = 20000;
  EXPECT_NEAR(left_share(), 0.375, 4 * std::sqrt(0.375 * 0.625 / 20000));
  // Darts near saturation even the density out a little: within 5 % of the details.
  options.kind = PatternKind::poisson_disk;
  options.count = 2000;
  EXPECT_NEAR(left_share(), 0.375, 0.05 * 0.375);
}

// A square lattice of 20 x 20 in a square of 1 m.
TEST(DetailPattern, AGridWithoutJitterIsALattice) {
  const TriMesh plane = plane_surface(1, 1, 0.07);
  DetailPatternOptions options;
  options.kind = PatternKind::grid;
  options.count = 400;
  options.jitter = 0;
  const Points points = points_of(plane, sampled(plane, options));
  ASSERT_EQ(points.size(), 400U);
  for (const double d : nearest_distances(points)) EXPECT_NEAR(d, 0.05, 1e-12);
  // Shifts of up to half the jitter to either side leave at least 1 - jitter between neighbours.
  options.jitter = 0.6;
  EXPECT_GE(smallest(nearest_distances(points_of(plane, sampled(plane, options)))), 0.4 * 0.05);
}

// On a closed surface no disc is cut: clusters of six, whose members are within a diameter.
TEST(DetailPattern, ClustersHoldWhatTheySay) {
  const TriMesh sphere = sphere_surface(1, 0.05);
  DetailPatternOptions options;
  options.kind = PatternKind::clusters;
  options.count = 300;
  options.cluster_radius = 0.15;
  const Points points = points_of(sphere, sampled(sphere, options));
  EXPECT_EQ(points.size(), 300U);
  const double area = triangle_areas(sphere.V, sphere.F).sum();
  const double radius = 0.15 * std::sqrt(6 * area / 300);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d& first = points[i - i % 6];
    EXPECT_LE((points[i] - first).norm(), 2 * radius + 1e-12) << i;
  }
  // Along the surface at least a quarter of the radius; so nearly as much in space.
  EXPECT_GE(smallest(nearest_distances(points)), 0.25 * radius);
}

TEST(DetailPattern, RegionsMustAllHold) {
  const TriMesh sphere = sphere_surface(1, 0.05);
  DetailPatternOptions options;
  options.kind = PatternKind::uniform;
  options.count = 500;
  options.region.resize(3);
  options.region[0].direction = {1, 0, 0};
  options.region[1].kind = RegionKind::facing;
  options.region[1].angle_deg = 60;
  options.region[2] = {RegionKind::ball, {0, 0, 1}, {0, 0, 1}, 0.3, 60, true};
  const std::vector<Detail> details = sampled(sphere, options);
  EXPECT_EQ(details.size(), 500U);
  // A face counts by its centre: its corners are off by less than an edge.
  for (const Eigen::Vector3d& p : points_of(sphere, details)) {
    EXPECT_GT(p.x(), -0.05);
    EXPECT_GT(p.z(), std::cos(pi / 3) - 0.05);
    EXPECT_GT((p - Eigen::Vector3d::UnitZ()).norm(), 0.3 - 0.05);
  }
  options.region[0].point = {2, 0, 0};
  EXPECT_THAT(test::error_of([&] { sampled(sphere, options); }),
              HasSubstr("scene.pattern.region: holds no triangle"));
}

TEST(DetailPattern, TheSeedDecides) {
  const TriMesh sphere = sphere_surface(1, 0.1);
  DetailPatternOptions options;
  options.count = 100;
  options.types = 3;
  const auto same = [](const std::vector<Detail>& a, const std::vector<Detail>& b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](const Detail& x, const Detail& y) {
             return x.at.face == y.at.face && x.at.barycentric == y.at.barycentric &&
                    x.tangent_angle == y.tangent_angle && x.type == y.type;
           });
  };
  const std::vector<Detail> first = sampled(sphere, options);
  EXPECT_TRUE(same(first, sampled(sphere, options)));
  options.seed = 2;
  EXPECT_FALSE(same(first, sampled(sphere, options)));
}

TEST(DetailPattern, TangentsAreAligned) {
  const TriMesh plane = plane_surface(1, 1, 0.1);
  DetailPatternOptions options;
  options.count = 50;
  options.aligned = true;
  options.direction = {1, 2, 5};
  const SurfaceTopology topology(plane);
  Points x;
  for (Eigen::Index v = 0; v < plane.V.rows(); ++v) x.emplace_back(plane.V.row(v));
  const Eigen::Vector3d along = Eigen::Vector3d(1, 2, 0).normalized();
  for (const Detail& d : sampled(plane, options)) {
    const Eigen::Vector3d t = tangent_direction(d.at.face, d.tangent_angle, topology, x);
    EXPECT_NEAR(t.dot(along), 1, 1e-12);
  }
}

TEST(DetailPattern, WhatHasNoPlaceIsNamed) {
  const TriMesh sphere = sphere_surface(1, 0.2);
  DetailPatternOptions options;
  options.kind = PatternKind::grid;
  EXPECT_THAT(test::error_of([&] { sampled(sphere, options); }),
              HasSubstr("scene.pattern.kind: needs a flat surface"));
  options.kind = PatternKind::uniform;
  EXPECT_THAT(
      test::error_of([&] { scatter(sphere, options, Eigen::VectorXd::Zero(sphere.V.rows())); }),
      HasSubstr("scene.pattern.density: is 0 everywhere"));
  const Eigen::VectorXd largest = Eigen::VectorXd::Constant(sphere.V.rows(), 1.7e308);
  EXPECT_THAT(test::error_of([&] { scatter(sphere, options, largest); }),
              HasSubstr("scene.pattern.density: is too large"));
  options.region.resize(1);
  options.region[0].direction = {0, 0, 0};
  EXPECT_THAT(test::error_of([&] { sampled(sphere, options); }),
              HasSubstr("scene.pattern.region.0.direction: has no direction"));
}

// Areas: 4 pi r^2, 4 pi^2 R r, 4 pi r^2 + 2 pi r l; a mesh inscribed with edges e lacks about
// (e / r)^2 / 6 of it.
TEST(DetailSurfaces, HaveTheAreaOfTheirShape) {
  const auto area = [](const TriMesh& mesh) { return triangle_areas(mesh.V, mesh.F).sum(); };
  EXPECT_NEAR(area(plane_surface(2, 0.5, 0.03)), 1, 1e-12);
  EXPECT_NEAR(area(sphere_surface(0.5, 0.02)), pi, 2e-3);
  EXPECT_NEAR(area(torus_surface(0.5, 0.2, 0.01)), 4 * pi * pi * 0.1, 4e-3);
  EXPECT_NEAR(area(capsule_surface(0.2, 1, 0.01)), 4 * pi * 0.04 + 2 * pi * 0.2, 4e-3);
  EXPECT_GT(area(blob_surface(0.5, 0.2, 0.03)), 0);
}

TEST(DetailSurfaces, AreSoundScenes) {
  for (const TriMesh& mesh :
       {plane_surface(1, 0.7, 0.1), sphere_surface(0.5, 0.1), torus_surface(0.5, 0.2, 0.05),
        capsule_surface(0.2, 1, 0.05), blob_surface(0.5, 0.3, 0.1)}) {
    DetailScene scene;
    scene.surface = mesh;
    DetailPatternOptions options;
    options.count = 20;
    scene.details = sampled(mesh, options);
    scene.motion = std::make_shared<StoredMotion>(std::vector{mesh.V}, std::vector{0.0});
    EXPECT_NO_THROW(require_valid(scene));
    const bool is_open = mesh.V.col(2).isZero();
    if (!is_open) {
      EXPECT_GT(signed_volume(mesh.V, mesh.F), 0);
    }
  }
}

}  // namespace
}  // namespace geoprior::details
