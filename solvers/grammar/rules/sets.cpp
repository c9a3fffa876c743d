// Sets on a surface, in a body, on flat ground: elements go where the map takes them, and sizes
// make the room that they need (models/grammar/objects/spacing.h).

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "models/grammar/objects/forest.h"
#include "models/grammar/objects/spacing.h"
#include "models/grammar/objects/surface_set.h"
#include "models/grammar/objects/volume_set.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// All elements of sets have size and radius first.
constexpr int kSetSize = ItemParameter::kSize, kSetRadius = ItemParameter::kRadius;
static_assert(GrainParameter::kSize == kSetSize && ConiferParameter::kSize == kSetSize);
static_assert(GrainParameter::kRadius == kSetRadius && ConiferParameter::kRadius == kSetRadius);
constexpr std::size_t kSetBlock = 8192;
/// How far from what changed sizes are found anew at first, in reaches, and by what it grows where
/// that was not far enough.
constexpr double kFirstMargin = 5, kMarginGrowth = 4;

/// What the elements of a set live in.
enum class SetSpace { surface, body, ground };

SetSpace set_space(const Hierarchy& h, int set) {
  const std::string& name = h.type(set).name;
  if (name == "surface-set") return SetSpace::surface;
  return name == "volume-set" ? SetSpace::body : SetSpace::ground;
}

int candidate_parameter(SetSpace space) {
  switch (space) {
    case SetSpace::surface:
      return ItemParameter::kCandidate;
    case SetSpace::body:
      return GrainParameter::kCandidate;
    case SetSpace::ground:
      break;
  }
  return ConiferParameter::kCandidate;
}

/// Of sets that keep no distance there is only the map.
bool keeps_spacing(const Hierarchy& h, int set) {
  return set_space(h, set) != SetSpace::ground || h.parameter(set, kForestSpacing) > 0;
}

AlignedBox3d grown_box(const AlignedBox3d& box, double by) {
  if (box.isEmpty()) return box;
  return {(box.min().array() - by).matrix(), (box.max().array() + by).matrix()};
}

TrianglePlace place_of_item(const Hierarchy& h, int item) {
  return {static_cast<int>(h.parameter(item, ItemParameter::kTriangle)),
          h.parameter(item, ItemParameter::kB0), h.parameter(item, ItemParameter::kB1)};
}

bool triangle_rests(std::span<const Vector3d> before, std::span<const Vector3d> now,
                    const Eigen::MatrixX3i& triangles, int triangle) {
  const auto corner = triangles.row(triangle);
  return std::all_of(corner.begin(), corner.end(), [&](int v) { return before[v] == now[v]; });
}

/// Numbers of the children of a type in a box, or of all, in order.
std::vector<int> set_children_in(const Hierarchy& h, int set, int type,
                                 const std::optional<AlignedBox3d>& box) {
  const std::vector<int>& children = h.children(set);
  std::vector<std::vector<int>> found(children.size() / kSetBlock + 1);
  parallel_blocks(children.size(), kSetBlock, [&](std::size_t first, std::size_t last) {
    std::vector<int>& out = found[first / kSetBlock];
    for (std::size_t i = first; i < last; ++i) {
      const int e = children[i];
      if (h.type_number(e) == type && (!box || box->contains(h.position(e)))) out.push_back(e);
    }
  });
  std::vector<int> out;
  for (const std::vector<int>& part : found) out.insert(out.end(), part.begin(), part.end());
  return out;
}

double largest_radius(const Hierarchy& h, int set, int type) {
  const std::vector<int>& children = h.children(set);
  std::vector<double> found(children.size() / kSetBlock + 1, 0);
  parallel_blocks(children.size(), kSetBlock, [&](std::size_t first, std::size_t last) {
    double& largest = found[first / kSetBlock];
    for (std::size_t i = first; i < last; ++i)
      if (h.type_number(children[i]) == type)
        largest = std::max(largest, h.parameter(children[i], kSetRadius));
  });
  return *std::max_element(found.begin(), found.end());
}

