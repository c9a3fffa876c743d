#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/embryo/body/convex_pieces.h"
#include "solvers/embryo/state/development.h"
#include "tests/embryo/state/small_body.h"

namespace geoprior::embryo {
namespace {

using testing::ElementsAre;

/// A cloaca that a septum divides from day 29 (the middle of the first stage) to day 34 (the first
/// day of the third) into a front and a back, and a duct on the front.
struct DividedCloaca {
  Ontology ontology = small_body::bare();
  int back = small_body::add(ontology, "Back");
  int cloaca = small_body::add(ontology, "Cloaca");
  int duct = small_body::add(ontology, "Duct");
  int front = small_body::add(ontology, "Front");

  DividedCloaca() {
    small_body::add_ovoid(ontology, cloaca, 0, {0, 0, 0}, {3e-4, 4e-4, 5e-4});
    small_body::add_ovoid(ontology, cloaca, 3, {0, 0, -0.1}, {6e-4, 8e-4, 10e-4});
    small_body::add_duct(ontology, duct, 0, {front, {0, -1, 0}}, {std::nullopt, {0, -0.2, 0}},
                         1e-5);
    ProcessEntry& division = small_body::add_process(ontology, ProcessKind::division, cloaca, 0, 2);
    division.produces = {back, front};
    division.positive = back;
    division.normal = {0, 1, 0};
    division.thickness = 1e-4;
    ontology.structures[cloaca].until_stage = 1;
    ontology.structures[front].from_stage = ontology.structures[back].from_stage = 2;
  }
};

TEST(Division, CutsFromAboveTheWholeToBelowItByTheDayOfItsProducts) {
  const DividedCloaca system;
  const Development development(system.ontology, small_body::healthy(system.ontology));
  EXPECT_TRUE(development.at(28.9).cuts.empty());
  double before = 0;
  for (const double day : {29.0, 31.0, 33.0, 33.999}) {
    const DayState state = development.at(day);
    ASSERT_EQ(state.cuts.size(), 1U);
    EXPECT_TRUE(state.halves.empty());
    const Cut& cut = state.cuts[0];
    const Shape& whole = find_state(state, system.cloaca)->shape;
    EXPECT_EQ(cut.whole, system.cloaca);
    EXPECT_EQ(cut.point, whole.center);
    // Along the descent, from a thickness above the upper pole to one below the lower.
    const double reach = whole.radii.z() + cut.thickness;
    EXPECT_NEAR(cut.tip, reach * (2 * cut.progress - 1), 1e-17);
    EXPECT_GE(cut.progress, before);
    before = cut.progress;
  }
  EXPECT_GT(before, 0.999999);
}

TEST(Division, LeavesTwoHalvesOfTheWholesShapeWhoseKeysGoOn) {
  const DividedCloaca system;
  const Development development(system.ontology, small_body::healthy(system.ontology));
  const DayState state = development.at(39);
  EXPECT_TRUE(state.cuts.empty());
  EXPECT_EQ(find_state(state, system.cloaca), nullptr);
  ASSERT_EQ(state.halves.size(), 2U);
  EXPECT_EQ(state.halves[0].product, system.back);
  EXPECT_EQ(state.halves[0].sign, 1);
  EXPECT_EQ(state.halves[1].product, system.front);
  EXPECT_EQ(state.halves[1].sign, -1);
  for (const Half& half : state.halves) {
    EXPECT_NEAR(half.shape.radii.z(), 10e-4, 1e-17);
    EXPECT_EQ(half.cut.progress, 1);
  }
}

/// The duct's anchor is a product that does not exist yet: it is where the whole is.
TEST(Division, DuctsOnAProductFollowTheWholeBefore) {
  const DividedCloaca system;
  for (const Effects& effects :
       {small_body::healthy(system.ontology), small_body::without(system.ontology, 0)}) {
    const DayState state = Development(system.ontology, effects).at(30);
    EXPECT_LT((find_state(state, system.duct)->shape.points.front() -
               anchor_point(find_state(state, system.cloaca)->shape, {0, -1, 0}))
                  .norm(),
              1e-17);
  }
}

TEST(Division, ThatIsOffCutsNothing) {
  const DividedCloaca system;
  Effects effects = small_body::without(system.ontology, 0);
  effects.exists[system.cloaca] = {true, true, true, true};
  effects.exists[system.front] = effects.exists[system.back] = {false, false, false, false};
  const Development development(system.ontology, effects);
  for (const double day : {31.0, 39.0}) {
    const DayState state = development.at(day);
    EXPECT_TRUE(state.cuts.empty());
    EXPECT_TRUE(state.halves.empty());
    EXPECT_NE(find_state(state, system.cloaca), nullptr);
  }
}

/// Balls of radius 2 mm whose centres come from 8 mm apart (day 29) to 24 mm (day 39).
TEST(Interaction, IsMetWhileTheGapIsLess) {
  Ontology ontology = small_body::bare();
  const int a = small_body::add(ontology, "A"), b = small_body::add(ontology, "B");
  small_body::add_ovoid(ontology, a, 0, {1, 0, 0}, {2e-3, 2e-3, 2e-3});
  small_body::add_ovoid(ontology, b, 0, {-1, 0, 0}, {2e-3, 2e-3, 2e-3});
  ProcessEntry& process = small_body::add_process(ontology, ProcessKind::interaction, b, 1, 2);
  process.inducer = a;
  process.target = b;
  process.within = 8.1e-3;
  process.fuses = {a, b};
  process.blend = 1e-4;
  const Development development(ontology, small_body::healthy(ontology));
  const DayState early = development.at(29), late = development.at(33);
  EXPECT_NEAR(gap(early.structures[0].shape, early.structures[1].shape), 4e-3, 1e-12);
  EXPECT_TRUE(early.processes[0].met);  // 8 - 4 < 8.1
  EXPECT_TRUE(early.fused.empty());     // the process begins on day 32
  EXPECT_TRUE(development.at(32).processes[0].met);
  EXPECT_FALSE(development.at(39).processes[0].met);  // 24 - 4
  ASSERT_EQ(late.fused.size(), 1U);
  EXPECT_THAT(late.fused[0].members, ElementsAre(a, b));
  EXPECT_EQ(late.fused[0].blend, 1e-4);
}

Shape plain_shape(Primitive primitive, const Eigen::Vector3d& center,
                  const Eigen::Vector3d& radii) {
  Shape shape;
  shape.primitive = primitive;
  shape.center = center;
  shape.radii = radii;
  return shape;
}

TEST(Gap, IsThatOfClosedForms) {
  const Shape ball = plain_shape(Primitive::ovoid, {0, 0, 0}, {1, 1, 1});
  const Shape rod = plain_shape(Primitive::cylinder, {3, 0, 0}, {0.5, 0.5, 4});
  const Shape point = plain_shape(Primitive::point, {0, 0, 5}, {0, 0, 0});
  const Shape plane = plain_shape(Primitive::plane, {0, 0, -3}, {2, 2, 0});
  EXPECT_NEAR(gap(ball, rod), 1.5, 1e-8);
  EXPECT_NEAR(gap(point, ball), 4, 1e-8);
  EXPECT_NEAR(gap(ball, plane), 2, 1e-8);
  EXPECT_NEAR(gap(rod, point), std::sqrt(9 + 1.5 * 1.5) - 0.5, 1e-8);
  EXPECT_EQ(gap(ball, plain_shape(Primitive::ovoid, {1.5, 0, 0}, {1, 1, 1})), 0);
}

/// The nearest point of the ellipsoid (a, b) = (2, 1) to (x, 0) outside on the long axis is its
/// vertex; an egg scales the waist, so that from the side the gap is less by the largest half width
/// (1 + k sin t) cos t.
TEST(Gap, KnowsLongOvoidsAndEggs) {
  Shape egg = plain_shape(Primitive::ovoid, {0, 0, 0}, {1, 1, 2});
  const Shape above = plain_shape(Primitive::point, {0, 0, 5}, {0, 0, 0});
  EXPECT_NEAR(gap(egg, above), 3, 1e-8);
  egg.egg = 0.4;
  double widest = 0;
  for (double t = -1.5; t < 1.5; t += 1e-4)
    widest = std::max(widest, (1 + 0.4 * std::sin(t)) * std::cos(t));
  EXPECT_NEAR(extent_along(egg, {1, 0, 0}), widest, 1e-8);
  EXPECT_NEAR(extent_along(egg, {0, 0, 1}), 2, 1e-12);
}

/// A straight duct of radius 0.1 along x, 1 below the ball; its ends are round.
TEST(Gap, OfADuctIsThatOfItsTube) {
  const Shape ball = plain_shape(Primitive::ovoid, {0, 0, 0}, {1, 1, 1});
  Shape duct;
  duct.primitive = Primitive::duct;
  duct.points = {{-2, 0, -2}, {0, 0, -2}, {1, 0, -2}};
  duct.radius = duct.end_radius = 0.1;
  EXPECT_NEAR(gap(ball, duct), 0.9, 1e-8);
  EXPECT_NEAR(extent_along(duct, {1, 0, 0}), 1.1, 1e-12);
}

}  // namespace
}  // namespace geoprior::embryo
