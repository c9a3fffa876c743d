#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "experiments/grammar/measures/violations.h"
#include "metrics/arrangement/angles.h"
#include "metrics/arrangement/lengths.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

constexpr double kStoreyLow = 2.6, kStoreyHigh = 4.5;  // m
constexpr double kOverhangLimit = 0.6;                 // m
constexpr double kPitchLow = 1.2, kPitchHigh = 2.4;    // m

using ElementGroup = std::vector<const RecordedElement*>;

/// Elements by the number of their parent.
std::map<int, ElementGroup> groups_by_parent(const RecordedState& state,
                                             std::initializer_list<const char*> types) {
  std::map<int, ElementGroup> out;
  for (const char* type : types)
    for (const RecordedElement* e : state.of_type(type)) out[e->parent].push_back(e);
  return out;
}

double mean_corner_height(std::span<const Vector3d> points) {
  double sum = 0;
  for (const Vector3d& x : points) sum += x.z();
  return sum / static_cast<double>(points.size());
}

/// Corners of a wall: bottom start, bottom end, top end, top start.
struct WallCorners {
  Vector3d start, end, top_end, top_start;
  explicit WallCorners(const RecordedElement& wall)
      : start(wall.keys.at(0)),
        end(wall.keys.at(1)),
        top_end(wall.keys.at(2)),
        top_start(wall.keys.at(3)) {}
};

/// Gap of two walls that meet at one upright edge, whichever way each of them runs (m).
double corner_gap(const WallCorners& a, const WallCorners& b) {
  using Edge = std::pair<Vector3d, Vector3d>;
  const std::array<Edge, 2> of_a{Edge{a.start, a.top_start}, Edge{a.end, a.top_end}};
  const std::array<Edge, 2> of_b{Edge{b.start, b.top_start}, Edge{b.end, b.top_end}};
  double out = std::numeric_limits<double>::infinity();
  for (const Edge& p : of_a)
    for (const Edge& q : of_b)
      out = std::min(out, std::max((p.first - q.first).norm(), (p.second - q.second).norm()));
  return out;
}

void measure_walls(const RecordedState& state, int storey, ElementGroup walls,
                   BuildingViolations& out) {
  const auto side = [&](const RecordedElement* wall) { return state.parameter(*wall, "side"); };
  std::stable_sort(walls.begin(), walls.end(),
                   [&](const auto* a, const auto* b) { return side(a) < side(b); });
  const RecordedElement* box = state.find(storey);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const WallCorners wall(*walls[i]);
    const int number = walls[i]->number;
    out.wall_angle.add(tilt(wall.start, wall.top_start), {number});
    out.wall_angle.add(tilt(wall.end, wall.top_end), {number});
    if (box != nullptr)
      for (const Vector3d& corner : walls[i]->keys) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vector3d& x : box->keys) nearest = std::min(nearest, (x - corner).norm());
        out.wall_gap.add(nearest, {number});
      }
    const RecordedElement* next = walls[(i + 1) % walls.size()];
    // Sides are numbered 0 to 3 around the storey.
    if (std::fmod(side(walls[i]) + 1, 4) != side(next)) continue;
    const WallCorners other(*next);
    out.wall_angle.add(right_angle_error(wall.end - wall.start, other.end - other.start),
                       {number, next->number});
    out.wall_angle.add(
        right_angle_error(wall.top_end - wall.top_start, other.top_end - other.top_start),
        {number, next->number});
    out.wall_gap.add(corner_gap(wall, other), {number, next->number});
  }
}

/// Middle in plan of a side of a storey, of its bottom corners (0) or its top ones (4).
Eigen::Vector2d side_middle(const RecordedElement& storey, int side, int level) {
  const Vector3d sum = storey.keys.at(level + side) + storey.keys.at(level + (side + 1) % 4);
  return 0.5 * sum.head<2>();
}

/// Storeys of a building from the ground up.
ElementGroup from_the_ground(ElementGroup storeys) {
  std::stable_sort(storeys.begin(), storeys.end(), [](const auto* a, const auto* b) {
    return mean_corner_height({a->keys.data(), 4}) < mean_corner_height({b->keys.data(), 4});
  });
  return storeys;
}

void measure_roof(const RecordedElement& roof, const RecordedElement& storey,
                  BuildingViolations& out) {
  const double below = mean_corner_height({&storey.keys[4], 4});
  for (int c = 0; c < 4; ++c)
    out.storey_gap.add(std::abs(roof.keys.at(c).z() - below), {roof.number, storey.number});
}

