// Landscapes: the terrain is deformed, what stands on it goes along, upright. Houses are pushed
// apart, pines make room by their sizes, the path by how many stones it has
// (models/grammar/objects/spacing.h).

#include "models/grammar/objects/landscape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "models/grammar/objects/forest.h"
#include "models/grammar/objects/spacing.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

enum class Stands { pine, house, stone };

/// Number of the parameter for the triangle; b0 and b1 follow.
constexpr int place_parameter(Stands what) {
  return what == Stands::house ? HouseParameter::kTriangle : PineParameter::kTriangle;
}
static_assert(StoneParameter::kTriangle == PineParameter::kTriangle);
static_assert(StoneParameter::kSize == PineParameter::kSize);
static_assert(StoneParameter::kRadius == PineParameter::kRadius);
static_assert(StoneParameter::kCandidate == PineParameter::kCandidate);

std::optional<Stands> what_stands(const Hierarchy& h, int element) {
  const std::string& name = h.type(element).name;
  if (name == "pine") return Stands::pine;
  if (name == "house") return Stands::house;
  if (name == "stone") return Stands::stone;
  return std::nullopt;
}

/// A pine, a house or a stone, and what it is going to be.
struct Standing {
  int element = 0;
  Stands what = Stands::pine;
  bool is_fixed = false;    ///< edited, or held by a tag
  bool is_present = false;  ///< going to be
  Vector3d was{0, 0, 0};    ///< its place before
  TrianglePlace place;
  Pose pose;
  double size = 1;    ///< pine, stone
  double radius = 0;  ///< of a house too (m)
  double plinth = 0;  ///< house (m)
  double along = 0;   ///< stone
};

/// What the rules of landscapes know of the derivation that is under way.
class LandscapeGrammar {
 public:
  void landscape_down(RuleCall& call);
  void terrain_down(RuleCall& call);
  void holder_down(RuleCall& call);
  void standing_down(RuleCall& call);
  void standing_goes(RuleCall& call);
  void standing_edited(RuleCall& call);
  void passed_up(RuleCall& call);

 private:
  void begin(const RuleCall& call);
  void solve(const RuleCall& call, int landscape);
  [[nodiscard]] Standing carried(const RuleCall& call, int terrain, int e, Stands what) const;
  void place_houses(const RuleCall& call);
  [[nodiscard]] bool is_free(const Standing& house, bool earlier_only) const;
  void found_houses(const RuleCall& call);
  void drop_house(Standing& house, const SpacedCircle& circle) const;
  void require_clear(const RuleCall& call) const;
  void size_pines(const RuleCall& call);
  void lay_path(const RuleCall& call, int path);
  void write(RuleCall& call, const Standing& s) const;
  void move_standing(RuleCall& call, int e, Stands what) const;
  void edit_parameter(RuleCall& call, int e, Stands what) const;

  std::uint64_t derivation_ = 0;
  std::shared_ptr<const SpatialMap> map_;  ///< null: nothing is carried
  int scope_ = -1;                         ///< the element that the map deforms, with all below
  int solved_ = -1;                        ///< the landscape that the plan is of
  std::optional<Ground> ground_, ground_before_;
  std::vector<Standing> standings_;
  std::map<int, int> standing_of_;  ///< by element
};

std::shared_ptr<const SpatialMap> landscape_map(const RuleCall& call, std::size_t i) {
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

bool has_type(const Hierarchy& h, int e, const char* name) { return h.type(e).name == name; }

void LandscapeGrammar::begin(const RuleCall& call) {
  if (derivation_ == call.derivation()) return;
  derivation_ = call.derivation();
  map_ = nullptr;
  scope_ = solved_ = -1;
}

void LandscapeGrammar::landscape_down(RuleCall& call) {
  begin(call);
  const Hierarchy& h = call.now();
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int landscape = call.elements()[i];
    const int sender = call.origin() == Origin::child ? call.sender() : -1;
    map_ = landscape_map(call, i);
    if (sender >= 0 && !has_type(h, sender, "terrain")) {
      // Houses and pines are in each other's way; the terrain and the path are not.
      scope_ = sender;
      std::vector<int> asked;
      for (const int child : h.children(landscape))
        if (has_type(h, child, "grove") || has_type(h, child, "village")) asked.push_back(child);
      call.down(landscape, std::move(asked), Delta{});
      continue;
    }
    if (map_ == nullptr) continue;
    scope_ = landscape;
    const Pose before = call.pose_before(landscape);
    const MappedPoint at = map_->with_jacobian(before.position);
    call.set_pose(landscape, {at.position, upright_turn(at.jacobian, before.turn)});
    call.down(landscape, call.delta());
  }
}

