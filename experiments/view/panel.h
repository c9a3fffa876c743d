#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/frame.h"
#include "experiments/view/colors.h"
#include "experiments/view/picture.h"

namespace geoprior {

/// The rectangle of space that a panel shows, by parallel projection: the same for all panels of a
/// row, so that sizes can be compared. Axes are orthonormal, right x up = direction (to the eye).
struct ViewWindow {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double width_m = 1;
  double height_m = 1;
  double depth_m = 1;  ///< distance from the centre within which everything drawn lies
};

/// Draws parts in three dimensions: smooth shading, three lights that follow the camera, ambient
/// occlusion, supersampled edges. Needs a Display.
/// @param parts  drawn together: triangles as a surface, lines as tubes, points as spheres, a grid
///               as a coloured plane (one point thick), an iso-surface of its first scalar, or its
///               outline
/// @param scale  parts that have its array are coloured by it; absent: plain material
/// @throws Error  when OpenGL is missing, naming the package
Picture draw_panel(const std::vector<const Part*>& parts, const ViewWindow& window,
                   const std::optional<ColorScale>& scale, int width_px, int height_px);

}  // namespace geoprior