/// What the rules of sets know of the derivation that is under way.
class SetGrammar {
 public:
  void set_down(RuleCall& call);
  void set_makes_room(RuleCall& call);
  void elements_carried(RuleCall& call);
  void element_goes(RuleCall& call);
  void element_edited(RuleCall& call);

 private:
  /// What a set's elements are asked for.
  struct SetPlan {
    std::shared_ptr<const SpatialMap> map;  ///< null: they stay
    bool is_spaced = false;
    int edited = -1;
  };
  /// Elements whose sizes may change, and what is around them.
  struct Neighbourhood {
    std::vector<int> elements;
    SpacedSet spaced;
    std::vector<double> size;  ///< found
  };

  void begin(const RuleCall& call);
  void lay_out(RuleCall& call, int set, std::optional<AlignedBox3d> changed);
  void ask_all_in(RuleCall& call, int set, int type, const std::optional<AlignedBox3d>& box);
  void gather(const RuleCall& call, int set, Neighbourhood& out) const;
  void write(RuleCall& call, int set, const Neighbourhood& found);
  [[nodiscard]] SpacedKind kind_of(const Hierarchy& h, const SetPlan& plan, SetSpace space,
                                   int e) const;
  [[nodiscard]] Vector3d carried_place(const RuleCall& call, int set, int e) const;
  [[nodiscard]] Pose carried_on_surface(const RuleCall& call, int set, int e) const;
  [[nodiscard]] Pose carried_pose(const RuleCall& call, int set, int e) const;
  void move_element(RuleCall& call, int e);
  void edit_parameter(RuleCall& call, int e);

  std::uint64_t derivation_ = 0;
  std::map<int, SetPlan> plans_;  ///< of the sets that were asked
  std::vector<double> size_;      ///< by element, of those that are asked
};

void SetGrammar::begin(const RuleCall& call) {
  if (derivation_ == call.derivation()) return;
  derivation_ = call.derivation();
  plans_.clear();
}

void SetGrammar::set_down(RuleCall& call) {
  begin(call);
  for (std::size_t i = 0; i < call.elements().size(); ++i) {
    const int set = call.elements()[i];
    std::shared_ptr<const SpatialMap> map = call.delta().map;
    switch (call.kind()) {
      case DeltaKind::free:
        break;
      case DeltaKind::rigid:
      case DeltaKind::affine:
      case DeltaKind::translate:
        map = std::make_shared<AffineMap>(call.transform(i));
        break;
      case DeltaKind::set_parameter:
      case DeltaKind::extrude: {
        const int number = call.delta().parameter;
        const double by = call.kind() == DeltaKind::extrude ? call.now().parameter(set, number) : 0;
        call.set_parameter(set, number, by + call.delta().value);
        break;
      }
      default:
        continue;
    }
    SetPlan& plan = plans_[set];
    plan.map = map;
    // What follows as one body keeps its sizes.
    plan.is_spaced = keeps_spacing(call.now(), set) && !call.follows();
    if (map) {
      const Pose before = call.pose_before(set);
      const MappedPoint at = map->with_jacobian(before.position);
      const bool turns = at.jacobian != Eigen::Matrix3d::Identity();
      call.set_pose(set, {at.position, turns ? (rotation_of(at.jacobian) * before.turn).normalized()
                                             : before.turn});
      for (Vector3d& x : call.points(set)) x = map->at(x);
    }
    lay_out(call, set, map ? map->support() : std::nullopt);
  }
}