void LandscapeGrammar::terrain_down(RuleCall& call) {
  begin(call);
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const auto map = landscape_map(call, i);
    if (map == nullptr) continue;
    for (Vector3d& x : call.points(call.elements()[i])) x = map->at(x);
  }
}

// ---- Plan --------------------------------------------------------------------------------------

/// Before anything is in its way: at its place of the terrain as that is now.
Standing LandscapeGrammar::carried(const RuleCall& call, int terrain, int e, Stands what) const {
  const Hierarchy& h = call.now();
  const bool is_edited = e == call.edited();
  const Tag* tag = h.present(e) ? h.tag(e) : nullptr;
  const int p = place_parameter(what);
  Standing s;
  s.element = e;
  s.what = what;
  s.is_fixed = is_edited || tag != nullptr;
  s.is_present = h.present(e);
  s.place = {static_cast<int>(h.parameter(e, p)), h.parameter(e, p + 1), h.parameter(e, p + 2)};
  s.pose = h.pose(e);
  // One that is not there has been taken along by its place alone.
  s.was = s.is_present
              ? call.pose_before(e).position
              : on_triangle(call.points_before(terrain), h.type(terrain).triangles, s.place);
  if (what == Stands::house) {
    s.radius = house_radius(h, e);
    s.plinth = h.parameter(e, HouseParameter::kPlinth);
  } else {
    s.radius = h.parameter(e, PineParameter::kRadius);
    s.size = s.is_present ? h.parameter(e, PineParameter::kSize) : 0;
    if (what == Stands::stone) s.along = h.parameter(e, StoneParameter::kAlong);
  }
  if (is_edited || (tag != nullptr && tag->follow == Tag::Follow::stop)) return s;
  // What a tag holds stays at its place of the ground, which is what it stands on.
  const bool is_moved_alone = map_ && scope_ == h.parent(e) && !s.is_fixed;
  const bool is_moved_with_ground = map_ && scope_ == h.parent(h.parent(e));
  if (is_moved_alone) s.place = ground_->below(map_->at(s.was)).value_or(s.place);
  s.pose.position = ground_->at(s.place);
  if (is_moved_alone || is_moved_with_ground)
    s.pose.turn = upright_turn(map_->with_jacobian(s.was).jacobian, s.pose.turn);
  return s;
}

void LandscapeGrammar::solve(const RuleCall& call, int landscape) {
  if (solved_ == landscape) return;
  solved_ = landscape;
  const Hierarchy& h = call.now();
  const int terrain = terrain_of(h, landscape);
  standings_.clear();
  standing_of_.clear();
  ground_.emplace(ground_of(h, landscape));
  ground_before_.emplace(call.points_before(terrain), h.type(terrain).triangles);
  for (const int holder : h.children(landscape))
    for (const int e : h.children(holder)) {
      const auto what = what_stands(h, e);
      if (!what) continue;
      standing_of_[e] = static_cast<int>(standings_.size());
      standings_.push_back(carried(call, terrain, e, *what));
    }
  require_clear(call);
  place_houses(call);
  found_houses(call);
  size_pines(call);
  for (const int holder : h.children(landscape))
    if (has_type(h, holder, "path") && h.present(holder)) lay_path(call, holder);
}

SpacedCircle circle_of(const Standing& s) {
  return {s.pose.position.head<2>(), s.what == Stands::house ? s.radius : s.size * s.radius,
          s.is_fixed};
}

/// Other houses, and pines that do not yield.
bool blocks_houses(const Standing& s) {
  return s.what == Stands::house || (s.what == Stands::pine && s.is_fixed);
}

