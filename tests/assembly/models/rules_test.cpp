// Each rule has an assembly that breaks it and no other; boxes that meet; ways of a ball.

#include "models/assembly/search/rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "models/assembly/graph/labels.h"
#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

enum SlideKind { kStart, kPipe, kHump, kGoal };

/// A start, pipes of 0.2 m, one with a hump of 0.01 m, and a goal that stands on the floor 0.1 m
/// below.
std::vector<PartType> slide_types() {
  std::vector<PartType> out{straight_track("start", 0.2), straight_track("pipe", 0.2),
                            straight_track("hump", 0.2), straight_track("goal", 0.2)};
  for (PartType& type : out) type.boxes = {{plane_pose(0.1, 0, 0), {0.09, 0.02, 0.02}}};
  out[kStart].ways = {{Way::kInside, 1, {{0.1, 0, 0}, {0.2, 0, 0}}}};
  out[kHump].ways[0].points.insert(out[kHump].ways[0].points.begin() + 1, {0.1, 0, 0.01});
  out[kGoal].ways = {{0, Way::kInside, {{0, 0, 0}, {0.1, 0, 0}}}};
  out[kGoal].boxes.push_back({plane_pose(0.1, 0, 0, -0.05), {0.02, 0.02, 0.05}});
  return out;
}

Rules slide_rules() {
  Rules out;
  out.grounded = {"goal"};
  out.entries = PartCount{{"start"}, 1, 1};
  out.exits = PartCount{{"goal"}, 1, 1};
  out.rise = 0.002;
  out.bill = {{"pipe", 2}};
  out.box = Bounds{{-1, -1, 0}, {1, 1, 1}};
  return out;
}

Assembly slide(const std::vector<int>& kinds) {
  Assembly out;
  const int n = static_cast<int>(kinds.size());
  for (int i = 0; i < n; ++i) out.parts.push_back({kinds[i], plane_pose(0.2 * i - 0.5, 0, 0, 0.1)});
  for (int i = 0; i + 1 < n; ++i) out.connections.push_back({{i, 1}, {i + 1, 0}});
  return out;
}

/// A slide that breaks one rule, and the rules without it.
struct BrokenSlide {
  Filter filter;
  Assembly assembly;
  std::function<void(Rules&)> give_up;
};

std::vector<BrokenSlide> broken_slides() {
  std::vector<BrokenSlide> out;
  out.push_back(
      {Filter::bill, slide({kStart, kPipe, kPipe, kPipe, kGoal}), [](Rules& r) { r.bill = {}; }});
  Assembly two_goals = slide({kStart, kPipe, kGoal});
  two_goals.parts.push_back({kGoal, plane_pose(0.1, 0, 0, 0.1)});
  two_goals.connections.push_back({{2, 1}, {3, 0}});
  out.push_back({Filter::counts, two_goals, [](Rules& r) { r.exits->most = 2; }});
  Assembly pieces = slide({kStart, kPipe, kGoal});
  pieces.parts.push_back({kPipe, plane_pose(0, 0.5, 0, 0.1)});
  out.push_back({Filter::connected, pieces, [](Rules& r) { r.connected = false; }});
  Assembly gap = slide({kStart, kPipe, kGoal});
  gap.parts[0].pose.translation().x() -= 1e-3;
  out.push_back({Filter::closure, gap, [](Rules& r) { r.tolerance.translation = 2e-3; }});
  Assembly turned = slide({kStart, kPipe, kGoal});
  turned.parts[0].pose = plane_pose(-0.3, 0, 0.01, 0.1) * plane_pose(-0.2, 0, 0);
  out.push_back({Filter::closure, turned, [](Rules& r) { r.tolerance.angle_deg = 1; }});
  Assembly high = slide({kStart, kPipe, kGoal});
  for (PlacedPart& part : high.parts) part.pose.translation().z() += 0.01;
  out.push_back({Filter::ground, high, [](Rules& r) { r.grounded = {}; }});
  Assembly far = slide({kStart, kPipe, kGoal});
  for (PlacedPart& part : far.parts) part.pose.translation().y() += 0.99;
  out.push_back({Filter::box, far, [](Rules& r) { r.box = {}; }});
  out.push_back(
      {Filter::way, slide({kStart, kHump, kGoal}), [](Rules& r) { r.rise = 0.01 + 1e-12; }});
  Assembly crowd = slide({kStart, kPipe, kGoal});
  crowd.parts.push_back({kHump, plane_pose(-0.2, -0.1, std::numbers::pi / 2, 0.1)});
  out.push_back({Filter::collision, crowd, [](Rules& r) { r.collisions = false; }});
  return out;
}

TEST(Rules, EachIsBrokenByAnAssemblyThatBreaksNoOther) {
  const std::vector<PartType> types = slide_types();
  std::set<Filter> seen;
  for (const BrokenSlide& broken : broken_slides()) {
    Rules rules = slide_rules();
    if (broken.filter == Filter::collision) rules.connected = false;
    Assembly assembly = broken.assembly;
    EXPECT_EQ(first_broken(assembly, types, rules), broken.filter) << filter_name(broken.filter);
    broken.give_up(rules);
    EXPECT_EQ(first_broken(assembly, types, rules), Filter::none) << filter_name(broken.filter);
    seen.insert(broken.filter);
  }
  EXPECT_EQ(seen.size(), static_cast<std::size_t>(Filter::none));
}