/// After an edit of one element, which is a fact.
void SetGrammar::set_makes_room(RuleCall& call) {
  begin(call);
  const Hierarchy& h = call.now();
  const int set = call.elements()[0], edited = call.edited();
  SetPlan& plan = plans_[set];
  plan.is_spaced = keeps_spacing(h, set);
  plan.edited = edited;
  if (!plan.is_spaced) return;
  const auto extent = [&](int e) { return h.parameter(e, kSetSize) * h.parameter(e, kSetRadius); };
  for (const auto& [other, tag] : h.tags()) {
    if (other == edited || h.parent(other) != set || !h.present(other) || !h.present(edited) ||
        h.type_number(other) != h.type_number(edited))
      continue;
    if ((h.position(other) - h.position(edited)).norm() < extent(other) + extent(edited))
      throw Error("the edit brings it too near to '" + h.label(other) + "', which an edit holds",
                  "element '" + h.label(edited) + "'", "a place and a size that are clear of it");
  }
  AlignedBox3d changed(call.pose_before(edited).position);
  changed.extend(h.position(edited));
  lay_out(call, set, changed);
}

// ---- Room --------------------------------------------------------------------------------------

SpacedKind SetGrammar::kind_of(const Hierarchy& h, const SetPlan& plan, SetSpace space,
                               int e) const {
  if (e == plan.edited || (h.present(e) && h.tag(e) != nullptr)) return SpacedKind::fixed;
  return h.parameter(e, candidate_parameter(space)) != 0 ? SpacedKind::candidate
                                                         : SpacedKind::element;
}

/// Places by the map, sizes as they were.
void SetGrammar::gather(const RuleCall& call, int set, Neighbourhood& out) const {
  const Hierarchy& h = call.now();
  const SetPlan& plan = plans_.at(set);
  const SetSpace space = set_space(h, set);
  const std::size_t n = out.elements.size();
  out.spaced.resize(static_cast<int>(n));
  parallel_blocks(n, kSetBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const int e = out.elements[k];
      const SpacedKind kind = kind_of(h, plan, space, e);
      const Tag* tag = kind == SpacedKind::fixed ? h.tag(e) : nullptr;
      const bool stays = e == plan.edited || (tag && tag->follow == Tag::Follow::stop);
      const Vector3d x = stays ? h.position(e) : carried_place(call, set, e);
      out.spaced.x[k] = x;
      out.spaced.radius[k] = h.parameter(e, kSetRadius);
      out.spaced.size[k] = h.present(e) ? h.parameter(e, kSetSize) : 0;
      out.spaced.kind[k] = kind;
      out.spaced.state[k] =
          e == plan.edited || x != h.position(e) ? SpacedState::moved : SpacedState::kept;
    }
  });
}

/// Whether anything is to be found, and what: elements within reach of what changed are asked;
/// what is beyond the margin is taken as it is.
/// @param changed  box of old and new places; nothing: everywhere
bool mark_set_states(SpacedSet& set, const std::optional<AlignedBox3d>& changed, double reach,
                     double margin) {
  bool any = false;
  const AlignedBox3d near = changed ? grown_box(*changed, reach) : AlignedBox3d();
  const AlignedBox3d inner = changed ? grown_box(*changed, margin) : AlignedBox3d();
  for (int k = 0; k < set.count(); ++k) {
    any = any || set.state[k] == SpacedState::moved;
    if (set.state[k] == SpacedState::moved) continue;
    if (!changed || near.contains(set.x[k]))
      set.state[k] = SpacedState::asked;
    else if (!inner.contains(set.x[k]))
      set.state[k] = SpacedState::known;
  }
  return any;
}

void SetGrammar::ask_all_in(RuleCall& call, int set, int type,
                            const std::optional<AlignedBox3d>& box) {
  std::vector<int> asked = set_children_in(call.now(), set, type, box);
  if (!asked.empty()) call.down(set, std::move(asked), call.delta());
}