/// An edit may not bring something onto what another edit holds.
void LandscapeGrammar::require_clear(const RuleCall& call) const {
  const auto found = standing_of_.find(call.edited());
  if (found == standing_of_.end()) return;
  const Standing& edited = standings_[found->second];
  if (edited.what == Stands::stone || !edited.is_present) return;
  for (const Standing& s : standings_) {
    if (&s == &edited || !s.is_fixed || !s.is_present || s.what == Stands::stone) continue;
    if (circles_meet(circle_of(s), circle_of(edited)))
      throw Error("the edit brings it too near to '" + call.now().label(s.element) +
                      "', which an edit holds",
                  "element '" + call.now().label(edited.element) + "'",
                  "a place and a size that are clear of it");
  }
}

/// To where it was pushed, if there is ground.
void LandscapeGrammar::drop_house(Standing& house, const SpacedCircle& circle) const {
  const Vector3d& x = house.pose.position;
  if (circle.centre == x.head<2>()) return;
  const auto place = ground_->below({circle.centre.x(), circle.centre.y(), x.z()});
  house.is_present = place.has_value();
  if (!place) return;
  house.place = *place;
  house.pose.position = ground_->at(*place);
}

/// Whether nothing that another house keeps away from is too near.
bool LandscapeGrammar::is_free(const Standing& house, bool earlier_only) const {
  return std::none_of(standings_.begin(), standings_.end(), [&](const Standing& other) {
    if (!blocks_houses(other) || !other.is_present || &other == &house) return false;
    if (earlier_only && !other.is_fixed && &other > &house) return false;
    return circles_meet(circle_of(house), circle_of(other));
  });
}

/// Houses that meet are pushed apart; where there is no room for all, later ones go. One that had
/// gone comes back where its place is clear.
void LandscapeGrammar::place_houses(const RuleCall& call) {
  std::vector<SpacedCircle> circles;
  std::vector<Standing*> bodies;
  bool is_new = false;
  for (Standing& s : standings_) {
    if (!s.is_present || !blocks_houses(s)) continue;
    is_new = is_new || s.element == call.edited() || s.pose.position != s.was;
    circles.push_back(circle_of(s));
    bodies.push_back(&s);
  }
  if (!is_new) return;
  const bool are_clear = push_circles_apart(circles);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i]->what == Stands::house && !bodies[i]->is_fixed)
      drop_house(*bodies[i], circles[i]);
  for (Standing& s : standings_) {
    if (s.what != Stands::house || s.is_fixed) continue;
    if (!call.now().present(s.element))
      s.is_present = is_free(s, false);
    else if (!are_clear && s.is_present)
      s.is_present = is_free(s, true);
  }
}

/// The depth that is needed, where that is another than before.
void LandscapeGrammar::found_houses(const RuleCall& call) {
  const Hierarchy& h = call.now();
  for (Standing& s : standings_) {
    if (s.what != Stands::house || s.is_fixed) continue;
    const Pose before{s.was, call.pose_before(s.element).turn};
    const double needed = plinth_depth(*ground_, h, s.element, s.pose);
    if (needed != plinth_depth(*ground_before_, h, s.element, before)) s.plinth = needed;
  }
}

