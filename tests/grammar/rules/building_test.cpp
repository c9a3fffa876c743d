#include "experiments/grammar/scene/building.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "experiments/grammar/maps/gesture.h"
#include "models/grammar/objects/building_layout.h"
#include "solvers/grammar/engine/derivation.h"
#include "solvers/grammar/rules/building_stack.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

using KeyList = std::vector<Eigen::Vector3d>;

KeyList building_keys(const Hierarchy& h, int element) {
  KeyList keys;
  h.keys(element, keys);
  return keys;
}

/// The largest violation among a wall's openings (m).
double opening_violation(const Hierarchy& h, int wall) {
  double most = 0;
  std::vector<double> middles;
  for (const char* type : {"window", "door"})
    for (const int e : present_children(h, wall, type)) {
      const KeyList keys = building_keys(h, e);
      for (const Eigen::Vector3d& key : keys) {
        const Eigen::Vector3d x = h.turn(wall).conjugate() * (key - h.position(wall));
        most = std::max({most, std::abs(x.y()), -x.x(), x.x() - h.parameter(wall, 0), -x.z(),
                         x.z() - h.parameter(wall, 1)});
      }
      middles.push_back((h.turn(wall).conjugate() * (keys[0] - h.position(wall))).x());
    }
  std::sort(middles.begin(), middles.end());
  for (std::size_t i = 1; i < middles.size(); ++i)
    most = std::max({most, kLeastPitch - (middles[i] - middles[i - 1]),
                     middles[i] - middles[i - 1] - kMostPitch});
  return most;
}

/// The largest violation of the building's constraints, from key points (m).
double building_violation(const Hierarchy& h) {
  double most = 0;
  KeyList below;
  for (const int storey : storeys_of(h, 0)) {
    const KeyList box = building_keys(h, storey);
    const double height = box[4].z() - box[0].z();
    most = std::max({most, kLeastStoreyHeight - height, height - kMostStoreyHeight});
    for (const int wall : present_children(h, storey, "wall")) {
      const KeyList keys = building_keys(h, wall);
      const int side = static_cast<int>(h.parameter(wall, WallParameter::side));
      most = std::max({most, (keys[0] - box[side]).norm(), (keys[1] - box[(side + 1) % 4]).norm(),
                       (keys[3] - box[side + 4]).norm(), opening_violation(h, wall)});
    }
    if (!below.empty()) {
      most = std::max(most, std::abs(below[4].z() - box[0].z()));
      for (int side = 0; side < 4; ++side) {
        const Eigen::Vector3d r =
            (box[side] + box[(side + 1) % 4] - below[side + 4] - below[(side + 1) % 4 + 4]) / 2;
        most = std::max(most, r.head<2>().norm() - kMostOverhang);
      }
    }
    below = box;
  }
  const KeyList roof = building_keys(h, present_children(h, 0, "roof").front());
  return std::max(most, std::abs(roof[0].z() - below[4].z()));
}

Eigen::AlignedBox3d building_bounds(const Hierarchy& h) {
  Eigen::AlignedBox3d box;
  for (int e = 0; e < h.size(); ++e)
    for (const Eigen::Vector3d& x : building_keys(h, e)) box.extend(x);
  return box;
}

double squared_deviation(const Hierarchy& rest, const Hierarchy& h, const SpatialMap& map) {
  double sum = 0;
  for (int e = 0; e < rest.size(); ++e) {
    if (!h.present(e)) continue;
    const KeyList before = building_keys(rest, e), after = building_keys(h, e);
    for (std::size_t k = 0; k < before.size(); ++k)
      sum += (after[k] - map.at(before[k])).squaredNorm() / static_cast<double>(before.size());
  }
  return sum;
}

std::shared_ptr<const SpatialMap> stretch(double x, double y, double z) {
  return std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Scaling(x, y, z)));
}

bool same_element(const Hierarchy& a, const Hierarchy& b, int e) {
  const auto p = a.parameters(e), q = b.parameters(e);
  return a.position(e) == b.position(e) && a.turn(e).coeffs() == b.turn(e).coeffs() &&
         a.present(e) == b.present(e) && std::equal(p.begin(), p.end(), q.begin());
}

/// A building, its rules and what became of it.
struct BuildingCase {
  Hierarchy rest = make_building({.storeys = 5}, 7);
  Hierarchy now = rest;
  Transaction transaction{now};
  RuleSet rules = building_rules();

  DerivationReport apply(int element, const Delta& delta) {
    return derive(now, transaction, rules, {element, delta});
  }
  [[nodiscard]] int storey(int i) const { return storeys_of(rest, 0)[i]; }
  [[nodiscard]] int wall(int i, int side) const {
    return present_children(rest, storey(i), "wall")[side];
  }
  [[nodiscard]] int window(int i, int side, int number) const {
    return present_children(rest, wall(i, side), "window")[number];
  }
};