/// @param changed  where the set is not what it was; nothing: everywhere
void SetGrammar::lay_out(RuleCall& call, int set, std::optional<AlignedBox3d> changed) {
  const Hierarchy& h = call.now();
  const SetSpace space = set_space(h, set);
  constexpr std::array<const char*, 3> kElements{"item", "grain", "conifer"};
  const int type = h.find_type(kElements[static_cast<int>(space)]);
  // A surface takes along what is on a triangle of which one corner moves.
  if (space == SetSpace::surface) changed.reset();
  if (!plans_.at(set).is_spaced) {
    if (plans_.at(set).map) ask_all_in(call, set, type, changed);
    return;
  }
  const std::vector<int>& children = h.children(set);
  const double largest = largest_radius(h, set, type);
  const double reach = spacing_reach(largest);
  Neighbourhood found;
  for (double margin = kFirstMargin * reach;; margin *= kMarginGrowth) {
    found.elements = set_children_in(
        h, set, type, changed ? std::optional(grown_box(*changed, reach + margin)) : std::nullopt);
    gather(call, set, found);
    SpacedSet& spaced = found.spaced;
    std::optional<AlignedBox3d> box = changed;
    if (space == SetSpace::surface) {
      box = AlignedBox3d();
      for (int k = 0; k < spaced.count(); ++k) {
        if (spaced.state[k] != SpacedState::moved) continue;
        box->extend(spaced.x[k]);
        box->extend(call.pose_before(found.elements[k]).position);
      }
      margin = std::numeric_limits<double>::infinity();
    }
    const bool resized =
        call.kind() == DeltaKind::set_parameter || call.kind() == DeltaKind::extrude;
    if (!mark_set_states(spaced, box, reach, margin) && !resized) return;
    found.size = spaced_sizes(spaced);
    if (!changed || found.elements.size() == children.size()) break;
    const AlignedBox3d inner = grown_box(*changed, margin - reach);
    bool spreads = false;
    for (int k = 0; k < spaced.count() && !spreads; ++k)
      spreads = found.size[k] != spaced.size[k] && !inner.contains(spaced.x[k]);
    if (!spreads) break;
  }
  write(call, set, found);
}

/// Asks the elements that change. Those that were not there and still are not are carried along
/// here, as nobody can ask them.
void SetGrammar::write(RuleCall& call, int set, const Neighbourhood& found) {
  const Hierarchy& h = call.now();
  const SetPlan& plan = plans_.at(set);
  if (size_.size() < static_cast<std::size_t>(h.size())) size_.resize(h.size(), 0);
  std::vector<int> asked, going;
  std::vector<std::size_t> absent;
  for (std::size_t k = 0; k < found.elements.size(); ++k) {
    const int e = found.elements[k];
    if (e == plan.edited) continue;
    const double size = found.size[k];
    const bool moved = found.spaced.state[k] == SpacedState::moved;
    size_[e] = size;
    if (!h.present(e)) {
      if (size > 0 || moved) absent.push_back(k);
    } else if (size == 0) {
      going.push_back(e);
    } else if (moved || size != found.spaced.size[k]) {
      asked.push_back(e);
    }
  }
  for (const std::size_t k : absent) {
    const int e = found.elements[k];
    // The turn of what is not there matters on a surface alone, where it is that of the normal.
    Pose pose{found.spaced.x[k], h.turn(e)};
    if (size_[e] > 0 || set_space(h, set) == SetSpace::surface) pose = carried_pose(call, set, e);
    call.restore(e);
    call.set_pose(e, pose);
    if (size_[e] > 0)
      call.set_parameter(e, kSetSize, size_[e]);
    else
      call.remove(e);
  }
  if (!asked.empty()) call.down(set, std::move(asked), plan.map ? call.delta() : Delta{});
  if (!going.empty()) call.down(set, std::move(going), Delta::set(kSetSize, 0));
}

// ---- Elements ----------------------------------------------------------------------------------

Vector3d SetGrammar::carried_place(const RuleCall& call, int set, int e) const {
  const Hierarchy& h = call.now();
  const SpatialMap* map = plans_.at(set).map.get();
  const Vector3d x = h.position(e);
  if (map == nullptr) return x;
  switch (set_space(h, set)) {
    case SetSpace::surface: {
      const auto before = call.points_before(set), now = h.points(set);
      const Eigen::MatrixX3i& triangles = h.type(set).triangles;
      const TrianglePlace place = place_of_item(h, e);
      if (triangle_rests(before, now, triangles, place.triangle)) return x;
      return on_triangle(now, triangles, place);
    }
    case SetSpace::body:
      return map->at(x);
    case SetSpace::ground:
      break;
  }
  const Vector3d to = map->at(x);
  return {to.x(), to.y(), x.z()};
}

