#include "models/paper/contact/contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "tests/paper/sheets.h"

namespace geoprior::paper {
namespace {

Obstacle plane(const Eigen::Vector3d& normal) {
  Obstacle obstacle;
  obstacle.kind = Obstacle::Kind::plane;
  obstacle.name = "plane";
  obstacle.axis = normal;
  return obstacle;
}

Obstacle sphere(const Eigen::Vector3d& centre, double radius) {
  Obstacle obstacle;
  obstacle.kind = Obstacle::Kind::sphere;
  obstacle.name = "sphere";
  obstacle.centre = centre;
  obstacle.radius = radius;
  return obstacle;
}

double least_gap(const Obstacle& obstacle, const ShellState& state) {
  double least = 1;
  for (Eigen::Index i = 0; i < state.x.rows(); ++i) {
    least = std::min(least, obstacle.contact(state.x.row(i).transpose(), state.time).distance);
  }
  return least;
}

/// Pressure of the contact is weight per area: k (d_c - gap) = rho g.
TEST(Contact, DroppedSheetRestsAtTheGapThatCarriesItsWeight) {
  for (const Integration integration : sheets::kIntegrations) {
    Sheet sheet = sheets::free_sheet(0.1, 0.1);
    sheet.gravity = {0, 0, -9.81};
    sheet.placement.translation().z() = 0.05;
    sheet.obstacles.push_back(plane(Eigen::Vector3d::UnitZ()));
    ShellState state = sheets::at_rest(sheet, 40);
    StepperOptions options;
    options.integration = integration;
    ShellStepper stepper(sheet, options, 1);
    stepper.set_mesh(state);
    RunContext context;
    for (int k = 0; k < 80; ++k) {
      stepper.step(state, 0.005, context);
      EXPECT_GT(least_gap(sheet.obstacles[0], state), 0) << "step " << k;
    }
    const double depth = sheet.material.area_density * 9.81 / options.contact_stiffness;
    for (Eigen::Index i = 0; i < state.x.rows(); ++i) {
      EXPECT_NEAR(state.x(i, 2), options.contact_distance - depth, 0.02 * depth);
    }
    EXPECT_LT(state.v.norm(), 1e-6);
    const double area = sheets::area(state.mesh);
    EXPECT_NEAR(stepper.energies(state).contact,
                options.contact_stiffness / 2 * depth * depth * area,
                0.02 * options.contact_stiffness * depth * depth * area);
  }
}

/// A sheet on a slope, friction mu: sticks below atan(mu), accelerates with g (sin - mu cos) above.
TEST(Contact, SheetOnASlopeSticksAndSlidesAsCoulombSays) {
  for (const Integration integration : sheets::kIntegrations) {
    for (const double slope : {0.25, 0.6}) {
      const double angle = std::atan(slope);
      Sheet sheet = sheets::free_sheet(0.1, 0.1);
      sheet.gravity = {0, 0, -9.81};
      sheet.material.friction = 0.4;
      sheet.obstacles.push_back(plane({std::sin(angle), 0, std::cos(angle)}));
      StepperOptions options;
      options.integration = integration;
      const Eigen::AngleAxisd tilt(angle, Eigen::Vector3d::UnitY());
      const double depth =
          sheet.material.area_density * 9.81 * std::cos(angle) / options.contact_stiffness;
      sheet.placement = Eigen::Isometry3d(tilt);
      sheet.placement.translation() = (options.contact_distance - depth) * sheet.obstacles[0].axis;
      ShellState state = sheets::at_rest(sheet, 40);
      ShellStepper stepper(sheet, options, 1);
      stepper.set_mesh(state);
      const int n = 80;
      const double dt = 0.0025;
      const Eigen::RowVector3d down(std::cos(angle), 0, -std::sin(angle));
      sheets::advance(stepper, state, dt, n);
      const double speed = down.dot(state.v.colwise().mean());
      if (slope < 0.4) {
        // Creep: s / sqrt(s^2 + s0^2) = slope / mu.
        const double ratio = slope / 0.4;
        EXPECT_NEAR(speed, options.creep_speed * ratio / std::sqrt(1 - ratio * ratio),
                    0.02 * options.creep_speed);
      } else {
        const double pull = 9.81 * (std::sin(angle) - 0.4 * std::cos(angle));
        EXPECT_NEAR(speed, pull * n * dt, 0.02 * pull * n * dt);
      }
    }
  }
}

/// Two triangles whose corners pass the sphere far away: only samples inside can stop them.
TEST(Contact, LongTrianglesDoNotSinkThroughASmallSphere) {
  for (const Integration integration : sheets::kIntegrations) {
    Sheet sheet = sheets::free_sheet(0.4, 0.3);
    sheet.gravity = {0, 0, -9.81};
    sheet.material.damping = 1e-3;
    sheet.placement.translation().z() = 0.06;
    sheet.obstacles.push_back(sphere({0.02, 0.01, 0}, 0.05));
    ShellState state = sheets::at_rest(sheet, 2);
    ASSERT_EQ(state.mesh.triangle_count(), 2);
    StepperOptions options;
    options.integration = integration;
    ShellStepper stepper(sheet, options, 1);
    stepper.set_mesh(state);
    RunContext context;
    for (int k = 0; k < 60; ++k) {
      stepper.step(state, 0.005, context);
      // The sheet may slide and tip, but never enters.
      double least = 1;
      for (int i = 0; i <= 40; ++i) {
        for (int j = 0; i + j <= 40; ++j) {
          for (Eigen::Index t = 0; t < 2; ++t) {
            const Eigen::Vector3i v = state.mesh.triangles.row(t);
            const Eigen::Vector3d p =
                (i * state.x.row(v[0]) + j * state.x.row(v[1]) + (40 - i - j) * state.x.row(v[2]))
                    .transpose() /
                40;
            least = std::min(least, sheet.obstacles[0].contact(p, state.time).distance);
          }
        }
      }
      EXPECT_GT(least, -options.contact_distance) << "step " << k;
    }
  }
}

TEST(Contact, RisingPlaneLiftsTheSheet) {
  for (const Integration integration : sheets::kIntegrations) {
    Sheet sheet = sheets::free_sheet(0.1, 0.1);
    sheet.gravity = {0, 0, -9.81};
    sheet.placement.translation().z() = 1e-3;
    sheet.obstacles.push_back(plane(Eigen::Vector3d::UnitZ()));
    Keyframe end;
    end.time = 0.5;
    end.shift = {0, 0, 0.2};
    sheet.obstacles[0].motion = Trajectory{{Keyframe{}, end}};
    ShellState state = sheets::at_rest(sheet, 40);
    StepperOptions options;
    options.integration = integration;
    ShellStepper stepper(sheet, options, 1);
    stepper.set_mesh(state);
    sheets::advance(stepper, state, 0.005, 120);
    EXPECT_GT(least_gap(sheet.obstacles[0], state), 0);
    EXPECT_LT((state.x.col(2).array() - 0.2).abs().maxCoeff(), 2 * options.contact_distance);
  }
}

/// The samples' areas are a quadrature: together they push with k times the area of the sheet.
TEST(Contact, SamplesShareTheAreaOfTheSheet) {
  const Sheet sheet = sheets::free_sheet(0.4, 0.3);
  for (const int triangles : {2, 40, 500}) {
    const ShellState state = sheets::at_rest(sheet, triangles);
    const auto term = make_obstacle_contact({plane(Eigen::Vector3d::UnitZ())}, state.mesh,
                                            {.stiffness = 3, .spacing = 0.02});
    std::vector<ContactPoint> points;
    term->find({state.x, nullptr, 0}, points);
    double sum = 0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (const ContactPoint& point : points) {
      sum += point.stiffness;
      for (int k = 0; k < point.count; ++k) {
        moment +=
            point.stiffness * point.weight[k] * state.mesh.pattern.row(point.vertex[k]).transpose();
      }
    }
    EXPECT_NEAR(sum, 3 * 0.12, 1e-12);
    EXPECT_LT(moment.norm(), 1e-12);
    EXPECT_GE(points.size(), 300U) << "at most 2 cm apart";
  }
}

}  // namespace
}  // namespace geoprior::paper
