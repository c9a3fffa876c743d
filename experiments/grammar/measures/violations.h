#pragma once

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <vector>

#include "experiments/grammar/measures/recorded_state.h"

namespace geoprior::grammar {

/// Constraints of one kind: how far the worst is broken, how many are, and of which elements.
///
/// A constraint that ties an element to what it belongs to (a branch to its parent, a window to its
/// wall, what stands to its ground) is the element's own; one of two that are alike (branches that
/// cross, neighbours too close, storeys on each other) is of both.
struct Tally {
  /// A constraint holds up to so much of its unit: round-off of coordinates of some tens of metres.
  static constexpr double kHolds = 1e-9;

  std::optional<double> worst;  ///< absent where the object has no such constraint
  int broken = 0;
  std::vector<int> elements;  ///< numbers of those of the broken ones, once for each

  /// A number that is none breaks the constraint.
  /// @param of  numbers of the elements whose constraint it is
  void add(double violation, std::initializer_list<int> of) {
    if (!worst || !(violation <= *worst)) worst = violation;
    if (violation <= kHolds) return;
    ++broken;
    elements.insert(elements.end(), of);
  }
};

/// Constraints of buildings, from the corners of their storeys, walls, windows and doors.
struct BuildingViolations {
  Tally wall_angle;     ///< deg: adjacent walls of a storey from 90, walls' ends from the vertical
  Tally wall_gap;       ///< m: a wall's corner from its neighbour's, and from its storey's
  Tally storey_height;  ///< m: of each edge, out of 2.6 … 4.5
  Tally
      storey_gap;  ///< m: heights of a storey's bottom corners, and the eaves', from what is below
  Tally overhang;  ///< m: distance in plan of the middles of sides of two storeys, over 0.6
  Tally window_pitch;    ///< m: distance along the wall of neighbouring centres, out of 1.2 … 2.4
  Tally window_outside;  ///< m: a corner of a window or door out of its wall's rectangle
  Tally door_gap;        ///< m: height of a door's lowest corner from the bottom of its building
};
BuildingViolations building_violations(const RecordedState& state);

/// Constraints of trees, from the ends of their branches.
struct TreeViolations {
  Tally length;      ///< m: out of 0.5 … 1.5 of the mean of the level at rest
  Tally attachment;  ///< m: base from the place on the parent's axis where it hangs
  Tally crossings;   ///< each 1: two branches cross that do not meet in a node
};
TreeViolations tree_violations(const RecordedState& state, const RecordedState& rest);

/// Constraints of what is scattered, in sets and on a terrain.
struct ScatterViolations {
  std::optional<double> spacing;  ///< least distance over the sum of the radii times sizes
  Tally too_close;                ///< 1 - that, of each pair that is too close
  Tally ground_gap;               ///< m: feet and stones from the ground, plinths over it
  Tally upright;                  ///< deg: pines, conifers and houses from the vertical
  Tally path_pitch;               ///< m: distance of consecutive stones, out of 0.6 … 1.4 pitches
};
ScatterViolations scatter_violations(const RecordedState& state);

/// Constraints of the parts of the imported engine (rules/machine.lua), from the corners of their
/// boxes; kinds of parts by patterns of names.
struct MachineViolations {
  Tally shape;  ///< m: a corner from where the box's edges put it; of all but the body, an edge
                ///< from its length at rest
  Tally turn;   ///< deg: an edge of body, piston or lifter from its direction at rest
  Tally slide;  ///< m: shift of a piston across its axis x, of a lifter across y, of a rod along y
  Tally links;  ///< m: distance of two links of one spring from what it was
};
/// Nothing where `imported` is false: names mean nothing then.
MachineViolations machine_violations(const RecordedState& state, const RecordedState& rest,
                                     bool imported);

}  // namespace geoprior::grammar