/// With its triangle, and leaning to where its tip is asked to be: as a rigid body it follows both
/// of its key points as well as it can while its centre stays on the surface.
Pose SetGrammar::carried_on_surface(const RuleCall& call, int set, int e) const {
  const Hierarchy& h = call.now();
  const Pose pose = h.pose(e);
  const auto before = call.points_before(set), now = h.points(set);
  const Eigen::MatrixX3i& triangles = h.type(set).triangles;
  const TrianglePlace place = place_of_item(h, e);
  const Vector3d x = carried_place(call, set, e);
  if (x == pose.position && triangle_rests(before, now, triangles, place.triangle)) return pose;
  const Eigen::Quaterniond turn = triangle_turn(before, now, triangles, place.triangle) * pose.turn;
  const double size = h.present(e) ? h.parameter(e, kSetSize) : 1;
  const Vector3d tip(0, 0, kItemHeight * size * h.parameter(e, kSetRadius));
  const Vector3d along = plans_.at(set).map->at(pose * tip) - x;
  return {x, (Eigen::Quaterniond::FromTwoVectors(turn * tip, along) * turn).normalized()};
}

Pose SetGrammar::carried_pose(const RuleCall& call, int set, int e) const {
  const Hierarchy& h = call.now();
  const SpatialMap* map = plans_.at(set).map.get();
  const Pose pose = h.pose(e);
  if (map == nullptr) return pose;
  const SetSpace space = set_space(h, set);
  if (space == SetSpace::surface) return carried_on_surface(call, set, e);
  const MappedPoint at = map->with_jacobian(pose.position);
  if (space == SetSpace::ground)
    return {{at.position.x(), at.position.y(), pose.position.z()},
            upright_turn(at.jacobian, pose.turn)};
  if (at.jacobian == Eigen::Matrix3d::Identity()) return {at.position, pose.turn};
  return {at.position, (rotation_of(at.jacobian) * pose.turn).normalized()};
}

void SetGrammar::elements_carried(RuleCall& call) {
  const int set = call.sender();
  const SetPlan& plan = plans_.at(set);
  const bool takes_size = plan.is_spaced && !call.follows();
  for (const int e : call.elements()) {
    if (plan.map) call.set_pose(e, carried_pose(call, set, e));
    if (takes_size && size_[e] != call.now().parameter(e, kSetSize))
      call.set_parameter(e, kSetSize, size_[e]);
  }
}

void SetGrammar::element_goes(RuleCall& call) {
  for (const int e : call.elements()) {
    call.set_pose(e, carried_pose(call, call.sender(), e));
    call.set_parameter(e, kSetSize, 0);
    call.remove(e);
  }
}

// ---- Edits -------------------------------------------------------------------------------------

/// To where it is asked to be, as far as it stays on its surface, or on the ground.
void SetGrammar::move_element(RuleCall& call, int e) {
  const Hierarchy& h = call.now();
  const int set = h.parent(e);
  const Pose before = h.pose(e);
  MappedPoint at{call.transform(0) * before.position, call.transform(0).linear()};
  if (call.kind() == DeltaKind::free) at = call.delta().map->with_jacobian(before.position);
  const bool turns = at.jacobian != Eigen::Matrix3d::Identity();
  Eigen::Quaterniond turn =
      turns ? (rotation_of(at.jacobian) * before.turn).normalized() : before.turn;
  switch (set_space(h, set)) {
    case SetSpace::body:
      call.set_pose(e, {at.position, turn});
      return;
    case SetSpace::ground:
      call.set_pose(e, {{at.position.x(), at.position.y(), before.position.z()},
                        upright_turn(at.jacobian, before.turn)});
      return;
    case SetSpace::surface:
      break;
  }
  const auto points = h.points(set);
  const Eigen::MatrixX3i& triangles = h.type(set).triangles;
  const auto normal = [&](int t) -> Vector3d {
    const auto corner = triangles.row(t);
    return (points[corner[1]] - points[corner[0]]).cross(points[corner[2]] - points[corner[0]]);
  };
  const Vector3d axis = before.turn * Vector3d::UnitZ();
  turn = Eigen::Quaterniond::FromTwoVectors(turn * Vector3d::UnitZ(), axis) * turn;
  const TrianglePlace was = place_of_item(h, e);
  const TrianglePlace place =
      at.position == before.position ? was : nearest_place(points, triangles, at.position);
  turn = Eigen::Quaterniond::FromTwoVectors(normal(was.triangle), normal(place.triangle)) * turn;
  call.set_pose(e, {on_triangle(points, triangles, place), turn.normalized()});
  call.set_parameter(e, ItemParameter::kTriangle, place.triangle);
  call.set_parameter(e, ItemParameter::kB0, place.b0);
  call.set_parameter(e, ItemParameter::kB1, place.b1);
}

