#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/objects/building_layout.h"
#include "solvers/grammar/engine/rule.h"
#include "solvers/grammar/rules/building_stack.h"

namespace geoprior::grammar {

// What the storeys, the roof and the openings of a building become, under a map or by an edit of
// one of them. The building is read here; to write it is for the rules (building.cpp).
//
// What it cannot do: where what is held leaves the storeys no room, they follow the ground only.

/// Where a roof lies, and how large it is (m).
struct RoofPlace {
  Pose pose;
  double width = 0, depth = 0, rise = 0;
};

/// What the rules prepare for the elements below, in one derivation; maps are by element.
struct BuildingPlan {
  std::uint64_t derivation = 0;
  std::map<int, StoreyBox> storeys = {};
  std::map<int, RoofPlace> roofs = {};
  std::map<int, Opening> openings = {};
  std::map<int, int> pattern = {};  ///< of a new storey: whose openings it repeats
  std::optional<std::pair<int, StoreyBox>> wanted_storey = {};  ///< by an edit
  std::optional<std::pair<int, Opening>> wanted_opening = {};
};

/// The map that a deformation is for an element of the call; null of a kind that is none.
/// @param i  of the elements of the call
std::shared_ptr<const SpatialMap> building_map(const RuleCall& call, std::size_t i);

/// A storey and an opening as they were.
StoreyBox box_before(const RuleCall& call, int storey);
Opening opening_before(const RuleCall& call, int element);

/// What a map asks of a storey: of its corners, as often as its own key points and its walls' name
/// them, and of the centres of its openings. Without a map: to stay.
/// @param map  may be null
StoreyWish read_wish(const RuleCall& call, int storey, const SpatialMap* map);

/// A building's storeys from the ground up, -1: a new one, what is asked of them, and the boxes
/// that they are to have.
struct StoreyStack {
  std::vector<int> storeys;
  std::vector<StoreyWish> wishes;
  std::vector<StoreyBox> boxes;
  bool stopped = false;  ///< a tag keeps part of it in its place
};

/// The storeys under a map of the building: how many there are follows from its height.
/// @return  absent, when there is no storey
/// @throws Error  when there would be more than 400
std::optional<StoreyStack> stack_by_map(const RuleCall& call, int building, const SpatialMap& map);

/// A storey gets a box, as far as what is held lets it; the others move just enough.
/// @return  absent, when the storey is not there, or what is held leaves no room for any of it
std::optional<StoreyStack> stack_by_edit(const RuleCall& call, int building, int storey,
                                         const StoreyBox& wanted);

/// The box of a storey that nobody planned for: as if it stood alone.
/// @param i  of the elements of the call
StoreyBox lone_box(const RuleCall& call, std::size_t i);

/// Plans where roofs lie on the top storey; their rise follows the apex.
/// @param stack  new storeys have their elements by now
/// @param map    may be null
/// @return       the roofs that change
std::vector<int> plan_roofs(const RuleCall& call, BuildingPlan& plan, int building,
                            const StoreyStack& stack, const SpatialMap* map);

/// A wall's openings from its start: what was there before, and what is to be there.
struct WallRow {
  std::vector<int> elements;      ///< of `openings`; -1: a new one, as on the storey below
  std::vector<Opening> openings;  ///< as they were, or as an edit wants them
  double length = 1, height = 1;  ///< of the wall that they were on (m)
  std::vector<LaidOpening> laid;  ///< as they are to be
};

/// The openings of a wall whose length and height are set by now. A new storey repeats those of
/// the storey below, with windows for doors.
WallRow plan_wall(const RuleCall& call, const BuildingPlan& plan, int wall);

}  // namespace geoprior::grammar
