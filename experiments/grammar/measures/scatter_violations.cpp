#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "experiments/grammar/measures/violations.h"
#include "metrics/arrangement/angles.h"
#include "metrics/arrangement/lengths.h"
#include "metrics/arrangement/spacing.h"
#include "metrics/arrangement/terrain_gap.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

/// Elements that are to keep apart from one another.
struct ApartGroup {
  std::vector<Vector3d> places;
  std::vector<double> extents;  ///< m
  std::vector<int> numbers;
};

/// What an element keeps clear around its first key point (m): its size times its radius; of a
/// house half the diagonal of its floor.
double kept_clear(const RecordedState& state, const RecordedElement& e) {
  if (state.type_name(e) == "house")
    return 0.5 * std::hypot(state.parameter(e, "width"), state.parameter(e, "depth"));
  return state.parameter(e, "size") * state.parameter(e, "radius");
}

/// Whether a forest's elements are to keep apart: its spacing is not 0.
bool keeps_apart(const RecordedState& state, const RecordedElement& conifer) {
  const RecordedElement* forest = state.find(conifer.parent);
  return forest != nullptr && state.parameter(*forest, "spacing") > 0;
}

/// Items and grains of each set, conifers of each forest; pines and houses all together.
std::vector<ApartGroup> groups_apart(const RecordedState& state) {
  std::map<int, ApartGroup> sets;
  ApartGroup landscape;
  const auto add = [&](const RecordedElement& e, ApartGroup& group) {
    group.places.push_back(e.keys.at(0));
    group.extents.push_back(kept_clear(state, e));
    group.numbers.push_back(e.number);
  };
  for (const char* type : {"item", "grain"})
    for (const RecordedElement* e : state.of_type(type)) add(*e, sets[e->parent]);
  for (const RecordedElement* e : state.of_type("conifer"))
    if (keeps_apart(state, *e)) add(*e, sets[e->parent]);
  for (const char* type : {"pine", "house"})
    for (const RecordedElement* e : state.of_type(type)) add(*e, landscape);
  std::vector<ApartGroup> out;
  for (auto& [parent, group] : sets) out.push_back(std::move(group));
  if (!landscape.places.empty()) out.push_back(std::move(landscape));
  return out;
}

void measure_spacing(const RecordedState& state, ScatterViolations& out) {
  for (const ApartGroup& group : groups_apart(state)) {
    const SpacingCheck check = check_spacing(group.places, group.extents, Tally::kHolds);
    if (!check.smallest_ratio) continue;
    out.spacing = std::min(out.spacing.value_or(*check.smallest_ratio), *check.smallest_ratio);
    out.too_close.broken += static_cast<int>(check.too_close.size());
    for (const auto& [i, j] : check.too_close)
      out.too_close.elements.insert(out.too_close.elements.end(),
                                    {group.numbers[i], group.numbers[j]});
  }
  if (out.spacing) out.too_close.worst = std::max(0.0, 1 - *out.spacing);
}

/// The terrain as the frame has it; absent where there is none.
std::optional<TerrainHeights> recorded_terrain(const RecordedState& state) {
  const auto terrains = state.of_type("terrain");
  if (terrains.empty()) return std::nullopt;
  const RecordedElement& terrain = *terrains.front();
  TriMesh mesh;
  mesh.F = state.type(terrain).triangles;
  mesh.V.resize(static_cast<int>(terrain.keys.size()), 3);
  for (std::size_t i = 0; i < terrain.keys.size(); ++i)
    mesh.V.row(static_cast<int>(i)) = terrain.keys[i];
  return TerrainHeights(std::move(mesh));
}

/// Key points of a house: the middle of its floor, the floor's corners, the top of its ridge.
void measure_house(const RecordedState& state, const RecordedElement& house,
                   const TerrainHeights& terrain, ScatterViolations& out) {
  const auto& x = house.keys;
  out.ground_gap.add(std::abs(terrain.gap(x.at(0))), {house.number});
  const double plinth = state.parameter(house, "plinth");
  for (int c = 1; c <= 4; ++c)
    out.ground_gap.add(std::max(0.0, terrain.gap(x.at(c)) - plinth), {house.number});
  // The ridge stands over the middle, and the floor is level.
  out.upright.add(tilt(x[0], x.at(5)), {house.number});
  out.upright.add(tilt(Vector3d::Zero(), (x[2] - x[1]).cross(x[4] - x[1])), {house.number});
}

void measure_path(const RecordedState& state, const RecordedElement& path,
                  const std::vector<const RecordedElement*>& stones, Tally& out) {
  constexpr double kLeast = 0.6, kMost = 1.4;  // pitches
  const double pitch = state.parameter(path, "pitch");
  std::vector<Vector3d> places;
  std::vector<double> along;
  std::vector<int> numbers;
  for (const RecordedElement* stone : stones) {
    if (state.parameter(*stone, "size") == 0) continue;
    places.push_back(stone->keys.at(0));
    along.push_back(state.parameter(*stone, "along"));
    numbers.push_back(stone->number);
  }
  for (const auto& [before, after, distance] : neighbour_pitches(places, along))
    out.add(out_of_range(distance, kLeast * pitch, kMost * pitch),
            {numbers[before], numbers[after]});
}

}  // namespace

ScatterViolations scatter_violations(const RecordedState& state) {
  ScatterViolations out;
  measure_spacing(state, out);
  for (const RecordedElement* e : state.of_type("conifer")) {
    out.ground_gap.add(std::abs(e->keys.at(0).z()), {e->number});
    out.upright.add(tilt(e->keys[0], e->keys.at(1)), {e->number});
  }
  const auto terrain = recorded_terrain(state);
  if (!terrain) return out;
  for (const RecordedElement* e : state.of_type("pine")) {
    out.ground_gap.add(std::abs(terrain->gap(e->keys.at(0))), {e->number});
    out.upright.add(tilt(e->keys[0], e->keys.at(1)), {e->number});
  }
  for (const RecordedElement* e : state.of_type("house")) measure_house(state, *e, *terrain, out);
  std::map<int, std::vector<const RecordedElement*>> paths;
  for (const RecordedElement* e : state.of_type("stone")) {
    out.ground_gap.add(std::abs(terrain->gap(e->keys.at(0))), {e->number});
    paths[e->parent].push_back(e);
  }
  for (const auto& [number, stones] : paths)
    if (const RecordedElement* path = state.find(number))
      measure_path(state, *path, stones, out.path_pitch);
  return out;
}

}  // namespace geoprior::grammar