/// With houses as elements of full size that come before.
void LandscapeGrammar::size_pines(const RuleCall& call) {
  SpacedSet set;
  std::vector<Standing*> pines;
  Eigen::AlignedBox3d changed;
  double largest = 0;
  const Hierarchy& h = call.now();
  for (const Stands what : {Stands::house, Stands::pine})
    for (Standing& s : standings_) {
      if (s.what != what) continue;
      const bool is_new = s.is_present != h.present(s.element);
      const bool moved = s.element == call.edited() || is_new || s.pose.position != s.was;
      if (moved) {
        changed.extend(s.was);
        changed.extend(s.pose.position);
      }
      largest = std::max(largest, s.radius);
      if (what == Stands::house && !s.is_present) continue;
      SpacedKind kind = SpacedKind::fixed;
      if (what == Stands::pine && !s.is_fixed)
        kind = h.parameter(s.element, PineParameter::kCandidate) != 0 ? SpacedKind::candidate
                                                                      : SpacedKind::element;
      set.add(s.pose.position, s.radius, s.size, kind,
              moved ? SpacedState::moved : SpacedState::kept);
      pines.push_back(&s);
    }
  if (changed.isEmpty()) return;
  const double reach = spacing_reach(largest);
  const Eigen::AlignedBox3d near((changed.min().array() - reach).matrix(),
                                 (changed.max().array() + reach).matrix());
  for (int k = 0; k < set.count(); ++k)
    if (set.state[k] == SpacedState::kept && near.contains(set.x[k]))
      set.state[k] = SpacedState::asked;
  const std::vector<double> size = spaced_sizes(set);
  for (int k = 0; k < set.count(); ++k) {
    if (set.kind[k] == SpacedKind::fixed) continue;
    pines[k]->size = size[k];
    pines[k]->is_present = size[k] > 0;
  }
}

void LandscapeGrammar::lay_path(const RuleCall& call, int path) {
  const Hierarchy& h = call.now();
  const double pitch = h.parameter(path, kPathPitch);
  std::vector<PathStone> stones;
  std::vector<Standing*> standings;
  int edited = -1;
  bool changed = pitch != call.parameter_before(path, kPathPitch);
  for (const int e : h.children(path)) {
    const auto found = standing_of_.find(e);
    if (found == standing_of_.end()) continue;
    Standing& s = standings_[found->second];
    if (e == call.edited()) edited = static_cast<int>(stones.size());
    changed = changed || e == call.edited() || s.pose.position != s.was;
    standings.push_back(&s);
    stones.push_back({s.along, s.pose.position, s.size,
                      h.parameter(e, StoneParameter::kCandidate) != 0, s.is_fixed});
  }
  if (!changed || stones.empty()) return;
  const auto on_ground = [&](const Vector3d& x) -> std::optional<Vector3d> {
    const auto place = ground_->below(x);
    if (!place) return std::nullopt;
    return ground_->at(*place);
  };
  if (edited >= 0) {
    const Vector3d shift = standings[edited]->pose.position - standings[edited]->was;
    bend_path(stones, edited, shift, pitch, on_ground);
  }
  space_path(stones, pitch, on_ground);
  // An edit may not break the path, where other edits hold it.
  const auto broken = edited >= 0 ? broken_step(stones, pitch) : std::nullopt;
  if (broken)
    throw Error(
        "the edit makes a step of the path " + std::to_string(*broken) + " m long",
        "element '" + h.label(call.edited()) + "'",
        std::to_string(kLeastStep * pitch) + " to " + std::to_string(kLargestStep * pitch) + " m");
  for (std::size_t i = 0; i < stones.size(); ++i) {
    Standing& s = *standings[i];
    s.size = stones[i].size;
    s.is_present = s.size > 0;
    s.along = stones[i].along;
    if (s.is_fixed || stones[i].x == s.pose.position) continue;
    s.place = ground_->below(stones[i].x).value_or(s.place);
    s.pose.position = ground_->at(s.place);
  }
}

// ---- Writing -----------------------------------------------------------------------------------

bool place_differs(const Hierarchy& h, const Standing& s) {
  const int p = place_parameter(s.what);
  return s.place.triangle != h.parameter(s.element, p) ||
         s.place.b0 != h.parameter(s.element, p + 1) || s.place.b1 != h.parameter(s.element, p + 2);
}

bool standing_differs(const Hierarchy& h, const Standing& s) {
  if (s.pose.position != h.position(s.element) ||
      s.pose.turn.coeffs() != h.turn(s.element).coeffs())
    return true;
  if (s.what == Stands::house) return s.plinth != h.parameter(s.element, HouseParameter::kPlinth);
  return s.size != h.parameter(s.element, PineParameter::kSize);
}

