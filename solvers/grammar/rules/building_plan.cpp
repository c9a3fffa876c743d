#include "solvers/grammar/rules/building_plan.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior::grammar {
namespace {

constexpr int kMostStoreyCount = 400;
constexpr double kNewStoreyWeight = 0.1;  ///< of a new storey's likeness to the one below

/// The tag of an element that counts in this derivation, or null.
const Tag* building_tag(const RuleCall& call, int element) {
  const Tag* tag = call.now().tag(element);
  return tag != nullptr && call.now().is_below(call.edited(), element) ? nullptr : tag;
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

void insert_storey(StoreyStack& stack, int at) {
  StoreyWish wish{.rest = stack.wishes[at - 1].rest};
  wish.rest.height = std::clamp(wish.rest.height, kLeastStoreyHeight, kMostStoreyHeight);
  wish_for(wish, wish.rest, kNewStoreyWeight);
  stack.storeys.insert(stack.storeys.begin() + at, -1);
  stack.wishes.insert(stack.wishes.begin() + at, wish);
}

void erase_storey(StoreyStack& stack, int at) {
  stack.storeys.erase(stack.storeys.begin() + at);
  stack.wishes.erase(stack.wishes.begin() + at);
}

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
      insert_storey(stack, best);
      middles.insert(middles.begin() + best, slot * (best + 0.5));
    } else {
      erase_storey(stack, best);
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

/// The openings before; of a new storey those of the storey that it repeats.
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

}  // namespace

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

Opening opening_before(const RuleCall& call, int element) {
  return {.along = call.parameter_before(element, OpeningParameter::along),
          .width = call.parameter_before(element, OpeningParameter::width),
          .sill = call.parameter_before(element, OpeningParameter::sill),
          .height = call.parameter_before(element, OpeningParameter::height),
          .door = call.now().type(element).name == "door",
          .held = building_tag(call, element) != nullptr};
}

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

std::optional<StoreyStack> stack_by_map(const RuleCall& call, int building, const SpatialMap& map) {
  StoreyStack stack = read_stack(call, building, &map);
  if (stack.storeys.empty()) return std::nullopt;
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
  return stack;
}

std::optional<StoreyStack> stack_by_edit(const RuleCall& call, int building, int storey,
                                         const StoreyBox& wanted) {
  StoreyStack stack = read_stack(call, building, nullptr);
  const auto found = std::find(stack.storeys.begin(), stack.storeys.end(), storey);
  if (found == stack.storeys.end()) return std::nullopt;
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
  if (!fits) return std::nullopt;
  std::vector<double> levels;
  double rise = 0;
  for (const StoreyWish& w : stack.wishes) {
    levels.push_back(w.rest.bottom.z() + rise);
    if (w.given && !stack.stopped) rise = wanted.height - w.rest.height;
  }
  levels.push_back(stack.wishes.back().rest.bottom.z() + stack.wishes.back().rest.height + rise);
  stack_up(stack, levels);
  return stack;
}

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

std::vector<int> plan_roofs(const RuleCall& call, BuildingPlan& plan, int building,
                            const StoreyStack& stack, const SpatialMap* map) {
  std::vector<int> asked;
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
  return asked;
}

WallRow plan_wall(const RuleCall& call, const BuildingPlan& plan, int wall) {
  const Hierarchy& h = call.now();
  WallRow row = read_wall_row(call, plan, wall);
  const double length = h.parameter(wall, WallParameter::length);
  const double height = h.parameter(wall, WallParameter::height);
  for (std::size_t i = 0; i < row.openings.size(); ++i)
    if (plan.wanted_opening && row.elements[i] == plan.wanted_opening->first)
      fit_wanted(row, length, height, row.openings[i]);
  row.laid = lay_out_row(row.openings, row.length, row.height, length, height);
  return row;
}

}  // namespace geoprior::grammar
