#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// A point of the pattern that a handle moves.
struct MovingAnchor {
  std::size_t handle;       ///< index
  Eigen::Vector2d pattern;  ///< m
  Eigen::Vector3d rest;     ///< its place at the start, without the seeded waves (m)
  Eigen::Vector3d centre;   ///< mean of the handle's anchors there (m)
};

/// Anchors of all handles with keys.
std::vector<MovingAnchor> moving_anchors(const Sheet& sheet);

/// Greatest speed (m/s) of an anchor of a handle that holds the sheet between two times, from the
/// chords of `parts` equal parts of that time. Without such a handle 0.
/// @param parts  >= 1
double handle_speed(const Sheet& sheet, double start, double end, int parts);

/// Time steps of the frame from `start` to `end`: `sheet.substeps`, and as many more as keep every
/// handle within `sheet.handle_step` a step.
int substeps_of_frame(const Sheet& sheet, double start, double end);

}  // namespace geoprior::paper