/// What holds others asks those of them that change.
void LandscapeGrammar::holder_down(RuleCall& call) {
  begin(call);
  const Hierarchy& h = call.now();
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int holder = call.elements()[i];
    if (call.origin() != Origin::parent) {
      scope_ = holder;
      map_ = landscape_map(call, i);
    }
    if (call.kind() == DeltaKind::set_parameter || call.kind() == DeltaKind::extrude) {
      const int number = call.delta().parameter;
      const double by = call.kind() == DeltaKind::extrude ? h.parameter(holder, number) : 0;
      call.set_parameter(holder, number, by + call.delta().value);
    }
    solve(call, h.parent(holder));
    std::vector<int> asked, going;
    for (const int e : h.children(holder)) {
      const auto found = standing_of_.find(e);
      if (found == standing_of_.end() || e == call.edited()) continue;
      const Standing& s = standings_[found->second];
      if (h.present(e)) {
        (s.is_present ? asked : going).push_back(e);
      } else if (s.is_present || place_differs(h, s)) {
        // What is not there goes along too, as nobody can ask it.
        call.restore(e);
        write(call, s);
        if (!s.is_present) call.remove(e);
      }
    }
    std::erase_if(asked,
                  [&](int e) { return !standing_differs(h, standings_[standing_of_.at(e)]); });
    if (!asked.empty()) call.down(holder, std::move(asked), map_ ? call.delta() : Delta{});
    if (!going.empty()) call.down(holder, std::move(going), Delta::children(-1));
  }
}

void LandscapeGrammar::write(RuleCall& call, const Standing& s) const {
  const auto set = [&](int number, double value) {
    if (call.now().parameter(s.element, number) != value)
      call.set_parameter(s.element, number, value);
  };
  call.set_pose(s.element, s.pose);
  if (call.follows()) return;
  const int place = place_parameter(s.what);
  set(place, s.place.triangle);
  set(place + 1, s.place.b0);
  set(place + 2, s.place.b1);
  if (s.what == Stands::house)
    set(HouseParameter::kPlinth, s.plinth);
  else
    set(PineParameter::kSize, s.size);
  if (s.what == Stands::stone) set(StoneParameter::kAlong, s.along);
}

void LandscapeGrammar::standing_down(RuleCall& call) {
  for (const int e : call.elements()) write(call, standings_[standing_of_.at(e)]);
}

void LandscapeGrammar::standing_goes(RuleCall& call) {
  for (const int e : call.elements()) {
    write(call, standings_[standing_of_.at(e)]);
    call.remove(e);
  }
}

// ---- Edits -------------------------------------------------------------------------------------

void LandscapeGrammar::move_standing(RuleCall& call, int e, Stands what) const {
  const Hierarchy& h = call.now();
  const Pose before = h.pose(e);
  MappedPoint to{call.transform(0) * before.position, call.transform(0).linear()};
  if (call.kind() == DeltaKind::free) to = call.delta().map->with_jacobian(before.position);
  const Ground ground = ground_of(h, h.parent(h.parent(e)));
  const auto place = ground.below(to.position);
  if (!place)
    throw Error("the edit moves it off the ground", "element '" + h.label(e) + "'",
                "a place above or below the terrain");
  const int p = place_parameter(what);
  call.set_pose(e, {ground.at(*place), upright_turn(to.jacobian, before.turn)});
  call.set_parameter(e, p, place->triangle);
  call.set_parameter(e, p + 1, place->b0);
  call.set_parameter(e, p + 2, place->b1);
}

void LandscapeGrammar::edit_parameter(RuleCall& call, int e, Stands what) const {
  const Hierarchy& h = call.now();
  const int number = call.delta().parameter;
  const int editable = what == Stands::stone ? 1 : 3;
  if (number < 0 || number >= editable)
    throw Error("the parameter is not to be edited", "element '" + h.label(e) + "'",
                what == Stands::house  ? "width, depth, height"
                : what == Stands::pine ? "size, radius, height"
                                       : "size");
  const double by = call.kind() == DeltaKind::extrude ? h.parameter(e, number) : 0;
  call.set_parameter(e, number, by + call.delta().value);
}

