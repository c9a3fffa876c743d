#include "models/paper/sheet/sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "models/paper/sheet/valid.h"

namespace geoprior::paper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Handle held(std::vector<Eigen::Vector2d> points, const Eigen::Vector3d& shift = {0, 0, 0}) {
  Handle handle;
  handle.points = std::move(points);
  Keyframe start, end;
  end.time = 1;
  end.shift = shift;
  handle.motion = Trajectory{{start, end}};
  return handle;
}

Sheet valid_sheet() {
  Sheet sheet;
  sheet.pattern = rectangle_pattern(0.2, 0.3);
  sheet.handles = {held({{-0.1, -0.15}, {-0.1, 0.15}}, {0.05, 0, 0}), held({{0.1, 0}})};
  return sheet;
}

std::string refusal(const Sheet& sheet) {
  try {
    require_valid(sheet, "scene");
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

// Office paper of the notes: Eh/(1-nu^2) and Eh^3/(12(1-nu^2)) by hand.
TEST(PaperMaterial, HasTheStiffnessOfOfficePaper) {
  const PaperMaterial paper;
  EXPECT_NEAR(paper.membrane_stiffness(), 4.5e5 / 0.91, 1e-6);
  EXPECT_NEAR(paper.bending_stiffness(), 4.5e9 * 1e-12 / (12 * 0.91), 1e-12);
}

TEST(Sheet, CountsTheStartAmongItsFramesAndMeetsRoundTimes) {
  Sheet sheet;
  sheet.duration = 13;
  sheet.frame_interval = 0.04;
  EXPECT_EQ(sheet.frame_count(), 326);
  EXPECT_EQ(sheet.frame_time(3), 0.12);
  EXPECT_EQ(sheet.frame_time(325), 13.0);
  sheet.frame_interval = 0.1;
  EXPECT_EQ(sheet.frame_time(3), 0.3);  // 3 * 0.1 is not
  sheet.frame_interval = 0.03;
  EXPECT_NEAR(sheet.frame_time(7), 0.21, 1e-15);
}

TEST(Sheet, StartsOnItsPlacementWithinTheImperfection) {
  Sheet sheet = valid_sheet();
  sheet.placement.translate(Eigen::Vector3d(1, 2, 3));
  sheet.imperfection = 1e-3;
  double largest = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d p(-0.1 + 0.01 * (i % 20), -0.15 + 0.015 * (i / 20));
    const Eigen::Vector3d x = sheet.rest_place(p, 5);
    EXPECT_EQ(x.x(), p.x() + 1);
    EXPECT_EQ(x.y(), p.y() + 2);
    largest = std::max(largest, std::abs(x.z() - 3));
  }
  EXPECT_LE(largest, 1e-3);
  EXPECT_GE(largest, 1e-4);
  const Eigen::Vector2d p(0.03, 0.04);
  EXPECT_EQ(sheet.rest_place(p, 5), sheet.rest_place(p, 5));
  EXPECT_NE(sheet.rest_place(p, 5), sheet.rest_place(p, 6));
  sheet.imperfection = 0;
  EXPECT_EQ(sheet.rest_place(p, 5), Eigen::Vector3d(1.03, 2.04, 3));
}

// The waves must not load the sheet: a strain of half the squared slope stays a tenth of the
// isometry that is asked of the methods (1e-3).
TEST(Sheet, StartsAlmostWithoutStrain) {
  const Sheet sheet = valid_sheet();
  const double h = 1e-5;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d p(-0.1 + 0.02 * (i % 10), -0.15 + 0.03 * (i / 10));
      for (const Eigen::Vector2d& d : {Eigen::Vector2d(h, 0), Eigen::Vector2d(0, h)}) {
        const double length = (sheet.rest_place(p + d, seed) - sheet.rest_place(p, seed)).norm();
        EXPECT_LT(length / h - 1, 1e-4);
      }
    }
  }
}

TEST(Handle, CoversItsShape) {
  Handle points = held({{0, 0}, {0.1, 0}});
  EXPECT_TRUE(points.covers({0.1, 0}));
  EXPECT_FALSE(points.covers({0.05, 0}));
  EXPECT_EQ(points.anchors().size(), 2U);
  Handle line = held({});
  line.segment = {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.1, 0.1)};
  EXPECT_TRUE(line.covers({0.05, 0.05}));
  EXPECT_FALSE(line.covers({0.05, 0.051}));
  EXPECT_FALSE(line.covers({0.11, 0.11}));
  EXPECT_EQ(line.anchors().size(), 2U);
  Handle disc = held({{0.01, 0.02}});
  disc.disc_radius = 0.03;
  EXPECT_TRUE(disc.covers({0.03, 0.02}));
  EXPECT_FALSE(disc.covers({0.041, 0.02}));
  for (const Eigen::Vector2d& p : disc.anchors()) EXPECT_TRUE(disc.covers(p));
}

