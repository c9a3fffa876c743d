#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/state_bytes.h"
#include "models/sketch/surface/visual_hull.h"
#include "solvers/sketch/surface/pinned_transfer.h"

namespace geoprior::sketch {

/// Puts vertices that have left the silhouette of their view back onto it.
///
/// Zippering (`Zippering`) chooses among the edges of the hull that lie on a silhouette. Of a flat
/// side that is all of it, so that folds which protrude are among them. A round one only touches
/// its silhouette along a line, and folds beside that go out through it. A vertex that is outside
/// by more than 0.15 edges, which is more than chords make, is put onto the nearest point of the
/// silhouette, free to slide along it, until it comes inside by itself. One that the hull has on
/// the silhouette near there, as the vertices of a hem, which slide past its corner, is put to
/// where the hull has it, and is held there from then on.
class SilhouetteStops {
 public:
  /// @param hull  must live as long as this
  SilhouetteStops(const VisualHull& hull, std::size_t view);

  /// @param X     n x 3, now (m)
  /// @param pins  to which coordinates are added
  void hold(const Eigen::MatrixX3d& X, CoordinatePins& pins);

  void save(StateWriter& out) const { out.matrix(held_); }
  void load(StateReader& in) { in.matrix(held_); }

 private:
  [[nodiscard]] bool has_place_near(int vertex, double arc_length) const;
  void set(int vertex, int k, double value, CoordinatePins& pins) const;

  const Eigen::MatrixX3d& hull_;
  const OutlinedView& view_;
  const std::vector<std::optional<SilhouettePlace>>& places_;
  double spacing_;        ///< m
  Eigen::VectorXd held_;  ///< 1: from now on
};

}  // namespace geoprior::sketch