void SetGrammar::edit_parameter(RuleCall& call, int e) {
  const Hierarchy& h = call.now();
  const int number = call.delta().parameter;
  const bool is_conifer = set_space(h, h.parent(e)) == SetSpace::ground;
  if (number != kSetSize && number != kSetRadius &&
      !(is_conifer && number == ConiferParameter::kHeight))
    throw Error("the parameter is not to be edited", "element '" + h.label(e) + "'",
                is_conifer ? "size, radius, height" : "size, radius");
  const double by = call.kind() == DeltaKind::extrude ? h.parameter(e, number) : 0;
  call.set_parameter(e, number, by + call.delta().value);
}

/// An edit of one element is done as it is asked for; then its set makes room.
void SetGrammar::element_edited(RuleCall& call) {
  const int e = call.elements()[0];
  switch (call.kind()) {
    case DeltaKind::free:
    case DeltaKind::rigid:
    case DeltaKind::affine:
    case DeltaKind::translate:
      move_element(call, e);
      break;
    case DeltaKind::set_parameter:
    case DeltaKind::extrude:
      edit_parameter(call, e);
      break;
    default:
      return;
  }
  if (call.phase() == Phase::up) call.up(Delta{});
}

}  // namespace

RuleSet set_rules() {
  RuleSet rules;
  const auto grammar = std::make_shared<SetGrammar>();
  const auto add = [&](const std::string& name, const Guard& guard,
                       void (SetGrammar::*apply)(RuleCall&), bool parallel = false) {
    Rule rule;
    rule.name = name;
    rule.guard = guard;
    rule.apply = [grammar, apply](RuleCall& call) { ((*grammar).*apply)(call); };
    rule.parallel = parallel;
    rules.add(std::move(rule));
  };
  constexpr std::array<std::array<const char*, 2>, 3> kSets{
      {{"surface-set", "item"}, {"volume-set", "grain"}, {"forest", "conifer"}}};
  for (const auto& [set, element] : kSets) {
    const std::string one = element, all = one + "s";
    Guard guard;
    guard.type = element;
    guard.origin = Origin::user;
    add(one + " is edited", guard, &SetGrammar::element_edited);
    guard.phase = Phase::down;
    guard.origin = Origin::parent;
    guard.follows = false;
    guard.kind = DeltaKind::set_parameter;
    add(one + " shrinks to nothing", guard, &SetGrammar::element_goes);
    guard.kind.reset();
    add(all + " take their places", guard, &SetGrammar::elements_carried, true);
    guard.follows = true;
    add(one + " with a tag is carried along", guard, &SetGrammar::elements_carried, true);
    Guard whole;
    whole.type = set;
    whole.phase = Phase::down;
    whole.origin = Origin::child;
    add(std::string(set) + " makes room", whole, &SetGrammar::set_makes_room);
    whole.origin.reset();
    add(std::string(set) + " is deformed", whole, &SetGrammar::set_down);
    rules.bound_locality(set);
  }
  return rules;
}

}  // namespace geoprior::grammar
