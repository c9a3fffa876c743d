#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "models/grammar/objects/building_layout.h"
#include "solvers/grammar/rules/rules.h"

// Rules of the building. What is asked of it is read once, by the building: where the map takes the
// corners and openings of its storeys. From that it plans how many storeys there are and the box of
// each; a storey takes its box, walls follow from the box, openings from the wall. An edit goes up
// as far as something has to make room: an opening's to the wall, a wall's to the storey, and to
// the building where the overhang, the height or the roof is concerned.
//
// The plan of the derivation under way is kept with the rules and their copies: one derivation at a
// time.
namespace geoprior::grammar {
namespace {

constexpr int kMostStoreyCount = 400;
constexpr double kNewStoreyWeight = 0.1;  ///< of a new storey's likeness to the one below

struct RoofPlace {
  Pose pose;
  double width = 0, depth = 0, rise = 0;
};

/// What the rules prepare for the elements below, in one derivation.
struct BuildingPlan {
  std::uint64_t derivation = 0;
  std::map<int, StoreyBox> storeys = {};
  std::map<int, RoofPlace> roofs = {};
  std::map<int, Opening> openings = {};
  std::map<int, int> pattern = {};  ///< of a new storey: whose openings it repeats
  std::optional<std::pair<int, StoreyBox>> wanted_storey = {};  ///< by an edit
  std::optional<std::pair<int, Opening>> wanted_opening = {};
};
using SharedBuildingPlan = std::shared_ptr<BuildingPlan>;

BuildingPlan& building_plan_in(const SharedBuildingPlan& plan, const RuleCall& call) {
  const bool begins = call.phase() == Phase::up && call.origin() == Origin::user;
  if (begins || plan->derivation != call.derivation()) *plan = {.derivation = call.derivation()};
  return *plan;
}

/// The map that a deformation is; null of a kind that is none.
std::shared_ptr<const SpatialMap> building_map(const RuleCall& call, std::size_t i) {
  switch (call.kind()) {
    case DeltaKind::free:
      return call.delta().map;
    case DeltaKind::rigid:
    case DeltaKind::affine:
    case DeltaKind::translate:
      return std::make_shared<AffineMap>(call.transform(i));
    default:
      return nullptr;
  }
}

StoreyBox box_before(const RuleCall& call, int storey) {
  return storey_box(call.pose_before(storey), call.parameter_before(storey, StoreyParameter::width),
                    call.parameter_before(storey, StoreyParameter::depth),
                    call.parameter_before(storey, StoreyParameter::height));
}

/// The tag of an element that counts in this derivation, or null.
const Tag* building_tag(const RuleCall& call, int element) {
  const Tag* tag = call.now().tag(element);
  return tag != nullptr && call.now().is_below(call.edited(), element) ? nullptr : tag;
}

Opening opening_before(const RuleCall& call, int element) {
  return {.along = call.parameter_before(element, OpeningParameter::along),
          .width = call.parameter_before(element, OpeningParameter::width),
          .sill = call.parameter_before(element, OpeningParameter::sill),
          .height = call.parameter_before(element, OpeningParameter::height),
          .door = call.now().type(element).name == "door",
          .held = building_tag(call, element) != nullptr};
}

Opening opening_of(const Hierarchy& h, int element) {
  return {.along = h.parameter(element, OpeningParameter::along),
          .width = h.parameter(element, OpeningParameter::width),
          .sill = h.parameter(element, OpeningParameter::sill),
          .height = h.parameter(element, OpeningParameter::height),
          .door = h.type(element).name == "door"};
}

/// Openings of a wall that are present.
std::vector<int> openings_of(const Hierarchy& h, int wall) {
  std::vector<int> out = present_children(h, wall, "window");
  const std::vector<int> doors = present_children(h, wall, "door");
  out.insert(out.end(), doors.begin(), doors.end());
  return out;
}

/// Tags below a storey: what it has to keep for them.
void add_holds(const RuleCall& call, int element, StoreyWish& wish) {
  const Tag* tag = building_tag(call, element);
  if (tag == nullptr) return;
  wish.keep = true;
  if (tag->follow == Tag::Follow::stop) wish.hold_place = true;
  const std::string& type = call.now().type(element).name;
  if (type == "storey" || type == "wall") {
    wish.hold_size = true;
    return;
  }
  const Opening o = opening_before(call, element);
  const int wall = call.now().parent(element);
  const bool front = std::lround(call.parameter_before(wall, WallParameter::side)) % 2 == 0;
  double& least = front ? wish.least_width : wish.least_depth;
  least = std::max(least, o.along + o.width / 2 + kWallEnd);
  wish.least_height = std::max(wish.least_height, o.sill + o.height + kWallTop);
}

/// What a map asks of a storey: of its corners, as often as its own key points and its walls' name
/// them, and of the centres of its openings. Without a map: to stay.
StoreyWish read_wish(const RuleCall& call, int storey, const SpatialMap* map) {
  const Hierarchy& h = call.now();
  StoreyWish wish{.rest = box_before(call, storey)};
  const StoreyBox& box = wish.rest;
  const Pose pose = call.pose_before(storey);
  std::vector<Eigen::Vector3d> keys;
  const auto add = [&](double weight) {
    for (const Eigen::Vector3d& x : keys) {
      const Eigen::Vector3d local = pose.turn.conjugate() * (x - pose.position);
      const Eigen::Vector3d target = map->at(x);
      wish.plan.add(local.x() / box.width, local.y() / box.depth, weight, target.head<2>());
      wish.rise.add(local.z() / box.height, weight, target.z());
      wish.moved = wish.moved || target != x;
    }
  };
  call.keys_before(storey, keys);
  if (map != nullptr) add(0.625);
  add_holds(call, storey, wish);
  keys.clear();
  for (const int wall : present_children(h, storey, "wall")) {
    add_holds(call, wall, wish);
    for (const int opening : openings_of(h, wall)) {
      add_holds(call, opening, wish);
      keys.push_back(call.pose_before(opening).position);
    }
  }
  if (map != nullptr) add(1);
  if (map == nullptr) wish_for(wish, box, 5 + static_cast<double>(keys.size()));
  return wish;
}

/// A building's storeys from the ground up, -1: a new one, and what is asked of them.
struct StoreyStack {
  std::vector<int> storeys;
  std::vector<StoreyWish> wishes;
  std::vector<StoreyBox> boxes;
  bool stopped = false;  ///< a tag keeps part of it in its place

