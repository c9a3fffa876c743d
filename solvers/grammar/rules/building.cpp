// Buildings: the building reads once what is asked of it, and from that plans how many storeys
// there are and the box of each; a storey takes its box, walls follow from the box, openings from
// the wall. An edit goes up as far as something has to make room: an opening's to the wall, a
// wall's to the storey, and to the building where the overhang, the height or the roof is
// concerned. What each becomes is in building_plan.h.
//
// The plan of the derivation under way is kept with the rules and their copies: one derivation at a
// time.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "core/error.h"
#include "models/grammar/objects/building_layout.h"
#include "solvers/grammar/rules/building_plan.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

using SharedBuildingPlan = std::shared_ptr<BuildingPlan>;

BuildingPlan& building_plan_in(const SharedBuildingPlan& plan, const RuleCall& call) {
  const bool begins = call.phase() == Phase::up && call.origin() == Origin::user;
  if (begins || plan->derivation != call.derivation()) *plan = {.derivation = call.derivation()};
  return *plan;
}

/// Storeys go and come.
/// @return  those that are to be asked: new ones, and those whose boxes change
std::vector<int> renew_storeys(RuleCall& call, BuildingPlan& plan, int building,
                               StoreyStack& stack) {
  const Hierarchy& h = call.now();
  for (const int storey : storeys_of(h, building))
    if (std::find(stack.storeys.begin(), stack.storeys.end(), storey) == stack.storeys.end())
      call.remove(storey);
  std::vector<int> absent, asked;
  for (const int child : h.children(building))
    if (!h.present(child) && h.type(child).name == "storey" &&
        call.parameter_before(child, StoreyParameter::base) == 0)
      absent.push_back(child);
  std::size_t used = 0;
  int pattern = -1;
  for (std::size_t i = 0; i < stack.storeys.size(); ++i) {
    int& storey = stack.storeys[i];
    const StoreyBox& box = stack.boxes[i];
    if (storey >= 0) {
      pattern = storey;
      if (box == stack.wishes[i].rest) continue;
    } else if (used < absent.size()) {
      storey = absent[used++];
      call.restore(storey);
      plan.pattern[storey] = pattern;
    } else {
      storey = call.spawn(h.find_type("storey"), building, {box.bottom, turn_of_yaw(box.yaw)},
                          std::array{box.width, box.depth, box.height, 0.});
      plan.pattern[storey] = pattern;
    }
    plan.storeys[storey] = box;
    asked.push_back(storey);
  }
  return asked;
}

/// The building goes where its ground storey does.
void place_building(RuleCall& call, int building, const StoreyStack& stack) {
  const StoreyBox &before = stack.wishes[0].rest, &now = stack.boxes[0];
  if (now == before) return;
  const Pose root = call.pose_before(building);
  const Eigen::Quaterniond turn = turn_of_yaw(now.yaw - before.yaw);
  call.set_pose(building, {now.bottom + turn * (root.position - before.bottom),
                           now.yaw == before.yaw ? root.turn : turn * root.turn});
}

/// Asks the storeys that come or change, and the roofs that change with the top one.
void ask_parts(RuleCall& call, BuildingPlan& plan, int building, StoreyStack& stack,
               const SpatialMap* map) {
  std::vector<int> asked = renew_storeys(call, plan, building, stack);
  const std::vector<int> roofs = plan_roofs(call, plan, building, stack, map);
  asked.insert(asked.end(), roofs.begin(), roofs.end());
  call.down(building, asked, call.delta());
}

void building_down(RuleCall& call, BuildingPlan& plan) {
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int building = call.elements()[i];
    const auto map = building_map(call, i);
    if (plan.wanted_storey) {
      const auto& [storey, wanted] = *plan.wanted_storey;
      std::optional<StoreyStack> stack = stack_by_edit(call, building, storey, wanted);
      if (stack) ask_parts(call, plan, building, *stack, nullptr);
    } else if (map != nullptr) {
      std::optional<StoreyStack> stack = stack_by_map(call, building, *map);
      if (!stack) continue;
      place_building(call, building, *stack);
      ask_parts(call, plan, building, *stack, map.get());
    } else if (call.kind() != DeltaKind::identity) {
      throw Error("is not understood", "building", "free, rigid, affine, translate");
    }
  }
}

