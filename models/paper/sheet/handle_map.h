#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Which vertices of a mesh each handle of a sheet covers, and what it does to them. Where the
/// sheet is torn a point holds one lip, that which is nearest to the hand now; segments and discs
/// hold both.
class HandleMap {
 public:
  HandleMap() = default;
  /// @throws Error  when a handle covers no vertex (names it)
  HandleMap(const Sheet& sheet, const ShellState& state, std::uint64_t seed);

  /// A vertex and where a handle wants it.
  struct Target {
    int vertex;
    int handle;
    Eigen::Vector3d place;  ///< m
    std::optional<double>
        stiffness;  ///< of the hand at this vertex (N/m); absent: it does not give
  };
  /// Vertices that are held at `time`, ascending. One that several handles cover belongs to the
  /// first.
  void targets(const Sheet& sheet, double time, std::vector<Target>& out) const;

  /// Adds the dead loads active at `time` to n x 3 forces (N).
  void add_loads(const Sheet& sheet, double time, Eigen::MatrixX3d& forces) const;

 private:
  struct Covered {
    int vertex;
    int handle;
    Eigen::Vector3d rest;  ///< at the start (m)
    double share;          ///< of the handle's force
  };
  std::vector<Covered> covered_;         ///< by vertex, then handle
  std::vector<Eigen::Vector3d> centre_;  ///< of each handle's anchors at the start (m)
};

}  // namespace geoprior::paper
