#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/embryo/shape/shape.h"

namespace geoprior::embryo {

/// A structure that exists on a day. A product of a division has the shape of the whole: `halves`
/// says which part of it is the product's.
struct StructureState {
  int structure = 0;
  Shape shape;
};

struct ProcessState {
  int process = 0;
  bool active = false;
  double progress = 0;  ///< from 0 to 1 in its span; 0 where it is inactive
  bool met = false;     ///< of an active interaction: its condition holds on this day
};

/// A septum that has come down into a structure: |normal.(x - point)| < thickness / 2 as far as
/// descent.(x - point) < tip.
struct Cut {
  int whole = 0;
  Eigen::Vector3d normal{1, 0, 0}, point{0, 0, 0}, descent{0, 0, -1};
  double tip = 0;        ///< m
  double thickness = 0;  ///< m
  double progress = 0;   ///< 0: above the structure, 1: through it
};

/// A product of a division: what is left of the whole on one side of the cut.
struct Half {
  int product = 0;
  int whole = 0;
  Shape shape;  ///< of the whole
  Cut cut;
  double sign = 1;  ///< 1: on the side that the normal points to; -1: on the other
};

/// Structures that are one surface on this day.
struct FusedGroup {
  std::vector<int> members;  ///< ascending, two or more
  double blend = 0;          ///< m
};

/// All that is there on a day, as values: numbers of structures and processes are those of what it
/// was made of.
struct DayState {
  double day = 0;
  double crown_rump_length = 0;            ///< m
  std::vector<StructureState> structures;  ///< existing ones with a geometry, ascending
  std::vector<ProcessState> processes;     ///< all, ascending
  std::vector<Cut> cuts;                   ///< of the wholes that are in division, ascending
  std::vector<Half> halves;                ///< ascending by product
  std::vector<FusedGroup> fused;           ///< by their first members
};

/// The state of a structure; null where it does not exist.
inline const StructureState* find_state(const DayState& state, int structure) {
  for (const StructureState& one : state.structures)
    if (one.structure == structure) return &one;
  return nullptr;
}

}  // namespace geoprior::embryo
