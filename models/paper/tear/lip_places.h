#pragma once

#include <Eigen/Core>
#include <optional>

#include "models/paper/sheet/pattern_locator.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Places in space of pattern points at the lips of tears. The left lip (0) has the sheet on the
/// left of the way of the tip, the right one (1) on its right.
class LipPlaces {
 public:
  /// @param width  of the pattern (m)
  LipPlaces(const ShellState& state, double width);

  /// The triangle of a lip at a place of the tear.
  /// @param left  direction across the tear, to its left (unit)
  [[nodiscard]] PatternLocator::Place on_lip(const Eigen::Vector2d& p, const Eigen::Vector2d& left,
                                             int lip) const;
  /// A point of the sheet, straight from a place of the tear into the lip; absent when a border or
  /// another lip lies between.
  [[nodiscard]] std::optional<Eigen::RowVector3d> behind_lip(const Eigen::Vector2d& p,
                                                             const Eigen::Vector2d& left, int lip,
                                                             double depth) const;
  [[nodiscard]] Eigen::RowVector3d in_space(const PatternLocator::Place& at) const;
  /// A point of the pattern in the plane of a triangle, whether that contains it or not.
  [[nodiscard]] Eigen::RowVector3d in_plane_of(int triangle, const Eigen::Vector2d& p) const;

 private:
  const ShellState& state_;
  PatternLocator locator_;
  double beside_;  ///< how far beside a lip the sheet is surely on its side (m)
};

/// From a tear into its lip.
inline Eigen::Vector2d inwards(const Eigen::Vector2d& left, int lip) {
  return lip == 0 ? left : Eigen::Vector2d(-left);
}

}  // namespace geoprior::paper
