#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "models/paper/contact/obstacle_shape.h"
#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {
namespace {

using ObstacleKind = Obstacle::Kind;

Obstacle obstacle(ObstacleKind kind) {
  Obstacle o;
  o.kind = kind;
  o.centre = {0.1, -0.2, 0.3};
  o.axis = Eigen::Vector3d(1, 2, 2) / 3;
  o.radius = 0.1;
  o.tube_radius = 0.02;
  return o;
}

const std::vector<ObstacleKind> kKinds{ObstacleKind::plane, ObstacleKind::sphere,
                                       ObstacleKind::cylinder, ObstacleKind::hollow_sphere,
                                       ObstacleKind::torus};

TEST(Obstacle, DistancesAreThoseOfElementaryGeometry) {
  const Eigen::Vector3d c = obstacle(ObstacleKind::plane).centre,
                        axis = obstacle(ObstacleKind::plane).axis;
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const Eigen::Vector3d x = c + 0.3 * axis + 0.4 * across;
  EXPECT_NEAR(obstacle(ObstacleKind::plane).contact(x, 0).distance, 0.3, 1e-15);
  EXPECT_NEAR(obstacle(ObstacleKind::sphere).contact(x, 0).distance, 0.5 - 0.1, 1e-15);
  EXPECT_NEAR(obstacle(ObstacleKind::hollow_sphere).contact(x, 0).distance, 0.1 - 0.5, 1e-15);
  EXPECT_NEAR(obstacle(ObstacleKind::cylinder).contact(x, 0).distance, 0.3, 1e-15);
  EXPECT_NEAR(obstacle(ObstacleKind::torus).contact(x, 0).distance, std::hypot(0.3, 0.3) - 0.02,
              1e-15);
  Obstacle capped = obstacle(ObstacleKind::cylinder);
  capped.half_length = 0.2;
  EXPECT_NEAR(capped.contact(x, 0).distance, std::hypot(0.3, 0.1), 1e-15);
  EXPECT_NEAR(capped.contact(c + 0.19 * axis, 0).distance, -0.01, 1e-15);
  EXPECT_NEAR(capped.contact(c + 0.09 * across, 0).distance, -0.01, 1e-15);
  EXPECT_NEAR(capped.contact(c - 0.25 * axis + 0.05 * across, 0).distance, 0.05, 1e-15);
}

// Central differences at random points; 1e-7 is their truncation and round-off for h = 1e-6.
TEST(Obstacle, NormalIsTheGradientOfTheDistance) {
  RandomStream random(3, "obstacle points");
  for (const ObstacleKind kind : kKinds) {
    Obstacle o = obstacle(kind);
    if (kind == ObstacleKind::cylinder) o.half_length = 0.15;
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d x =
          o.centre + 0.3 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
      Eigen::Vector3d gradient;
      for (int c = 0; c < 3; ++c) {
        const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(c);
        gradient[c] = (o.contact(x + h, 0).distance - o.contact(x - h, 0).distance) / 2e-6;
      }
      EXPECT_NEAR((gradient - o.contact(x, 0).normal).norm(), 0, 1e-7)
          << "kind " << static_cast<int>(kind) << ", point " << i;
    }
  }
}

// A sphere that moves 0.4 m in 2 s from rest to rest is fastest, 1.5 * 0.2 m/s, in the middle.
TEST(Obstacle, SurfaceMovesWithTheBody) {
  Obstacle o = obstacle(ObstacleKind::sphere);
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
  o.motion = Trajectory{{Keyframe{0, {0, 0, 0}, none}, Keyframe{2, {0.4, 0, 0}, none}}};
  const Eigen::Vector3d middle = o.centre + Eigen::Vector3d(0.2, 0, 0);
  const Obstacle::Contact contact = o.contact(middle + Eigen::Vector3d(0, 0.5, 0), 1);
  EXPECT_NEAR(contact.distance, 0.4, 1e-12);
  EXPECT_NEAR((contact.velocity - Eigen::Vector3d(0.3, 0, 0)).norm(), 0, 1e-6);
}

// Half a turn in 2 s: 1.5 * pi / 2 rad/s in the middle; speed at the rim is that times the radius.
TEST(Obstacle, SpinningCylinderDragsItsSurface) {
  Obstacle o = obstacle(ObstacleKind::cylinder);
  const auto turned = [&](double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, o.axis));
  };
  o.motion = Trajectory{{Keyframe{0, Eigen::Vector3d::Zero(), turned(0)},
                         Keyframe{2, Eigen::Vector3d::Zero(), turned(0.9 * std::numbers::pi)}}};
  const Eigen::Vector3d across = o.axis.unitOrthogonal();
  const Eigen::Vector3d velocity = o.contact(o.centre + 0.3 * across, 1).velocity;
  const double speed = 1.5 * 0.45 * std::numbers::pi * o.radius;
  EXPECT_NEAR((velocity - speed * o.axis.cross(across)).norm(), 0, 1e-6);
}

TEST(Obstacle, ShrinkingSphereClosesInFromOutside) {
  Obstacle o = obstacle(ObstacleKind::hollow_sphere);
  o.radii = {{1, 0.2}, {3, 0.1}};
  const Eigen::Vector3d x = o.centre + Eigen::Vector3d(0.05, 0, 0);
  EXPECT_NEAR(o.contact(x, 0).distance, 0.15, 1e-15);
  EXPECT_NEAR(o.contact(x, 2).distance, 0.1, 1e-15);
  EXPECT_NEAR(o.contact(x, 9).distance, 0.05, 1e-15);
  // 0.1 m in 2 s, towards the centre: along the normal.
  const Obstacle::Contact contact = o.contact(x, 2);
  EXPECT_NEAR((contact.normal + Eigen::Vector3d::UnitX()).norm(), 0, 1e-15);
  EXPECT_NEAR((contact.velocity - 0.05 * contact.normal).norm(), 0, 1e-9);
}

// The triangles that pictures show have their vertices on the surface that the sheet feels.
TEST(ObstaclePart, HasItsVerticesOnTheSurface) {
  Sheet sheet;
  sheet.pattern = rectangle_pattern(0.2, 0.2);
  EXPECT_FALSE(obstacle_part(sheet, 0).has_value());
  for (const ObstacleKind kind : kKinds) {
    sheet.obstacles = {obstacle(kind)};
    sheet.obstacles[0].half_length = kind == ObstacleKind::cylinder ? 0.15 : 0;
    const Part part = obstacle_part(sheet, 0).value();
    ASSERT_GT(part.triangles.rows(), 0);
    for (Eigen::Index i = 0; i < part.points.rows(); ++i) {
      EXPECT_NEAR(sheet.obstacles[0].contact(part.points.row(i).transpose(), 0).distance, 0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace geoprior::paper