void measure_storeys(const RecordedState& state, int building, const ElementGroup& storeys,
                     BuildingViolations& out) {
  const RecordedElement* ground = state.find(building);
  for (std::size_t i = 0; i < storeys.size(); ++i) {
    const RecordedElement& storey = *storeys[i];
    for (int c = 0; c < 4; ++c)
      out.storey_height.add(
          out_of_range(storey.keys[c + 4].z() - storey.keys[c].z(), kStoreyLow, kStoreyHigh),
          {storey.number});
    if (i == 0 && (ground == nullptr || ground->keys.empty())) continue;
    const double below =
        i == 0 ? ground->keys[0].z() : mean_corner_height({&storeys[i - 1]->keys[4], 4});
    const int under = i == 0 ? storey.number : storeys[i - 1]->number;
    for (int c = 0; c < 4; ++c)
      out.storey_gap.add(std::abs(storey.keys[c].z() - below), {storey.number, under});
    if (i == 0) continue;
    for (int side = 0; side < 4; ++side) {
      const Eigen::Vector2d shift =
          side_middle(storey, side, 0) - side_middle(*storeys[i - 1], side, 4);
      out.overhang.add(out_of_range(shift.norm(), 0, kOverhangLimit), {storey.number, under});
    }
  }
}

/// Windows and doors of a wall in its rectangle: along its bottom, upwards at right angles to that.
void measure_openings(const RecordedElement& wall, const ElementGroup& openings,
                      BuildingViolations& out) {
  const WallCorners w(wall);
  const double length = (w.end - w.start).norm();
  const Vector3d along = (w.end - w.start) / length;
  const Vector3d rise = w.top_start - w.start;
  const Vector3d up = (rise - rise.dot(along) * along).normalized();
  const Vector3d across = along.cross(up);
  std::vector<Vector3d> centres;
  std::vector<double> places;
  for (const RecordedElement* opening : openings) {
    places.push_back((opening->keys.at(0) - w.start).dot(along));
    centres.emplace_back(places.back(), 0, 0);
    double outside = 0;
    for (std::size_t k = 1; k < opening->keys.size(); ++k) {
      const Vector3d x = opening->keys[k] - w.start;
      outside = std::max({outside, out_of_range(x.dot(along), 0, length),
                          out_of_range(x.dot(up), 0, rise.dot(up)), std::abs(x.dot(across))});
    }
    out.window_outside.add(outside, {opening->number});
  }
  for (const auto& [before, after, pitch] : neighbour_pitches(centres, places))
    out.window_pitch.add(out_of_range(pitch, kPitchLow, kPitchHigh),
                         {openings[before]->number, openings[after]->number});
}

/// Doors of a building, whose storeys' walls have them.
void measure_doors(const RecordedState& state, const std::map<int, double>& bottoms,
                   BuildingViolations& out) {
  for (const RecordedElement* door : state.of_type("door")) {
    const RecordedElement* wall = state.find(door->parent);
    const RecordedElement* storey = wall == nullptr ? nullptr : state.find(wall->parent);
    if (storey == nullptr || !bottoms.contains(storey->parent)) continue;
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < door->keys.size(); ++k)
      lowest = std::min(lowest, door->keys[k].z());
    out.door_gap.add(std::abs(lowest - bottoms.at(storey->parent)), {door->number});
  }
}

}  // namespace

BuildingViolations building_violations(const RecordedState& state) {
  BuildingViolations out;
  std::map<int, double> bottoms;  // of the lowest storey of each building
  for (const auto& [building, storeys] : groups_by_parent(state, {"storey"})) {
    const ElementGroup sorted = from_the_ground(storeys);
    measure_storeys(state, building, sorted, out);
    for (const RecordedElement* roof : state.of_type("roof"))
      if (roof->parent == building) measure_roof(*roof, *sorted.back(), out);
    bottoms[building] = mean_corner_height({sorted.front()->keys.data(), 4});
  }
  for (const auto& [storey, walls] : groups_by_parent(state, {"wall"}))
    measure_walls(state, storey, walls, out);
  for (const auto& [wall, openings] : groups_by_parent(state, {"window", "door"}))
    if (const RecordedElement* of_them = state.find(wall))
      measure_openings(*of_them, openings, out);
  measure_doors(state, bottoms, out);
  return out;
}

}  // namespace geoprior::grammar
