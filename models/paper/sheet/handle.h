#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/inputs/trajectory.h"

namespace geoprior::paper {

/// A place where the sheet is held: pattern points, a straight segment or a disc of the pattern.
///
/// Every mesh of the sheet has vertices at `anchors()`; on each mesh all vertices that `covers`
/// accepts are held. A held vertex with rest place X0 (in space) goes to c + shift + turn (X0 - c),
/// c the centre of the anchors.
struct Handle {
  std::string name;
  std::vector<Eigen::Vector2d> points;  ///< the shape, unless segment or disc
  std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> segment;
  std::optional<double> disc_radius;     ///< about points.front() (m)
  std::optional<Trajectory> motion;      ///< prescribed, or …
  std::optional<Eigen::Vector3d> force;  ///< … a dead load (N), spread over the shape
  /// Of the hand that follows `motion`: what it holds departs from its place by the force over this
  /// (N/m, spread over the shape); absent: not at all.
  std::optional<double> stiffness;
  /// Times at which it holds or pulls; empty: always.
  std::vector<std::pair<double, double>> active;

  /// Points; ends of the segment; centre of the disc and `kDiscAnchors` points of its rim.
  [[nodiscard]] std::vector<Eigen::Vector2d> anchors() const;
  static constexpr int kDiscAnchors = 4;
  [[nodiscard]] bool covers(const Eigen::Vector2d& pattern_point, double tolerance = 1e-9) const;
  /// From a pattern point to the shape, 0 on it (m).
  [[nodiscard]] double distance(const Eigen::Vector2d& pattern_point) const;
  [[nodiscard]] bool is_active(double time) const;
  /// Where a covered pattern point is at `time` under `motion`. @param rest its place at the start
  [[nodiscard]] Eigen::Vector3d target(const Eigen::Vector3d& rest, const Eigen::Vector3d& centre,
                                       double time) const;
};

}  // namespace geoprior::paper