TEST(GrammarBuildingRules, RandomGesturesLeaveNoViolationAndAreFollowed) {
  const BuildingCase building;
  const Eigen::AlignedBox3d box = building_bounds(building.rest);
  double followed = 0, ignored = 0;
  for (int number = 0; number < 40; ++number) {
    const auto map = map_of(random_gesture(5, number, box), 1);
    Hierarchy now = building.rest;
    Transaction transaction(now);
    derive(now, transaction, building.rules, {0, Delta::free(map)});
    now.require_valid();
    EXPECT_LT(building_violation(now), 1e-9) << "gesture " << number;
    const double own = squared_deviation(building.rest, now, *map);
    const double nothing = squared_deviation(building.rest, building.rest, *map);
    EXPECT_LE(own, nothing) << "gesture " << number;
    followed += std::sqrt(own);
    ignored += std::sqrt(nothing);
  }
  EXPECT_LT(followed, 0.7 * ignored);
}

TEST(GrammarBuildingRules, MapBesideTheBuildingTouchesNothing) {
  BuildingCase building;
  Gesture gesture;
  gesture.strokes.push_back({.path = {{100, 0, 0}, {101, 0, 0}}, .radius = 5});
  building.apply(0, Delta::free(map_of(gesture, 1)));
  EXPECT_TRUE(building.transaction.changed().empty());
}

TEST(GrammarBuildingRules, RigidMotionInThePlaneIsFollowedExactly) {
  BuildingCase building;
  Eigen::Affine3d motion(Eigen::Translation3d(3, -2, 1));
  motion.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  building.apply(0, Delta::rigid(motion));
  EXPECT_LT(squared_deviation(building.rest, building.now, AffineMap(motion)), 1e-16);
}

TEST(GrammarBuildingRules, StoreysComeAndGoWithTheHeight) {
  for (const auto& [z, storeys] : {std::pair{0.3, 2}, {0.6, 3}, {1.3, 5}, {2.5, 9}}) {
    BuildingCase building;
    building.apply(0, Delta::free(stretch(1, 1, z)));
    const std::size_t count = storeys_of(building.now, 0).size();
    EXPECT_NEAR(static_cast<double>(count), storeys, 1) << z;
    EXPECT_LT(building_violation(building.now), 1e-9) << z;
    // The ground storey, with the door, stays.
    EXPECT_TRUE(building.now.present(building.storey(0)));
    for (const int storey : storeys_of(building.now, 0))
      EXPECT_EQ(present_children(building.now, storey, "wall").size(), 4u);
  }
}

TEST(GrammarBuildingRules, WindowsThatWereThereKeepTheirNumbersOnLongerWalls) {
  BuildingCase building;
  const DerivationReport report = building.apply(0, Delta::free(stretch(2, 1, 1)));
  EXPECT_GT(report.spawned, 0);
  EXPECT_EQ(report.removed, 0);
  EXPECT_LT(building_violation(building.now), 1e-9);
  for (int e = 0; e < building.rest.size(); ++e) EXPECT_TRUE(building.now.present(e));
}

TEST(GrammarBuildingRules, WindowEditIsBoundedByItsWall) {
  BuildingCase building;
  const int window = building.window(2, 0, 2), wall = building.wall(2, 0);
  const DerivationReport report = building.apply(window, Delta::set(OpeningParameter::width, 1.9));
  EXPECT_EQ(report.turned_at, wall);
  EXPECT_EQ(building.now.parameter(window, OpeningParameter::width), 1.9);
  EXPECT_LT(building_violation(building.now), 1e-9);
  for (const int e : building.transaction.touched())
    EXPECT_TRUE(building.now.is_below(e, wall)) << building.now.label(e);
}

TEST(GrammarBuildingRules, WallPushedALittleEndsWithItsStorey) {
  BuildingCase building;
  const int wall = building.wall(2, 1), storey = building.storey(2);
  const Eigen::Vector3d out = building.rest.turn(wall) * Eigen::Vector3d(0, -0.05, 0);
  const DerivationReport report = building.apply(wall, Delta::translate(out));
  EXPECT_EQ(report.turned_at, storey);
  EXPECT_NEAR(building.now.parameter(storey, StoreyParameter::width),
              building.rest.parameter(storey, StoreyParameter::width) + 0.05, 1e-12);
  // The opposite wall stays where it is.
  const KeyList before = building_keys(building.rest, building.wall(2, 3));
  const KeyList after = building_keys(building.now, building.wall(2, 3));
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_LT((before[k] - after[k]).norm(), 1e-12);
  EXPECT_LT(building_violation(building.now), 1e-9);
}