TEST(Rules, HoldForASlideFromStartToGoal) {
  const std::vector<PartType> types = slide_types();
  Assembly good = slide({kStart, kPipe, kPipe, kGoal});
  EXPECT_EQ(first_broken(good, types, slide_rules()), Filter::none);
  Rules rules = slide_rules();
  rules.parts = 3;
  EXPECT_EQ(first_broken(good, types, rules), Filter::bill);
  EXPECT_EQ(first_broken_by_graph(good, types, rules), Filter::bill);
}

TEST(Rules, ClosureIsAskedAfterMisfitsAreSpreadWhereRulesSaySo) {
  std::vector<PartType> types = oval_types();
  types.push_back(straight_track("excess", 1e-3));
  std::vector<int> kinds(16, 0);
  kinds.push_back(3);
  Assembly ring = track_row(kinds, types, true);
  Rules rules;
  rules.tolerance = {2e-4, 1};
  EXPECT_EQ(first_broken(ring, types, rules), Filter::closure);
  rules.relax = true;
  EXPECT_EQ(first_broken(ring, types, rules), Filter::none);
}

TEST(Rules, AWayHasToEndInAnExit) {
  const std::vector<PartType> types = slide_types();
  Rules rules = slide_rules();
  rules.exits = {};
  rules.grounded = {};
  Assembly open = slide({kStart, kPipe});
  EXPECT_EQ(first_broken(open, types, rules), Filter::way);
  rules.rise = {};
  EXPECT_EQ(first_broken(open, types, rules), Filter::none);
}

TEST(Rules, HoldForTheMarbleRun) {
  Assembly run = marble_run().set.models[0];
  EXPECT_EQ(first_broken(run, marble_run().set.types, marble_run().rules), Filter::none);
}

TEST(Floor, IsUnderTheLowestGroundedPart) {
  const std::vector<PartType> types = slide_types();
  Assembly high = slide({kStart, kPipe, kGoal});
  for (PlacedPart& part : high.parts) part.pose.translation().z() += 0.7;
  put_on_floor(high, types, slide_rules());
  EXPECT_NEAR(lowest_point(types[kGoal], high.parts[2].pose), 0, 1e-15);
  EXPECT_NEAR(high.parts[0].pose.translation().z(), 0.1, 1e-15);
}

TEST(Floor, LowestPointIsOfTheMeshElseOfTheBoxes) {
  PartType type = slide_types()[kGoal];
  EXPECT_NEAR(lowest_point(type, plane_pose(0, 0, 1, 0.5)), 0.4, 1e-15);
  // A corner of the box of half extents 0.09, 0.02, 0.02 when it stands on its end.
  Pose upright = Pose::Identity();
  upright.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(lowest_point(slide_types()[kPipe], upright), -0.19, 1e-15);
  type.mesh.V.resize(1, 3);
  type.mesh.V << 0, 0, -3;
  EXPECT_NEAR(lowest_point(type, plane_pose(0, 0, 1, 0.5)), -2.5, 1e-15);
  EXPECT_EQ(lowest_point(PartType{}, Pose::Identity()), std::numeric_limits<double>::infinity());
}

TEST(BallWays, PartAtAForkAndEndInside) {
  const AssemblySet& set = marble_run().set;
  const std::vector<BallWay> ways = ball_ways(set.models[0], set.types, 0);
  // Two forks, one behind the other.
  ASSERT_EQ(ways.size(), 3);
  for (const BallWay& way : ways) {
    EXPECT_TRUE(way.ends_inside);
    EXPECT_EQ(set.types[set.models[0].parts[way.last_part].type].label, "basin");
    EXPECT_LT(largest_rise(way.points), 1e-12);
  }
}

TEST(BallWays, AreTwoThroughOneForkAndEndAtOpenPorts) {
  std::vector<PartType> types = slide_types();
  PartType& fork = types.emplace_back(straight_track("fork", 0.2));
  fork.ports.push_back({"c", plane_pose(0.1, 0.1, std::numbers::pi / 2)});
  fork.ways.push_back({0, 2, {{0, 0, 0}, {0.1, 0.1, -0.01}}});
  const std::vector<BallWay> ways = ball_ways(slide({kStart, 4}), types, 0);
  ASSERT_EQ(ways.size(), 2);
  for (const BallWay& way : ways) {
    EXPECT_FALSE(way.ends_inside);
    EXPECT_EQ(way.last_part, 1);
    EXPECT_EQ(way.points.size(), 4);
  }
}

TEST(BallWays, EndWhereABallComesToAPartAgain) {
  std::vector<PartType> types = slide_types();
  PartType& loop = types.emplace_back(straight_track("loop", 0.2));
  loop.ports.push_back({"c", plane_pose(0.1, 0.1, 1)});
  loop.ways = {{0, 1, {{0, 0, 0}, {0.2, 0, 0}}}, {2, 1, {{0, 0, 0}, {0.2, 0, 0}}}};
  Assembly round = slide({kStart, 4, kPipe});
  round.connections.push_back({{2, 1}, {1, 2}});
  const std::vector<BallWay> ways = ball_ways(round, types, 0);
  ASSERT_EQ(ways.size(), 1);
  EXPECT_FALSE(ways[0].ends_inside);
}