/// An edit of one of those that stand is done as it is asked for, on the ground; then what holds
/// it makes room. As a tag will hold its plinth, that gets a reserve for ground that becomes
/// steeper, by 45 degrees.
void LandscapeGrammar::standing_edited(RuleCall& call) {
  const Hierarchy& h = call.now();
  const int e = call.elements()[0];
  const Stands what = *what_stands(h, e);
  switch (call.kind()) {
    case DeltaKind::free:
    case DeltaKind::rigid:
    case DeltaKind::affine:
    case DeltaKind::translate:
      move_standing(call, e, what);
      break;
    case DeltaKind::set_parameter:
    case DeltaKind::extrude:
      edit_parameter(call, e, what);
      break;
    default:
      return;
  }
  if (what == Stands::house) {
    const Ground ground = ground_of(h, h.parent(h.parent(e)));
    call.set_parameter(e, HouseParameter::kPlinth,
                       plinth_depth(ground, h, e, h.pose(e)) + house_radius(h, e));
  }
  if (call.phase() == Phase::up) call.up(Delta{});
}

/// Whether a house is too near to a pine.
bool meets_house(const Hierarchy& h, int pine) {
  const double keeps =
      h.parameter(pine, PineParameter::kSize) * h.parameter(pine, PineParameter::kRadius);
  const SpacedCircle circle{h.position(pine).head<2>(), keeps, true};
  const int landscape = h.parent(h.parent(pine));
  for (const int holder : h.children(landscape))
    for (const int e : h.children(holder)) {
      if (what_stands(h, e) != Stands::house || !h.present(e)) continue;
      if (circles_meet(circle, {h.position(e).head<2>(), house_radius(h, e), false})) return true;
    }
  return false;
}

/// The terrain takes along all that stands on it. Houses and pines are in each other's way, so that
/// the village, and the grove where an edited pine meets a house, pass on to the landscape.
void LandscapeGrammar::passed_up(RuleCall& call) {
  const Hierarchy& h = call.now();
  const int e = call.elements()[0];
  const bool is_grove = has_type(h, e, "grove");
  const bool meets = is_grove && call.origin() == Origin::child && meets_house(h, call.sender());
  if (has_type(h, e, "path") || (is_grove && !meets))
    call.absorb(call.delta());
  else
    call.up(call.delta());
}

}  // namespace

RuleSet landscape_rules() {
  RuleSet rules;
  const auto grammar = std::make_shared<LandscapeGrammar>();
  const auto add = [&](const std::string& name, const Guard& guard,
                       void (LandscapeGrammar::*apply)(RuleCall&)) {
    Rule rule;
    rule.name = name;
    rule.guard = guard;
    rule.apply = [grammar, apply](RuleCall& call) { ((*grammar).*apply)(call); };
    rules.add(std::move(rule));
  };
  Guard guard;
  guard.phase = Phase::down;
  guard.type = "landscape";
  add("a landscape asks its terrain first", guard, &LandscapeGrammar::landscape_down);
  guard.type = "terrain";
  add("a terrain is deformed", guard, &LandscapeGrammar::terrain_down);
  for (const char* holder : {"grove", "village", "path"}) {
    guard.type = holder;
    guard.phase = Phase::down;
    add(std::string(holder) + " makes room", guard, &LandscapeGrammar::holder_down);
    guard.phase = Phase::up;
    add(std::string(holder) + " bounds an edit or passes it on", guard,
        &LandscapeGrammar::passed_up);
  }
  guard.type = "terrain";
  add("a terrain takes all along", guard, &LandscapeGrammar::passed_up);
  for (const char* standing : {"pine", "house", "stone"}) {
    Guard one;
    one.type = standing;
    one.origin = Origin::user;
    add(std::string(standing) + " is edited", one, &LandscapeGrammar::standing_edited);
    one.phase = Phase::down;
    one.origin = Origin::parent;
    one.kind = DeltaKind::children;
    add(std::string(standing) + " goes", one, &LandscapeGrammar::standing_goes);
    one.kind.reset();
    add(std::string(standing) + " takes its place", one, &LandscapeGrammar::standing_down);
  }
  rules.bound_locality("landscape");
  return rules;
}

}  // namespace geoprior::grammar
