#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/embryo/body/day_state.h"
#include "models/embryo/motion/ease.h"
#include "models/embryo/ontology/ontology.h"

namespace geoprior::embryo {

/// A turn about an axis of the body, eased from one day to another.
struct Turn {
  Eigen::Vector3d about{0, 0, 1};  ///< unit
  double angle = 0;                ///< rad
  double from = 0, to = 0;
};

/// What is to become of a structure: its key frames, and what processes that run or do not run make
/// of them.
struct PlannedStructure {
  std::string name;  ///< for messages
  std::vector<Key> keys;
  std::vector<bool> exists;  ///< by stage
  /// Days from which the sizes stay; the place and the directions, as ratios in their frame; a
  /// duct's ends, as ratios in the body. Absent: they follow the keys.
  std::optional<double> sizes_held, place_held, ends_held;
  std::vector<Turn> turns;  ///< one after the other on what the keys say
  std::vector<int> stops;   ///< structures above whose centres its own may not rise
};

/// A septum's way down through a structure, and what becomes of both sides.
struct PlannedDivision {
  bool active = true;  ///< otherwise products only have the whole's shape, where they exist at all
  int whole = 0;
  std::vector<std::pair<int, double>> products;  ///< and the sign of its side (Half)
  double from = 0, to = 0;
  Eigen::Vector3d normal{1, 0, 0}, descent{0, 0, -1};  ///< unit
  double thickness = 0;                                ///< m
};

/// What is recorded of a process, beside what it does.
struct PlannedProcess {
  bool active = true;
  double from = 0, to = 0;
  bool interacts = false;
  std::optional<int> inducer, target;
  double within = 0;       ///< m
  std::vector<int> fuses;  ///< one surface from the day `from` on
  double blend = 0;        ///< m
};

/// All that the state of a body on any day is a function of. Plain values, made of an ontology
/// (solvers/embryo/state) or of a table (baselines/embryo).
struct BodyPlan {
  std::vector<Stage> stages;
  std::vector<std::pair<double, double>> crown_rump_length;  ///< day, metres; by day
  std::vector<PlannedStructure> structures;
  std::vector<PlannedDivision> divisions;
  std::vector<PlannedProcess> processes;
  std::vector<FusedGroup> fused;  ///< on every day
  Interpolation interpolation = Interpolation::monotone;
};

}  // namespace geoprior::embryo
