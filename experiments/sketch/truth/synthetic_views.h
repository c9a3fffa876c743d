#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// Shapes whose one-view drawings are known with their depth.
enum class SyntheticShape {
  frustum,  ///< of a cone: two parallel circles, open at both ends
  tent,     ///< two plane slopes that meet in a ridge, triangular ends
};

/// The object stands on y = 0 about the y axis, is turned about it, and tilted towards the eye.
struct SyntheticViewOptions {
  SyntheticShape shape = SyntheticShape::frustum;
  double radius = 1;
  double top_radius = 0.6;  ///< of the upper circle; equal radii: a cylinder (m)
  double height = 1.5;      ///< m
  double length = 2;
  double yaw_deg = 35;  ///< of the mirror plane's normal from the picture's plane
  double pitch_deg = 25;
  int points = 240;
  int lower_pairs = 4;
  int upper_pairs = 0;
  bool upper_point = true;
  double noise = 0;
  bool noisy_vectors = false;
  int seed = 1;
};
void describe(OptionVisitor& v, SyntheticViewOptions& options);

/// Turn of an object about its upright axis y, then tilt towards the eye: rows are right, up and
/// towards the eye.
Eigen::Matrix3d turned_view(double yaw_deg, double pitch_deg);

/// A drawing and what it shows.
struct SyntheticView {
  View view;
  /// Of each point of each stroke: x right, y up, z towards the eye; without noise (m).
  std::vector<std::vector<Eigen::Vector3d>> truth;
  Eigen::Vector3d mirror_normal{1, 0, 0};  ///< unit, z >= 0; the plane passes through the origin
  bool conical = false;                    ///< axis and apex are those of the shape
  Eigen::Vector3d axis{0, 1, 0};           ///< of the cone, up
  Eigen::Vector3d apex{0, 0, 0};           ///< of the cone; far away for a cylinder
  double height = 0;                       ///< m
  /// Of named panels, where they are known; of visible borders alone that of ruled panels up to the
  /// last places where a border of their row of panels is seen (m^2).
  std::map<std::string, double> panel_areas = {};
  /// Borders with their hidden parts, of a known object; a closed one ends with its first point.
  std::vector<std::vector<Eigen::Vector3d>> borders = {};
};

/// Orthographic drawing of a shape, as a careful user makes it: borders whole (hidden parts too,
/// marked by strokes of kind occlusion), both silhouettes, pairs, and the vectors of the mirror
/// plane from the origin. Borders of the tent name their panels.
///
/// Each stroke has random numbers of its own, so that the noise of one does not depend on what else
/// is drawn.
/// @throws Error  when the frustum shows no silhouette (seen into from above)
SyntheticView synthetic_view(const SyntheticViewOptions& options);

}  // namespace geoprior::sketch
