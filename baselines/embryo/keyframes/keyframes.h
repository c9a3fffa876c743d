#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "models/embryo/body/day_state.h"
#include "models/embryo/ontology/ontology.h"

namespace geoprior::embryo {

struct KeyframesOptions {
  int triangles = 2000;  ///< of each mesh, at least
};

/// One structure of a day.
struct KeyframedMesh {
  int structure = 0;
  TriMesh mesh;
};

/// What an animator's file would hold: one mesh of each structure at the middle of each stage,
/// and on the days between them the vertices on straight lines.
///
/// It is made once, of the healthy body, and knows of no ontology after that: no rule, no process,
/// no anchor. A disease is a list of structures that are not shown; nothing else changes. What it
/// cannot do besides: growth between key frames is linear, a turn goes along chords, so that a part
/// that turns by 90 degrees between two of them is thinner by 29 % half-way; velocities jump at
/// every key frame; a division has no septum on its way, only the whole before and the halves
/// after it; nothing is blended.
class Keyframes {
 public:
  /// @param middles  the state of the middle of every stage
  /// @throws Error   unless there are as many of both
  Keyframes(std::span<const DayState> middles, std::span<const Stage> stages,
            const KeyframesOptions& options = {});

  /// Ascending by structure: from the first day of the stage of a structure's first key frame to
  /// the last day of that of its last one.
  /// @param hidden   by structure, those that are not shown; shorter or empty: the rest is shown
  /// @throws Error   for a day outside of the stages (names their range)
  [[nodiscard]] std::vector<KeyframedMesh> at(double day,
                                              const std::vector<bool>& hidden = {}) const;
  /// What the key frames take: three numbers a vertex of each, and the triangles of a structure
  /// once.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Track {
    double first = 0, last = 0;  ///< days from and up to which it is shown
    std::vector<double> days;
    std::vector<Eigen::MatrixX3d> V;  ///< by day
    Eigen::MatrixX3i F;
  };

  double first_day_ = 0, last_day_ = 0;
  std::map<int, Track> tracks_;  ///< by structure
};

}  // namespace geoprior::embryo
