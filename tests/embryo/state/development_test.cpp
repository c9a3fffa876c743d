#include "solvers/embryo/state/development.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <thread>

#include "core/error.h"
#include "metrics/tracks/velocity_jump.h"
#include "tests/embryo/state/small_body.h"

namespace geoprior::embryo {
namespace {

using small_body::add;
using small_body::add_duct;
using small_body::add_ovoid;
using small_body::add_process;

Shape shape_at(const DayState& state, int structure) { return find_state(state, structure)->shape; }

/// Left and right kidneys that rise, grow and turn, a bladder, ureters, and a landmark.
struct SmallSystem {
  Ontology ontology = small_body::bare();
  int bladder = add(ontology, "Bladder");
  int landmark = add(ontology, "Landmark");
  int left = add(ontology, "LeftKidney");
  int left_ureter = add(ontology, "LeftUreter");
  int right = add(ontology, "RightKidney");
  int right_ureter = add(ontology, "RightUreter");
  int left_growth = 0, left_ascent = 1, left_rotation = 2, left_fixation = 3, stop = 8;

  SmallSystem() {
    for (const int stage : {0, 3})
      add_ovoid(ontology, bladder, stage, {0, -0.1, -0.2},
                (stage + 1) * Eigen::Vector3d(2e-4, 2e-4, 3e-4))
          .egg = 0.2;
    small_body::add_key(ontology, landmark, 0, Primitive::point).geometry.position << 0, 0.05, 0.06;
    for (const double side : {1.0, -1.0}) {
      const int kidney = side > 0 ? left : right, ureter = side > 0 ? left_ureter : right_ureter;
      const std::vector<double> rise{-0.1, -0.05, 0.04, 0.12};
      for (int stage = 0; stage < 4; ++stage) {
        Geometry& g =
            add_ovoid(ontology, kidney, stage, {side * (0.1 + 0.01 * stage), 0.02, rise[stage]},
                      (1 + 0.5 * stage * stage) * Eigen::Vector3d(1e-4, 1.5e-4, 3e-4));
        g.axis = Eigen::Vector3d(-0.1 * side, 0, 1).normalized();
        g.up = {0, -1, 0};
        Geometry& duct = add_duct(ontology, ureter, stage, {kidney, {1, 0, -0.1}},
                                  {bladder, {0.7 * side, 0.5, -0.3 + 0.05 * stage}}, 1e-5);
        duct.frame = kidney;
        duct.via = {{-0.03 * side, -0.03, -0.02}, {-0.04 * side, -0.05, -0.05}};
      }
      add_process(ontology, ProcessKind::growth, kidney, 0, 3);
      add_process(ontology, ProcessKind::migration, kidney, 1, 3);
      ProcessEntry& rotation = add_process(ontology, ProcessKind::rotation, kidney, 1, 2);
      rotation.about = {0, 0, -side};
      rotation.angle = std::numbers::pi / 2;
      add_process(ontology, ProcessKind::fixation, ureter, 0, 3);
    }
    ProcessEntry& arrest = add_process(ontology, ProcessKind::interaction, left, 1, 3);
    arrest.stops_at = landmark;
    arrest.dormant = true;
  }
  [[nodiscard]] Development healthy(Interpolation interpolation = Interpolation::monotone) const {
    return {ontology, small_body::healthy(ontology), {interpolation}};
  }
};

/// Key frames of radii r and 4 r, days 29 and 39: after half of the days 2 r.
TEST(DevelopmentState, GrowthBetweenTwoKeysIsLinearInTheLogarithm) {
  Ontology ontology = small_body::bare();
  const int one = add(ontology, "One");
  add_ovoid(ontology, one, 0, {0, 0, 0}, {1e-4, 2e-4, 3e-4});
  add_ovoid(ontology, one, 3, {0, 0, 0}, {4e-4, 2e-4, 3e-4});
  const Development development(ontology, small_body::healthy(ontology));
  for (const double u : {0.0, 0.3, 0.5, 1.0}) {
    const Shape shape = shape_at(development.at(29 + 10 * u), one);
    EXPECT_NEAR(shape.radii.x(), 1e-4 * std::pow(4, u), 1e-17);
    EXPECT_NEAR(shape.radii.y(), 2e-4, 1e-18);
  }
}

/// The whole state as points, so that a jump of anything is one of a point.
SampledMotion sampled_state(const Development& development, int structure,
                            const std::vector<double>& borders, double step) {
  SampledMotion motion;
  for (double day = development.first_day(); day <= development.last_day(); day += 0.125)
    motion.parameters.push_back(day);
  for (const double border : borders)
    for (const int k : {-2, -1, 0, 1, 2}) motion.parameters.push_back(border + k * step);
  std::sort(motion.parameters.begin(), motion.parameters.end());
  motion.parameters.erase(std::unique(motion.parameters.begin(), motion.parameters.end()),
                          motion.parameters.end());
  for (const double day : motion.parameters) {
    const Shape shape = shape_at(development.at(day), structure);
    Eigen::MatrixXd x(5 + std::ssize(shape.points), 3);
    x.row(0) = shape.center.transpose();
    x.row(1) = shape.radii.transpose();
    x.middleRows(2, 3) = shape.radii.maxCoeff() * shape.axes.transpose();
    for (int i = 0; i < std::ssize(shape.points); ++i) x.row(5 + i) = shape.points[i].transpose();
    motion.x.push_back(x);
  }
  return motion;
}

std::vector<double> borders_of(const Ontology& ontology) {
  std::vector<double> borders;
  for (const Stage& stage : ontology.stages) {
    borders.push_back(stage.middle());
    if (stage.order > 0) borders.push_back(stage.start_day);
  }
  return borders;
}

TEST(DevelopmentState, EveryVelocityIsContinuousAtEveryBorderAndKey) {
  const SmallSystem system;
  const double step = 1.0 / 8192;
  const std::vector<double> borders = borders_of(system.ontology);
  const Development smooth = system.healthy(), straight = system.healthy(Interpolation::linear);
  for (int s = 0; s < std::ssize(system.ontology.structures); ++s) {
    EXPECT_LT(
        relative_velocity_jump(sampled_state(smooth, s, borders, step), borders, step).value(),
        1e-6)
        << system.ontology.structures[s].name;
    EXPECT_GT(
        relative_velocity_jump(sampled_state(straight, s, borders, step), borders, step).value(),
        1e-2)
        << system.ontology.structures[s].name;
  }
}

/// What is held comes to rest about day 32 within half a day, what is stopped below the landmark:
/// all with a continuous velocity.
TEST(DevelopmentState, HoldsAndStopsKeepTheVelocityContinuous) {
  const SmallSystem system;
  const double step = 1.0 / 8192;
  std::vector<double> borders = borders_of(system.ontology);
  for (const double day : {28.5, 29.5, 31.5, 32.5}) borders.push_back(day);
  std::vector<Effects> all;
  for (int p = 0; p < 4; ++p) all.push_back(small_body::without(system.ontology, p));
  all.push_back(small_body::healthy(system.ontology));
  all.back().inactive[system.stop] = false;
  for (const Effects& effects : all) {
    const Development development(system.ontology, effects);
    for (const int s : {system.left, system.left_ureter})
      EXPECT_LT(relative_velocity_jump(sampled_state(development, s, borders, step), borders, step)
                    .value(),
                1e-6);
  }
}

TEST(DevelopmentState, WithoutItsMigrationAStructureStaysAtItsRatio) {
  const SmallSystem system;
  const Development development(system.ontology,
                                small_body::without(system.ontology, system.left_ascent));
  const Eigen::Vector3d ratio = system.ontology.structures[system.left].keys[1].geometry.position;
  for (const double day : {33.0, 36.0, 42.0}) {
    const DayState state = development.at(day);
    EXPECT_LT((shape_at(state, system.left).center - state.crown_rump_length * ratio).norm(),
              1e-17);
    EXPECT_GT(shape_at(state, system.right).center.z(), shape_at(state, system.left).center.z());
  }
}

TEST(DevelopmentState, WithoutItsGrowthAStructureKeepsItsSize) {
  const SmallSystem system;
  const Development development(system.ontology,
                                small_body::without(system.ontology, system.left_growth));
  for (const double day : {30.0, 36.0, 42.0})
    EXPECT_NEAR(shape_at(development.at(day), system.left).radii.z(), 3e-4, 1e-17);
}

TEST(DevelopmentState, ARotationOf90DegreesIsOneAtItsEnd) {
  const SmallSystem system;
  const Development healthy = system.healthy();
  const Development still(system.ontology,
                          small_body::without(system.ontology, system.left_rotation));
  Eigen::Matrix3d quarter;
  quarter << 0, 1, 0, -1, 0, 0, 0, 0, 1;  // by -90 degrees about z
  for (const double day : {35.0, 37.0, 42.0})
    EXPECT_LT((shape_at(healthy.at(day), system.left).axes -
               quarter * shape_at(still.at(day), system.left).axes)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-15);
  for (const double day : {28.0, 32.0})
    EXPECT_EQ(shape_at(healthy.at(day), system.left).axes,
              shape_at(still.at(day), system.left).axes);
  const Eigen::Matrix3d half = shape_at(healthy.at(33.5), system.left).axes *
                               shape_at(still.at(33.5), system.left).axes.transpose();
  EXPECT_NEAR(Eigen::AngleAxisd(half).angle(), std::numbers::pi / 4, 1e-14);
}

TEST(DevelopmentState, DuctsEndOnTheirAnchorsWhereverTheseAre) {
  const SmallSystem system;
  for (const Effects& effects : {small_body::healthy(system.ontology),
                                 small_body::without(system.ontology, system.left_ascent)}) {
    const Development development(system.ontology, effects);
    for (double day = 28; day <= 42; day += 0.37) {
      const DayState state = development.at(day);
      const Shape ureter = shape_at(state, system.left_ureter);
      ASSERT_EQ(ureter.points.size(), 4U);
      const double w = MonotoneCurve({29, 32, 35, 39}, Eigen::Vector4d(-0.3, -0.25, -0.2, -0.15),
                                     Interpolation::monotone, Ends::rest)
                           .at(day)[0];
      EXPECT_LT(
          (ureter.points.front() - anchor_point(shape_at(state, system.left), {1, 0, -0.1})).norm(),
          1e-12);
      EXPECT_LT(
          (ureter.points.back() - anchor_point(shape_at(state, system.bladder), {0.7, 0.5, w}))
              .norm(),
          1e-12);
    }
  }
}

TEST(DevelopmentState, WithoutItsFixationADuctsEndsStayAtTheirRatios) {
  const SmallSystem system;
  const Development healthy = system.healthy();
  const Development loose(system.ontology,
                          small_body::without(system.ontology, system.left_fixation));
  const DayState first = healthy.at(29);
  const Eigen::Vector3d ratio =
      shape_at(first, system.left_ureter).points.front() / first.crown_rump_length;
  for (const double day : {30.0, 36.0, 41.0}) {
    const DayState state = loose.at(day);
    EXPECT_LT((shape_at(state, system.left_ureter).points.front() - state.crown_rump_length * ratio)
                  .norm(),
              1e-16);
  }
}

/// The landmark is at 0.06 of the body's length, the kidney rises to 0.12.
TEST(DevelopmentState, AStopIsNeverPassed) {
  const SmallSystem system;
  Effects effects = small_body::healthy(system.ontology);
  effects.inactive[system.stop] = false;
  const Development development(system.ontology, effects);
  for (double day = 28; day <= 42; day += 0.1) {
    const DayState state = development.at(day);
    const double z = shape_at(state, system.left).center.z();
    const double free = shape_at(state, system.right).center.z(),
                 stop = 0.06 * state.crown_rump_length;
    EXPECT_LE(z, stop);
    const double ease = 0.01 * state.crown_rump_length;
    if (std::abs(free - stop) <= ease) continue;
    EXPECT_NEAR(z, std::min(free, stop), 1e-17);
  }
}

TEST(DevelopmentState, TheRightSideIsTheMirrorImageOfTheLeft) {
  const SmallSystem system;
  const Development development = system.healthy();
  const Eigen::DiagonalMatrix<double, 3> mirror(-1, 1, 1);
  for (double day = 28; day <= 42; day += 0.7) {
    const DayState state = development.at(day);
    const Shape left = shape_at(state, system.left), right = shape_at(state, system.right);
    EXPECT_EQ(right.center, mirror * left.center);
    EXPECT_EQ(right.radii, left.radii);
    EXPECT_LT((right.axes.col(2) - mirror * left.axes.col(2)).norm(), 1e-15);
    EXPECT_LT((right.axes.col(0) - mirror * left.axes.col(0)).norm(), 1e-15);
    for (int i = 0; i < 4; ++i)
      EXPECT_LT((shape_at(state, system.right_ureter).points[i] -
                 mirror * shape_at(state, system.left_ureter).points[i])
                    .norm(),
                1e-17);
  }
}

TEST(DevelopmentState, ADayOutsideOfTheDataNamesTheirRange) {
  const Development development = SmallSystem().healthy();
  for (const double day : {27.9, 42.1, std::nan("")}) {
    try {
      (void)development.at(day);
      FAIL();
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("28 to 42"));
    }
  }
}

TEST(DevelopmentState, ADayAskedForByManyThreadsIsTheSameBitForBit) {
  const SmallSystem system;
  const Development development = system.healthy();
  const DayState expected = development.at(36.3);
  std::vector<DayState> states(8);
  std::vector<std::thread> threads;
  for (DayState& state : states)
    threads.emplace_back([&] {
      for (const double day : {41.0, 29.0, 36.3}) state = development.at(day);
    });
  for (std::thread& thread : threads) thread.join();
  for (const DayState& state : states)
    for (std::size_t i = 0; i < expected.structures.size(); ++i) {
      EXPECT_EQ(state.structures[i].shape.center, expected.structures[i].shape.center);
      EXPECT_EQ(state.structures[i].shape.points, expected.structures[i].shape.points);
    }
}

TEST(DevelopmentState, WhatASwitchOnTheLeftDoesNotTouchKeepsItsBytes) {
  const SmallSystem system;
  const Development healthy = system.healthy();
  for (int p = 0; p < 4; ++p) {
    const Development without(system.ontology, small_body::without(system.ontology, p));
    for (double day = 28; day <= 42; day += 1.7) {
      const DayState a = healthy.at(day), b = without.at(day);
      for (const int s : {system.right, system.right_ureter, system.bladder}) {
        EXPECT_EQ(shape_at(a, s).center, shape_at(b, s).center);
        EXPECT_EQ(shape_at(a, s).radii, shape_at(b, s).radii);
        EXPECT_EQ(shape_at(a, s).axes, shape_at(b, s).axes);
        EXPECT_EQ(shape_at(a, s).points, shape_at(b, s).points);
      }
    }
  }
}

/// A process that requires a dormant one sleeps with it: it was not switched off, and holds
/// nothing.
TEST(DevelopmentState, ProcessesThatSleepHoldNothing) {
  SmallSystem system;
  ProcessEntry& migration = add_process(system.ontology, ProcessKind::migration, system.left, 1, 3);
  migration.requires_ = {system.stop};
  Effects effects = small_body::healthy(system.ontology);
  effects.inactive.back() = true;
  const Development development(system.ontology, effects);
  EXPECT_EQ(shape_at(development.at(38), system.left).center,
            shape_at(system.healthy().at(38), system.left).center);
}

/// A circle of frames has no first structure.
TEST(DevelopmentState, RefusesStructuresThatAreFramesOfEachOther) {
  SmallSystem system;
  for (Key& key : system.ontology.structures[system.left].keys) key.geometry.frame = system.right;
  for (Key& key : system.ontology.structures[system.right].keys) key.geometry.frame = system.left;
  EXPECT_THROW(system.healthy(), Error);
}

}  // namespace
}  // namespace geoprior::embryo