/// A motion for elements that nobody planned for: rules were left out.
Pose building_part_moved(const RuleCall& call, std::size_t i, const Pose& pose) {
  const auto map = building_map(call, i);
  if (map == nullptr) return pose;
  const MappedPoint m = map->with_jacobian(pose.position);
  return {m.position, (rotation_of(m.jacobian) * pose.turn).normalized()};
}

/// A storey takes its box and asks its four walls; what is missing of them comes.
void storey_down(RuleCall& call, BuildingPlan& plan) {
  const Hierarchy& h = call.now();
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int storey = call.elements()[i];
    const auto planned = plan.storeys.find(storey);
    const StoreyBox box = planned != plan.storeys.end() ? planned->second : lone_box(call, i);
    const Pose before = call.pose_before(storey);
    const Pose pose{box.bottom,
                    box.yaw == yaw_of(before.turn) ? before.turn : turn_of_yaw(box.yaw)};
    call.set_pose(storey, pose);
    call.set_parameter(storey, StoreyParameter::width, box.width);
    call.set_parameter(storey, StoreyParameter::depth, box.depth);
    call.set_parameter(storey, StoreyParameter::height, box.height);
    std::array<int, 4> walls{-1, -1, -1, -1};
    for (const int child : h.children(storey))
      if (h.type(child).name == "wall")
        walls[static_cast<std::size_t>(h.parameter(child, WallParameter::side))] = child;
    for (int side = 0; side < 4; ++side) {
      int& wall = walls[side];
      if (wall < 0)
        wall = call.spawn(h.find_type("wall"), storey, wall_pose(pose, side, box.width, box.depth),
                          wall_parameters(side, box.width, box.depth, box.height));
      call.restore(wall);
    }
    call.down(storey, {walls.begin(), walls.end()}, call.delta());
  }
}

void set_opening(RuleCall& call, int element, const Opening& o) {
  call.set_pose(element, opening_pose(call.now().pose(call.now().parent(element)), o));
  call.set_parameter(element, OpeningParameter::width, o.width);
  call.set_parameter(element, OpeningParameter::height, o.height);
  call.set_parameter(element, OpeningParameter::along, o.along);
  call.set_parameter(element, OpeningParameter::sill, o.sill);
}

void lay_out_wall(RuleCall& call, BuildingPlan& plan, int wall) {
  const Hierarchy& h = call.now();
  const WallRow row = plan_wall(call, plan, wall);
  std::vector<int> absent, asked;
  for (const int child : h.children(wall))
    if (!h.present(child) && h.type(child).name == "window") absent.push_back(child);
  const Pose pose = h.pose(wall);
  std::size_t used = 0;
  std::set<int> kept;
  for (const auto& [o, origin] : row.laid) {
    const int element = origin < 0 ? -1 : row.elements[origin];
    if (element >= 0) {
      plan.openings[element] = o;
      asked.push_back(element);
      kept.insert(element);
    } else if (used < absent.size()) {
      const int restored = absent[used++];
      call.restore(restored);
      set_opening(call, restored, o);
    } else {
      call.spawn(h.find_type("window"), wall, opening_pose(pose, o),
                 std::array{o.width, o.height, o.along, o.sill});
    }
  }
  for (const int element : row.elements)
    if (element >= 0 && !kept.contains(element)) call.remove(element);
  call.down(wall, asked, call.delta());
}

/// Walls follow from the storey's box, as it is by now.
void wall_down(RuleCall& call, BuildingPlan& plan) {
  const Hierarchy& h = call.now();
  for (const int wall : call.elements()) {
    const int storey = h.parent(wall);
    const auto side = static_cast<int>(h.parameter(wall, WallParameter::side));
    const double width = h.parameter(storey, StoreyParameter::width);
    const double depth = h.parameter(storey, StoreyParameter::depth);
    call.set_pose(wall, wall_pose(h.pose(storey), side, width, depth));
    const std::vector<double> values =
        wall_parameters(side, width, depth, h.parameter(storey, StoreyParameter::height));
    for (int p = 0; p < std::ssize(values); ++p) call.set_parameter(wall, p, values[p]);
    lay_out_wall(call, plan, wall);
  }
}