TEST(Handle, HoldsOnlyWhileItIsActive) {
  Handle handle = held({{0, 0}});
  EXPECT_TRUE(handle.is_active(1e9));
  handle.active = {{0, 1}, {2, 3}};
  EXPECT_TRUE(handle.is_active(0.5));
  EXPECT_TRUE(handle.is_active(1));
  EXPECT_FALSE(handle.is_active(1.5));
  EXPECT_TRUE(handle.is_active(2.5));
  EXPECT_FALSE(handle.is_active(3.1));
}

// A quarter turn about z takes the point one metre along x to one along y, then the shift.
TEST(Handle, TurnsAboutItsCentre) {
  Handle handle = held({{0, 0}}, {0, 0, 0.5});
  handle.motion->keys[1].turn =
      Eigen::Quaterniond(Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d centre(1, 1, 0);
  const Eigen::Vector3d x = handle.target({2, 1, 0}, centre, 1);
  EXPECT_NEAR((x - Eigen::Vector3d(1, 2, 0.5)).norm(), 0, 1e-15);
}

TEST(RequireValid, AcceptsASheetWithHandlesAndObstacles) {
  Sheet sheet = valid_sheet();
  Obstacle floor;
  floor.centre.z() = -0.01;
  sheet.obstacles = {floor};
  EXPECT_EQ(refusal(sheet), "accepted");
}

TEST(RequireValid, RefusesAMaterialThatIsNone) {
  Sheet sheet = valid_sheet();
  sheet.material.thickness = 0;
  EXPECT_THAT(refusal(sheet),
              AllOf(HasSubstr("scene.material.thickness"), HasSubstr("more than 0")));
  sheet = valid_sheet();
  sheet.material.young_modulus = -1;
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.material.young_modulus: -1 is out of range"));
  sheet = valid_sheet();
  sheet.material.area_density = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.material.area_density: is not finite"));
  sheet = valid_sheet();
  sheet.material.poisson_ratio = 0.5;
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.material.poisson_ratio: 0.5 is out of range"));
}

TEST(RequireValid, NamesTheHandleOutsideThePattern) {
  Sheet sheet = valid_sheet();
  sheet.handles[1].points.emplace_back(0.11, 0);
  EXPECT_THAT(refusal(sheet),
              AllOf(HasSubstr("scene.handles.1.points.1"), HasSubstr("(0.11, 0) m lies outside")));
  sheet = valid_sheet();
  sheet.handles[0].points = {{0.09, 0}};
  sheet.handles[0].disc_radius = 0.02;
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.handles.0.disc: reaches over the border"));
}

TEST(RequireValid, NamesTheHandleWithoutShapeOrDrive) {
  Sheet sheet = valid_sheet();
  sheet.handles[0].points.clear();
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.handles.0: has no shape"));
  sheet = valid_sheet();
  sheet.handles[1].motion.reset();
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.handles.1: has neither keys nor a force"));
  sheet.handles[1].force = Eigen::Vector3d(0, 0, std::numeric_limits<double>::infinity());
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.handles.1.force: is not finite"));
}

TEST(RequireValid, NamesTheKeyWhoseTimeDoesNotIncrease) {
  Sheet sheet = valid_sheet();
  sheet.handles[1].motion->keys[1].time = 0;
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.handles.1.keys.1.t: time 0 does not follow 0"));
}

TEST(RequireValid, RefusesTwoMotionsForOnePoint) {
  Sheet sheet = valid_sheet();
  sheet.handles[1].points = {{-0.1, 0.15}};
  EXPECT_THAT(refusal(sheet), AllOf(HasSubstr("scene.handles.1: moves the point (-0.1, 0.15) m"),
                                    HasSubstr("scene.handles.0")));
  sheet.handles[1].motion = sheet.handles[0].motion;
  EXPECT_EQ(refusal(sheet), "accepted") << "the same motion twice is none too many";
  sheet.handles[1].motion->keys[1].shift.z() = 0.1;
  sheet.handles[0].active = {{0, 0.4}};
  sheet.handles[1].active = {{0.5, 1}};
  EXPECT_EQ(refusal(sheet), "accepted") << "one after the other";
}

// A horizontal and a vertical segment that meet in the middle of both.
TEST(RequireValid, RefusesCrossingSegmentsThatMoveApart) {
  Sheet sheet = valid_sheet();
  for (Handle& handle : sheet.handles) handle.points.clear();
  sheet.handles[0].segment = {Eigen::Vector2d(-0.05, 0), Eigen::Vector2d(0.05, 0)};
  sheet.handles[1].segment = {Eigen::Vector2d(0.01, -0.05), Eigen::Vector2d(0.01, 0.05)};
  EXPECT_THAT(refusal(sheet), HasSubstr("moves the point (0.01, 0) m"));
}

TEST(RequireValid, RefusesAnObstacleThatContainsTheStart) {
  Sheet sheet = valid_sheet();
  Obstacle ball;
  ball.kind = Obstacle::Kind::sphere;
  ball.name = "ball";
  ball.radius = 0.01;
  ball.centre = {0.033, 0.071, 0.005};  // small, away from every corner
  sheet.obstacles = {ball};
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.obstacles.0 'ball': contains the start"));
  sheet.obstacles[0].centre.z() = 0.0101;
  EXPECT_EQ(refusal(sheet), "accepted");
  sheet.obstacles[0].kind = Obstacle::Kind::hollow_sphere;
  sheet.obstacles[0].radius = 0.15;
  sheet.obstacles[0].centre.setZero();
  EXPECT_THAT(refusal(sheet), HasSubstr("contains the start")) << "the corners stick out";
  sheet.obstacles[0].radius = 0.19;
  EXPECT_EQ(refusal(sheet), "accepted");
}

// A plane under the sheet: its distance is the sheet's height, whatever the point.
TEST(Sheet, KnowsWhetherItsStartIsNearAnObstacle) {
  Sheet sheet = valid_sheet();
  Obstacle table;
  table.kind = Obstacle::Kind::plane;
  table.centre = {0, 0, -2e-4};
  EXPECT_TRUE(start_nearer_than(sheet, table, 2.01e-4));
  EXPECT_FALSE(start_nearer_than(sheet, table, 1.99e-4));
  table.centre.z() = 0;
  EXPECT_TRUE(start_nearer_than(sheet, table, 1e-9));
  EXPECT_FALSE(start_nearer_than(sheet, table, -1e-9));
}

// A wire thinner than any sampling of the sheet that one would choose by hand.
TEST(RequireValid, FindsAThinWireThroughTheSheet) {
  Sheet sheet = valid_sheet();
  Obstacle wire;
  wire.kind = Obstacle::Kind::torus;
  wire.axis = Eigen::Vector3d::UnitX();
  wire.radius = 0.05;
  wire.tube_radius = 0.002;
  wire.centre = {0.0123, 0.0321, 0};
  sheet.obstacles = {wire};
  EXPECT_THAT(refusal(sheet), HasSubstr("contains the start"));
}

TEST(RequireValid, NamesAPatternThatIsNotSimple) {
  Sheet sheet = valid_sheet();
  std::swap(sheet.pattern.border[1], sheet.pattern.border[2]);
  EXPECT_THAT(refusal(sheet), HasSubstr("scene.pattern"));
}

TEST(RequireValid, NamesTheHandleInAHole) {
  Sheet sheet = valid_sheet();
  const Eigen::Vector2d centre = bounding_box(sheet.pattern).center();
  const double r = 0.1 * width(sheet.pattern);
  const auto at = [&](double x, double y) -> Eigen::Vector2d {
    return centre + r * Eigen::Vector2d(x, y);
  };
  sheet.pattern.holes = {{at(-1, -1), at(-1, 1), at(1, 1), at(1, -1)}};
  sheet.obstacles.clear();
  Handle& handle = sheet.handles[0];
  handle.disc_radius.reset();
  handle.segment.reset();
  handle.points = {centre};
  EXPECT_THAT(refusal(sheet), AllOf(HasSubstr("handles.0"), HasSubstr("in a hole of the pattern")));
  handle.points = {at(1, 0)};
  EXPECT_EQ(refusal(sheet), "accepted") << "a vertex on the border of the hole";
  handle.disc_radius = 0.5 * r;
  handle.points = {at(1.2, 0)};
  EXPECT_THAT(refusal(sheet), AllOf(HasSubstr("handles.0"), HasSubstr("over a hole")));
  handle.points = {at(0.2, 0)};
  EXPECT_THAT(refusal(sheet), HasSubstr("in a hole of the pattern"));
  handle.disc_radius.reset();
  handle.points.clear();
  handle.segment = {at(-1, 0.5), at(1, 0.5)};
  EXPECT_THAT(refusal(sheet),
              AllOf(HasSubstr("handles.0"), HasSubstr("segment: leaves the pattern")));
  handle.segment = {at(-1, -1), at(-1, 1)};
  EXPECT_EQ(refusal(sheet), "accepted") << "along the hole";
}

}  // namespace
}  // namespace geoprior::paper