  void insert(int at) {
    StoreyWish wish{.rest = wishes[at - 1].rest};
    wish.rest.height = std::clamp(wish.rest.height, kLeastStoreyHeight, kMostStoreyHeight);
    wish_for(wish, wish.rest, kNewStoreyWeight);
    storeys.insert(storeys.begin() + at, -1);
    wishes.insert(wishes.begin() + at, wish);
  }
  void erase(int at) {
    storeys.erase(storeys.begin() + at);
    wishes.erase(wishes.begin() + at);
  }
};

StoreyStack read_stack(const RuleCall& call, int building, const SpatialMap* map) {
  StoreyStack stack;
  stack.storeys = storeys_of(call.now(), building);
  int stopped = -1;
  for (const int storey : stack.storeys) {
    stack.wishes.push_back(read_wish(call, storey, map));
    if (stack.wishes.back().hold_place) stopped = static_cast<int>(stack.wishes.size()) - 1;
  }
  stack.stopped = stopped >= 0;
  // What carries a storey that stays in its place keeps its height.
  for (int i = 0; i <= stopped; ++i) {
    StoreyWish& wish = stack.wishes[i];
    wish.least_height = wish.most_height = wish.rest.height;
  }
  for (const int roof : present_children(call.now(), building, "roof")) {
    if (stack.wishes.empty()) break;
    if (building_tag(call, roof) == nullptr) continue;
    stack.wishes.back().hold_size = stack.wishes.back().keep = true;
  }
  return stack;
}

/// How well the storeys' mapped middles lie in a stack of even storeys, one more or one less.
double slot_cost(const std::vector<double>& middles, int at, double slot, bool more) {
  double sum = 0;
  for (int i = 0; i < std::ssize(middles); ++i) {
    if (!more && i == at) continue;
    const int place = more ? i + (i >= at) : i - (i > at);
    const double off = middles[i] - slot * (place + 0.5);
    sum += off * off;
  }
  return sum;
}

/// Whether a storey is to come (1) or to go (-1), so that the heights' range is nearer to the one
/// that is wanted.
int storeys_missing(const StoreyStack& stack, double wanted) {
  double least = 0, most = 0;
  for (const StoreyWish& wish : stack.wishes) {
    least += wish.hold_size ? wish.rest.height : wish.least_height;
    most += wish.hold_size ? wish.rest.height : wish.most_height;
  }
  const auto off = [&](int more) {
    return std::max(wanted - most - more * kMostStoreyHeight,
                    least + more * kLeastStoreyHeight - wanted);
  };
  if (wanted > most) return off(1) < off(0) ? 1 : 0;
  return wanted < least && off(-1) < off(0) ? -1 : 0;
}

/// Where all storeys are at their limit, one comes or goes, there where the others lie nearest to
/// where they are mapped.
void count_storeys(StoreyStack& stack, double ground, double wanted) {
  std::vector<double> middles;
  for (const StoreyWish& wish : stack.wishes) middles.push_back(wish.rise.t / wish.rise.s - ground);
  while (const int missing = storeys_missing(stack, wanted)) {
    const bool more = missing > 0;
    const int n = static_cast<int>(middles.size());
    if (n >= kMostStoreyCount && more)
      throw Error("would need more storeys", "building", std::to_string(kMostStoreyCount));
    const double slot = std::max(0., wanted) / (n + missing);
    int best = -1;
    double lowest = 0;
    for (int at = 1; at < n + more; ++at) {
      // A roof that is held stays on its storey.
      const StoreyWish& wish = stack.wishes[std::min(at, n - 1)];
      if (more ? at == n && wish.hold_size : wish.keep) continue;
      const double cost = slot_cost(middles, at, slot, more);
      if (best >= 0 && cost >= lowest) continue;
      best = at;
      lowest = cost;
    }
    if (best < 0) return;
    if (more) {
      stack.insert(best);
      middles.insert(middles.begin() + best, slot * (best + 0.5));
    } else {
      stack.erase(best);
      middles.erase(middles.begin() + best);
    }
  }
}

/// Puts the storeys on one another. A height that differs by round-off only stays.
void stack_up(StoreyStack& stack, const std::vector<double>& levels) {
  for (std::size_t i = 0; i < stack.boxes.size(); ++i) {
    const double own = stack.wishes[i].rest.height, height = levels[i + 1] - levels[i];
    stack.boxes[i].bottom.z() = levels[i];
    stack.boxes[i].height = std::abs(height - own) < 1e-10
                                ? own
                                : std::clamp(height, kLeastStoreyHeight, kMostStoreyHeight);
  }
}

/// Storeys in their boxes: some go, some come, those that change are asked.
void ask_storeys(RuleCall& call, BuildingPlan& plan, int building, StoreyStack& stack,
                 std::vector<int>& asked) {
  const Hierarchy& h = call.now();
  for (const int storey : storeys_of(h, building))
    if (std::find(stack.storeys.begin(), stack.storeys.end(), storey) == stack.storeys.end())
      call.remove(storey);
  std::vector<int> absent;
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
}

/// Where the roof lies on the top storey; its rise follows the apex.
void ask_roofs(RuleCall& call, BuildingPlan& plan, int building, const StoreyStack& stack,
               const SpatialMap* map, std::vector<int>& asked) {
  const StoreyBox& top = stack.boxes.back();
  for (const int roof : present_children(call.now(), building, "roof")) {
    std::vector<Eigen::Vector3d> keys;
    call.keys_before(roof, keys);
    const Eigen::Vector3d apex = map != nullptr ? map->at(keys.back()) : keys.back();
    if (stack.storeys.back() >= 0 && top == box_before(call, stack.storeys.back()) &&
        apex == keys.back())
      continue;
    RoofPlace& place = plan.roofs[roof];
    place.pose = {top.bottom + Eigen::Vector3d(0, 0, top.height), turn_of_yaw(top.yaw)};
    place.width = top.width;
    place.depth = top.depth;
    place.rise = call.parameter_before(roof, RoofParameter::rise);
    if (map != nullptr && building_tag(call, roof) == nullptr)
      place.rise = std::clamp(apex.z() - place.pose.position.z(), kLeastRoofRise, kMostRoofRise);
    asked.push_back(roof);
  }
}

/// The eaves are asked for, too, of the storey that carries them.
void add_eaves(const RuleCall& call, int building, const SpatialMap& map, StoreyWish& top) {
  for (const int roof : present_children(call.now(), building, "roof")) {
    std::vector<Eigen::Vector3d> keys;
    call.keys_before(roof, keys);
    const double jut = 2 * call.parameter_before(roof, RoofParameter::eaves);
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d target = map.at(keys[k]);
      const double a = (k == 0 || k == 3 ? -0.5 : 0.5) * (1 + jut / top.rest.width);
      const double b = (k < 2 ? -0.5 : 0.5) * (1 + jut / top.rest.depth);
      top.plan.add(a, b, 0.2, target.head<2>());
      top.rise.add(1, 0.2, target.z());
      top.moved = top.moved || target != keys[k];
    }
  }
}

/// Levels of a storey's floor and ceiling that fit best, whatever stands beside it.
Eigen::Vector2d lone_levels(const HeightFit& f) {
  const double det = f.s * f.scc - f.sc * f.sc;
  const double floor = (f.scc * f.t - f.sc * f.tc) / det;
  return {floor, floor + (f.s * f.tc - f.sc * f.t) / det};
}

void begin_boxes(StoreyStack& stack) {
  stack.boxes.clear();
  for (const StoreyWish& wish : stack.wishes) stack.boxes.push_back(wish.rest);
}

void plan_by_map(RuleCall& call, BuildingPlan& plan, int building, const SpatialMap& map) {
  const Pose root = call.pose_before(building);
  StoreyStack stack = read_stack(call, building, &map);
  if (stack.storeys.empty()) return;
  add_eaves(call, building, map, stack.wishes.back());
  const bool still = std::none_of(stack.wishes.begin(), stack.wishes.end(),
                                  [](const StoreyWish& wish) { return wish.moved; });
  if (!stack.stopped && !still) {
    const double ground = lone_levels(stack.wishes.front().rise)(0);
    count_storeys(stack, ground, lone_levels(stack.wishes.back().rise)(1) - ground);
  }
  begin_boxes(stack);
  if (!still && fit_plans(stack.wishes, stack.boxes)) {
    stack_up(stack, fit_levels(stack.wishes));
  } else if (!still) {
    // What is held leaves no room for more than to follow the ground.
    stack = read_stack(call, building, &map);
    begin_boxes(stack);
    const Eigen::Vector3d ground = stack.boxes[0].bottom;
    if (!stack.stopped)
      for (StoreyBox& box : stack.boxes) box.bottom += map.at(ground) - ground;
  }
  const StoreyBox &before = stack.wishes[0].rest, &now = stack.boxes[0];
  if (now != before) {
    const Eigen::Quaterniond turn = turn_of_yaw(now.yaw - before.yaw);
    call.set_pose(building, {now.bottom + turn * (root.position - before.bottom),
                             now.yaw == before.yaw ? root.turn : turn * root.turn});
  }
  std::vector<int> asked;
  ask_storeys(call, plan, building, stack, asked);
  ask_roofs(call, plan, building, stack, &map, asked);
  call.down(building, asked, call.delta());
}

/// A storey gets a box, as far as what is held lets it; the others move just enough.
void plan_by_edit(RuleCall& call, BuildingPlan& plan, int building) {
  StoreyStack stack = read_stack(call, building, nullptr);
  const auto [storey, wanted] = *plan.wanted_storey;
  const auto found = std::find(stack.storeys.begin(), stack.storeys.end(), storey);
  if (found == stack.storeys.end()) return;
  StoreyWish& wish = stack.wishes[found - stack.storeys.begin()];
  const StoreyBox rest = wish.rest;
  bool fits = false;
  wish.given = true;
  for (double share = 1; !fits && share > 0.01; share /= 2) {
    StoreyBox box = wanted;
    box.bottom = rest.bottom + share * (wanted.bottom - rest.bottom);
    box.yaw = rest.yaw + share * (wanted.yaw - rest.yaw);
    box.width = rest.width + share * (wanted.width - rest.width);
    box.depth = rest.depth + share * (wanted.depth - rest.depth);
    wish.goal = share == 1 ? wanted : box;
    stack.boxes.assign(stack.wishes.size(), {});
    fits = fit_plans(stack.wishes, stack.boxes);
  }
  if (!fits) return;
  std::vector<double> levels;
  double rise = 0;
  for (const StoreyWish& w : stack.wishes) {
    levels.push_back(w.rest.bottom.z() + rise);
    if (w.given && !stack.stopped) rise = wanted.height - w.rest.height;
  }
  levels.push_back(stack.wishes.back().rest.bottom.z() + stack.wishes.back().rest.height + rise);
  stack_up(stack, levels);
  std::vector<int> asked;
  ask_storeys(call, plan, building, stack, asked);
  ask_roofs(call, plan, building, stack, nullptr, asked);
  call.down(building, asked, call.delta());
}

void building_down(RuleCall& call, BuildingPlan& plan) {
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int building = call.elements()[i];
    const auto map = building_map(call, i);
    if (plan.wanted_storey) {
      plan_by_edit(call, plan, building);
    } else if (map != nullptr) {
      plan_by_map(call, plan, building, *map);
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

/// The box of a storey that nobody planned for: as if it stood alone.
StoreyBox lone_box(const RuleCall& call, std::size_t i) {
  const int storey = call.elements()[i];
  const auto map = building_map(call, i);
  std::vector<StoreyWish> wish{read_wish(call, storey, map.get())};
  std::vector<StoreyBox> box{wish[0].rest};
  if (map == nullptr || !fit_plans(wish, box)) return wish[0].rest;
  const std::vector<double> levels = fit_levels(wish);
  box[0].bottom.z() = levels[0];
  box[0].height = std::clamp(levels[1] - levels[0], kLeastStoreyHeight, kMostStoreyHeight);
  return box[0];
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

/// The elements of a wall's openings from its start, and the openings before; of a new storey those
/// of the storey that it repeats, with windows for doors.
struct WallRow {
  std::vector<int> elements;
  std::vector<Opening> openings;
  double length = 1, height = 1;
};

WallRow read_wall_row(const RuleCall& call, const BuildingPlan& plan, int wall) {
  const Hierarchy& h = call.now();
  const int storey = h.parent(wall), side = static_cast<int>(h.parameter(wall, 2));
  const auto pattern = plan.pattern.find(storey);
  int from = wall;
  if (pattern != plan.pattern.end())
    for (const int other : present_children(h, pattern->second, "wall"))
      if (static_cast<int>(h.parameter(other, WallParameter::side)) == side) from = other;
  WallRow row;
  row.elements = openings_of(h, from);
  // A storey that is repeated stands below, and has its new walls by now.
  row.length = from == wall ? call.parameter_before(wall, WallParameter::length)
                            : h.parameter(from, WallParameter::length);
  row.height = from == wall ? call.parameter_before(wall, WallParameter::height)
                            : h.parameter(from, WallParameter::height);
  std::vector<std::pair<Opening, int>> sorted;
  for (const int e : row.elements)
    sorted.emplace_back(from == wall ? opening_before(call, e) : opening_of(h, e), e);
  if (from == wall && plan.wanted_opening)
    for (auto& [opening, element] : sorted)
      if (element == plan.wanted_opening->first) opening = plan.wanted_opening->second;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first.along < b.first.along; });
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    row.elements[i] = from == wall ? sorted[i].second : -1;
    row.openings.push_back(sorted[i].first);
  }
  if (from == wall) return row;
  for (std::size_t i = 0; i < row.openings.size(); ++i) {
    Opening& o = row.openings[i];
    if (!std::exchange(o.door, false)) continue;
    const Opening& beside = row.openings[i > 0 ? i - 1 : std::min(i + 1, row.openings.size() - 1)];
    o.width = beside.width;
    o.sill = i > 0 || row.openings.size() > 1 ? beside.sill : 0.4 * o.height;
    o.height = i > 0 || row.openings.size() > 1 ? beside.height : 0.6 * o.height;
  }
  return row;
}

/// An opening that a user asks for, as far as there is room for it on its wall.
void fit_wanted(const WallRow& row, double length, double height, Opening& o) {
  o.held = true;
  o.width = std::clamp(o.width, 0.3, 2.);
  o.height = std::clamp(o.height, 0.3, height - kWallTop);
  o.sill = o.door ? 0 : std::clamp(o.sill, 0., height - kWallTop - o.height);
  double low = kWallEnd + o.width / 2, high = length - low;
  for (const Opening& other : row.openings) {
    if (!other.held || other.along == o.along) continue;
    const double pitch = least_pitch(o, other);
    if (other.along < o.along) low = std::max(low, other.along + pitch);
    if (other.along > o.along) high = std::min(high, other.along - pitch);
  }
  o.along = std::clamp(o.along, std::min(low, high), high);
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
  WallRow row = read_wall_row(call, plan, wall);
  const double length = h.parameter(wall, WallParameter::length);
  const double height = h.parameter(wall, WallParameter::height);
  for (std::size_t i = 0; i < row.openings.size(); ++i)
    if (plan.wanted_opening && row.elements[i] == plan.wanted_opening->first)
      fit_wanted(row, length, height, row.openings[i]);
  std::vector<int> absent, asked;
  for (const int child : h.children(wall))
    if (!h.present(child) && h.type(child).name == "window") absent.push_back(child);
  const std::vector<LaidOpening> laid =
      lay_out_row(row.openings, row.length, row.height, length, height);
  const Pose pose = h.pose(wall);
  std::size_t used = 0;
  std::set<int> kept;
  for (const auto& [o, origin] : laid) {
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