void opening_down(RuleCall& call, const BuildingPlan& plan) {
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int e = call.elements()[i];
    const auto planned = plan.openings.find(e);
    if (planned == plan.openings.end()) {
      call.set_pose(e, building_part_moved(call, i, call.pose_before(e)));
      continue;
    }
    set_opening(call, e, planned->second);
  }
}

void roof_down(RuleCall& call, const BuildingPlan& plan) {
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int e = call.elements()[i];
    const auto planned = plan.roofs.find(e);
    if (planned == plan.roofs.end()) {
      call.set_pose(e, building_part_moved(call, i, call.pose_before(e)));
      continue;
    }
    call.set_pose(e, planned->second.pose);
    call.set_parameter(e, RoofParameter::width, planned->second.width);
    call.set_parameter(e, RoofParameter::depth, planned->second.depth);
    call.set_parameter(e, RoofParameter::rise, planned->second.rise);
  }
}

/// The value that an edit gives a parameter.
double wanted_building_value(const RuleCall& call, int element) {
  const double value = call.delta().value;
  if (call.kind() == DeltaKind::set_parameter) return value;
  return value + call.parameter_before(element, call.delta().parameter);
}

bool sets_building_parameter(const RuleCall& call) {
  return call.kind() == DeltaKind::set_parameter || call.kind() == DeltaKind::extrude;
}

/// A roof's own edit: its rise, eaves and ridge; what else it is follows from the storey below.
void roof_edited(RuleCall& call) {
  const int e = call.elements().front();
  int parameter = RoofParameter::rise;
  double value = call.parameter_before(e, parameter);
  if (sets_building_parameter(call)) {
    parameter = call.delta().parameter;
    value = wanted_building_value(call, e);
  } else if (const auto map = building_map(call, 0)) {
    std::vector<Eigen::Vector3d> keys;
    call.keys_before(e, keys);
    value = std::clamp(value + map->at(keys.back()).z() - keys.back().z(), kLeastRoofRise,
                       kMostRoofRise);
  }
  if (parameter < RoofParameter::rise)
    throw Error("width and depth of a roof are its storey's", "roof", "rise, eaves, ridge");
  call.set_parameter(e, parameter, value);
}

/// What a window's or a door's edit would make of it; the wall gives it room.
void opening_up(RuleCall& call, BuildingPlan& plan) {
  const int e = call.elements().front();
  Opening o = opening_before(call, e);
  if (sets_building_parameter(call)) {
    const double value = wanted_building_value(call, e);
    switch (call.delta().parameter) {
      case OpeningParameter::width:
        o.width = value;
        break;
      case OpeningParameter::height:
        o.height = value;
        break;
      case OpeningParameter::along:
        o.along = value;
        break;
      case OpeningParameter::sill:
        o.sill = value;
        break;
      default:
        throw Error("has no such parameter", "opening", "width, height, along, sill");
    }
  } else if (const auto map = building_map(call, 0)) {
    std::vector<Eigen::Vector3d> x;
    call.keys_before(e, x);
    for (Eigen::Vector3d& key : x)
      key = call.pose_before(e).turn.conjugate() * (map->at(key) - key);
    o.along += x[0].x();
    o.width += (x[2] + x[3] - x[1] - x[4]).x() / 2;
    const double taller = (x[3] + x[4] - x[1] - x[2]).z() / 2;
    o.height += taller;
    o.sill += x[0].z() - taller / 2;
  }
  plan.wanted_opening = {e, o};
  call.up(call.delta());
}

/// A wall's edit, as its storey's: what moves it outwards makes the storey grow on that side.
void wall_up(RuleCall& call, BuildingPlan& plan) {
  if (call.origin() == Origin::child) {
    call.absorb(call.delta());
    return;
  }
  const int wall = call.elements().front(), storey = call.now().parent(wall);
  const StoreyWish wish = read_wish(call, storey, nullptr);
  StoreyBox box = wish.rest;
  const bool front = std::lround(call.parameter_before(wall, WallParameter::side)) % 2 == 0;
  double& length = front ? box.width : box.depth;
  double& across = front ? box.depth : box.width;
  double outwards = 0;
  const Eigen::Vector3d normal = call.pose_before(wall).turn * -Eigen::Vector3d::UnitY();
  if (sets_building_parameter(call)) {
    const double value = wanted_building_value(call, wall);
    switch (call.delta().parameter) {
      case WallParameter::length:
        length = value;
        break;
      case WallParameter::height:
        box.height = value;
        break;
      case WallParameter::offset:
        outwards = value - across / 2;
        break;
      default:
        throw Error("the side of a wall cannot be changed", "wall", "length, height, offset");
    }
  } else if (const auto map = building_map(call, 0)) {
    std::vector<Eigen::Vector3d> keys;
    call.keys_before(wall, keys);
    for (const Eigen::Vector3d& x : keys) outwards += normal.dot(map->at(x) - x) / 4;
  }
  const double least = front ? wish.least_depth : wish.least_width;
  if (!wish.hold_size) {
    outwards = std::max(outwards, least - across);
    across += outwards;
    outwards /= 2;
  }
  box.bottom += outwards * normal;
  plan.wanted_storey = {storey, box};
  call.up(call.delta());
}