TEST(GrammarBuildingRules, WallPushedFarMovesTheNeighboursJustEnough) {
  BuildingCase building;
  const int wall = building.wall(2, 1), storey = building.storey(2);
  const Eigen::Vector3d out = building.rest.turn(wall) * Eigen::Vector3d(0, -1.5, 0);
  const DerivationReport report = building.apply(wall, Delta::translate(out));
  EXPECT_EQ(report.turned_at, 0);
  EXPECT_NEAR(building.now.parameter(storey, StoreyParameter::width),
              building.rest.parameter(storey, StoreyParameter::width) + 1.5, 1e-12);
  EXPECT_LT(building_violation(building.now), 1e-9);
  const auto box = [&](int s) {
    const Hierarchy& h = building.now;
    return storey_box(h.pose(s), h.parameter(s, 0), h.parameter(s, 1), h.parameter(s, 2));
  };
  EXPECT_NEAR(overhang(box(building.storey(1)), box(storey)), kMostOverhang, 1e-3);
}

TEST(GrammarBuildingRules, HeightOfAStoreyLiftsWhatIsAbove) {
  BuildingCase building;
  const int storey = building.storey(1);
  building.apply(storey, Delta::set(StoreyParameter::height, 4));
  const double more = 4 - building.rest.parameter(storey, StoreyParameter::height);
  for (int i = 2; i < 5; ++i)
    EXPECT_NEAR(building.now.position(building.storey(i)).z(),
                building.rest.position(building.storey(i)).z() + more, 1e-12);
  EXPECT_TRUE(same_element(building.rest, building.now, building.storey(0)));
  EXPECT_LT(building_violation(building.now), 1e-9);
}

TEST(GrammarBuildingRules, TaggedPartsKeepTheirParametersBitForBit) {
  BuildingCase building;
  const std::vector<int> tagged{building.storey(1), building.wall(2, 1), building.window(3, 0, 1)};
  for (const int e : tagged) building.now.set_tag(e, {1, Tag::Follow::rigid});
  const Eigen::AlignedBox3d box = building_bounds(building.rest);
  for (int number = 0; number < 20; ++number) {
    Hierarchy now = building.now;
    Transaction transaction(now);
    derive(now, transaction, building.rules,
           {0, Delta::free(map_of(random_gesture(9, number, box), 1))});
    EXPECT_LT(building_violation(now), 1e-9) << "gesture " << number;
    for (const int e : tagged) {
      const auto p = now.parameters(e), q = building.rest.parameters(e);
      EXPECT_TRUE(now.present(e) && std::equal(p.begin(), p.end(), q.begin())) << now.label(e);
    }
  }
}

TEST(GrammarBuildingRules, StoppedStoreyStaysWhereItIs) {
  BuildingCase building;
  const int storey = building.storey(2);
  building.now.set_tag(storey, {1, Tag::Follow::stop});
  building.apply(0, Delta::translate({2, 0, 1}));
  EXPECT_TRUE(same_element(building.rest, building.now, storey));
  EXPECT_LT(building_violation(building.now), 1e-9);
}

TEST(GrammarBuildingRules, NoOpeningJumpsWhileAGestureGrows) {
  const BuildingCase building;
  const Gesture gesture = random_gesture(5, 3, building_bounds(building.rest));
  std::optional<Hierarchy> last;
  std::shared_ptr<const SpatialMap> before;
  for (int step = 0; step <= 30; ++step) {
    const auto map = map_of(gesture, step / 30.);
    Hierarchy now = building.rest;
    Transaction transaction(now);
    derive(now, transaction, building.rules, {0, Delta::free(map)});
    for (int e = 0; last && e < building.rest.size(); ++e) {
      if (!now.present(e) || !last->present(e)) continue;
      const Eigen::Vector3d& x = building.rest.position(e);
      const double asked = (map->at(x) - before->at(x)).norm();
      EXPECT_LT((now.position(e) - last->position(e)).norm(), asked + 0.5) << now.label(e);
    }
    last = now;
    before = map;
  }
}

TEST(GrammarBuildingRules, ParametersThatFollowCannotBeSet) {
  BuildingCase building;
  const int roof = present_children(building.rest, 0, "roof").front();
  EXPECT_THROW(building.apply(roof, Delta::set(RoofParameter::width, 5)), Error);
  EXPECT_THROW(building.apply(building.wall(1, 0), Delta::set(WallParameter::side, 2)), Error);
  EXPECT_THROW(building.apply(0, Delta::set(0, 1)), Error);
  for (int e = 0; e < building.rest.size(); ++e)
    EXPECT_TRUE(same_element(building.rest, building.now, e));
}

}  // namespace
}  // namespace geoprior::grammar