TEST(BallWays, RiseIsAboveTheLowestPointSoFar) {
  using Points = std::vector<Eigen::Vector3d>;
  EXPECT_EQ(largest_rise(Points{{0, 0, 3}, {1, 0, 2}, {2, 0, 0}}), 0);
  EXPECT_EQ(largest_rise(Points{{0, 0, 3}, {1, 0, 1}, {2, 0, 2.5}, {3, 0, 2}, {4, 0, 2.25}}), 1.5);
  EXPECT_EQ(largest_rise(Points{}), 0);
}

Box solid_cube() { return {Pose::Identity(), {1, 1, 1}}; }

Pose box_pose(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& at) {
  Pose out = Pose::Identity();
  out.translation() = at;
  out.rotate(Eigen::AngleAxisd(angle, axis));
  return out;
}

TEST(BoxesMeet, FaceToFaceByTheSumOfTheirHalves) {
  const Pose origin = Pose::Identity();
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1., 1.}) {
      Eigen::Vector3d at = Eigen::Vector3d::Constant(0.3);
      at[axis] = sign * (2 + 1e-9);
      EXPECT_FALSE(boxes_meet(solid_cube(), origin, solid_cube(), box_pose({0, 0, 1}, 0, at), 0));
      at[axis] = sign * (2 - 1e-9);
      EXPECT_TRUE(boxes_meet(solid_cube(), origin, solid_cube(), box_pose({0, 0, 1}, 0, at), 0));
    }
}

TEST(BoxesMeet, EdgeAcrossEdgeWhichNoFaceTells) {
  // Ridges along z and along y point at each other, each sqrt 2 from its centre; the faces' own
  // axes part the cubes from 3.83 on only.
  const double eighth = std::numbers::pi / 4, reach = 2 * std::numbers::sqrt2;
  const Pose a = box_pose({0, 0, 1}, eighth, {0, 0, 0});
  EXPECT_TRUE(boxes_meet(solid_cube(), a, solid_cube(),
                         box_pose({0, 1, 0}, eighth, {reach - 1e-9, 0, 0}), 0));
  for (const double x : {reach + 1e-9, 3., 3.5})
    EXPECT_FALSE(
        boxes_meet(solid_cube(), a, solid_cube(), box_pose({0, 1, 0}, eighth, {x, 0, 0}), 0));
}

TEST(BoxesMeet, AreShrunkOnEachSide) {
  const Pose origin = Pose::Identity(), beside = plane_pose(1.9, 0, 0);
  EXPECT_TRUE(boxes_meet(solid_cube(), origin, solid_cube(), beside, 0));
  EXPECT_TRUE(boxes_meet(solid_cube(), origin, solid_cube(), beside, 0.05 - 1e-9));
  EXPECT_FALSE(boxes_meet(solid_cube(), origin, solid_cube(), beside, 0.05 + 1e-9));
}

TEST(BoxesMeet, AreInvariantUnderACommonMotion) {
  test::Dice dice(1, "boxes");
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const Box a{box_pose(dice.vector(1).normalized(), dice.uniform(0, 3), dice.vector(1)),
                {dice.uniform(0.1, 1), dice.uniform(0.1, 1), dice.uniform(0.1, 1)}};
    const Box b{box_pose(dice.vector(1).normalized(), dice.uniform(0, 3), dice.vector(1)),
                {dice.uniform(0.1, 1), dice.uniform(0.1, 1), dice.uniform(0.1, 1)}};
    const Pose motion = box_pose(dice.vector(1).normalized(), dice.uniform(0, 3), dice.vector(5));
    const bool meet = boxes_meet(a, Pose::Identity(), b, Pose::Identity(), 0);
    EXPECT_EQ(boxes_meet(a, motion, b, motion, 0), meet);
    EXPECT_EQ(boxes_meet(b, motion, a, motion, 0), meet);
    if (meet) ++met;
  }
  EXPECT_GT(met, 20);
  EXPECT_LT(met, 180);
}

TEST(Labels, AreMeantByThemselvesOrABeginningWithAStar) {
  EXPECT_TRUE(is_meant("pillar-*", "pillar-7"));
  EXPECT_TRUE(is_meant("pillar-*", "pillar-"));
  EXPECT_TRUE(is_meant("*", "anything"));
  EXPECT_FALSE(is_meant("pillar-*", "pilla"));
  EXPECT_FALSE(is_meant("pillar", "pillar-7"));
  EXPECT_TRUE(is_meant("pillar", "pillar"));
  EXPECT_FALSE(is_meant("", "pillar"));
  EXPECT_TRUE(is_among({"basin", "pillar-*"}, "pillar-7"));
  EXPECT_FALSE(is_among({}, "pillar-7"));
}

}  // namespace
}  // namespace geoprior::assembly