/// A storey's edit ends with it when its neighbours still fit; else the building moves them.
void storey_up(RuleCall& call, BuildingPlan& plan) {
  const int storey = call.elements().front();
  const StoreyWish wish = read_wish(call, storey, nullptr);
  const StoreyBox& rest = wish.rest;
  StoreyBox box = plan.wanted_storey ? plan.wanted_storey->second : rest;
  if (sets_building_parameter(call) && call.origin() == Origin::user) {
    const double value = wanted_building_value(call, storey);
    switch (call.delta().parameter) {
      case StoreyParameter::width:
        box.width = value;
        break;
      case StoreyParameter::depth:
        box.depth = value;
        break;
      case StoreyParameter::height:
        box.height = value;
        break;
      default:
        throw Error("the base of a storey cannot be changed", "storey", "width, depth, height");
    }
  } else if (call.origin() == Origin::user && building_map(call, 0) != nullptr) {
    box = lone_box(call, 0);
  }
  box.bottom.z() = rest.bottom.z();
  box.width = wish.hold_size ? rest.width : std::max(box.width, wish.least_width);
  box.depth = wish.hold_size ? rest.depth : std::max(box.depth, wish.least_depth);
  box.height =
      wish.hold_size ? rest.height : std::clamp(box.height, wish.least_height, wish.most_height);
  plan.wanted_storey = {storey, box};
  const std::vector<int> stack = storeys_of(call.now(), call.now().parent(storey));
  const auto own = std::find(stack.begin(), stack.end(), storey);
  const bool fits =
      box.height == rest.height && own + 1 != stack.end() && call.kind() != DeltaKind::free &&
      overhang(box, box_before(call, *(own + 1))) <= kMostOverhang &&
      (own == stack.begin() || overhang(box_before(call, *(own - 1)), box) <= kMostOverhang);
  if (!fits) {
    call.up(call.delta());
    return;
  }
  plan.storeys[storey] = box;
  call.absorb(call.delta());
}

}  // namespace

RuleSet building_rules() {
  const auto shared = std::make_shared<BuildingPlan>();
  RuleSet rules;
  const auto add = [&](const char* name, const char* type, Phase phase, auto rule,
                       std::optional<Origin> origin = {}) {
    rules.add(
        {.name = name,
         .guard = {.type = type, .origin = origin, .phase = phase},
         .apply = [shared, rule](RuleCall& call) { rule(call, building_plan_in(shared, call)); }});
  };
  const auto absorbs = [](RuleCall& call, BuildingPlan&) { call.absorb(call.delta()); };
  add("building plans", "building", Phase::down, building_down);
  add("storey takes its box", "storey", Phase::down, storey_down);
  for (const Origin origin : {Origin::parent, Origin::child})
    add("wall follows its storey", "wall", Phase::down, wall_down, origin);
  for (const char* type : {"window", "door"}) {
    add("opening follows its wall", type, Phase::down, opening_down, Origin::parent);
    add("opening asks its wall", type, Phase::up, opening_up);
  }
  add("roof follows", "roof", Phase::down, roof_down, Origin::parent);
  add(
      "roof edited", "roof", Phase::down, [](RuleCall& call, BuildingPlan&) { roof_edited(call); },
      Origin::user);
  add("roof bounds", "roof", Phase::up, absorbs);
  add("wall asks its storey", "wall", Phase::up, wall_up);
  add("storey asks the building", "storey", Phase::up, storey_up);
  add("building bounds", "building", Phase::up, absorbs);
  return rules;
}

}  // namespace geoprior::grammar
