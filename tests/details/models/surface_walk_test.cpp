#include "models/details/surface_walk.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/details/detail_scenes.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

std::vector<Eigen::Vector3d> rows(const Eigen::MatrixX3d& V) {
  std::vector<Eigen::Vector3d> x;
  for (Eigen::Index v = 0; v < V.rows(); ++v) x.emplace_back(V.row(v).transpose());
  return x;
}

TEST(SurfaceWalk, ReachesTheNearestPointOfASphere) {
  const TriMesh mesh = shapes::sphere(5);
  const SurfaceTopology surface(mesh);
  const auto x = rows(mesh.V);
  RandomStream random(1, "targets");
  for (int i = 0; i < 200; ++i) {
    Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
    direction.normalize();
    SurfacePoint start;
    start.face = static_cast<int>(random.below(static_cast<std::uint32_t>(mesh.F.rows())));
    const Eigen::Vector3d from = position_of(start, surface, x);
    if (from.dot(direction) < 0.3) continue;  // beyond, the distance has its maximum in between
    const SurfacePoint p = walk_to_nearest(start, 1.1 * direction, surface, x);
    // Edges of the facets span 0.05: the nearest point is off the direction by their tilt at most.
    EXPECT_LT((position_of(p, surface, x) - direction).norm(), 0.01);
    EXPECT_NEAR(p.barycentric.sum(), 1, 1e-12);
  }
}

TEST(SurfaceWalk, AStraightPathKeepsItsLengthOverAFold) {
  // The square folded by 90 degrees along x = 1/2: a path that crosses the fold at any angle is a
  // straight line in the plane that unfolds it.
  TriMesh mesh = shapes::square(20);
  const auto flat = rows(mesh.V);
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    if (mesh.V(v, 0) <= 0.5) continue;
    mesh.V(v, 2) = mesh.V(v, 0) - 0.5;
    mesh.V(v, 0) = 0.5;
  }
  const SurfaceTopology surface(mesh);
  const auto folded = rows(mesh.V);
  const SurfacePoint start{42, {0.2, 0.3, 0.5}};
  const Eigen::Vector3d from = position_of(start, surface, flat);
  for (const double angle : {-0.3, 0.1, 0.7}) {
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0);
    const SurfacePoint end = trace_straight(start, direction, 0.55, surface, folded);
    const Eigen::Vector3d expected = from + 0.55 * direction;
    if (expected.y() < 0 || expected.y() > 1) continue;
    EXPECT_LT((position_of(end, surface, flat) - expected).norm(), 1e-9) << angle;
  }
}

TEST(SurfaceWalk, TangentAnglesAreInverse) {
  const TriMesh mesh = shapes::sphere(2);
  const SurfaceTopology surface(mesh);
  const auto x = rows(mesh.V);
  for (const double angle : {-2.0, 0.0, 1.3})
    EXPECT_NEAR(tangent_angle(17, tangent_direction(17, angle, surface, x), surface, x), angle,
                1e-12);
}

}  // namespace
}  // namespace geoprior::details
