#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/paper/sheet.h"

namespace geoprior::paper {

/// A point of the pattern that a handle moves.
struct MovingAnchor {
  std::size_t handle;       ///< index
  Eigen::Vector2d pattern;  ///< m
  Eigen::Vector3d rest;     ///< its place at the start (m)
  Eigen::Vector3d centre;   ///< mean of the handle's anchors there (m)
};

/// Anchors of all handles with keys.
std::vector<MovingAnchor> moving_anchors(const Sheet& sheet);

/// Times at which motions are looked at (s, increasing): those of keys, the ends of activity, start
/// and end of the scene, and `kTimesBetween` times between each two of them.
std::vector<double> motion_times(const Sheet& sheet);
inline constexpr int kTimesBetween = 31;

/// "scene.handles.1 'left'", for messages. @param where  "scene"
std::string handle_name(const Sheet& sheet, std::size_t i, const std::string& where);

}  // namespace geoprior::paper
