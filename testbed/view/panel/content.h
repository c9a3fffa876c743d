#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/frame.h"
#include "testbed/view/figure/colors.h"

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

/// A part that explains another: thin lines and small balls, slightly lifted towards the eye.
/// Triangles that have 1 in an array "bevel" are lighter.
struct PanelOverlay {
  const Part* part = nullptr;
  std::array<double, 3> color{0, 0, 0};
  bool fine = false;  ///< lines as thin as hair
};

/// What is drawn together: triangles as a surface, lines as tubes, points as spheres, a grid as a
/// coloured plane (one point thick), an iso-surface of its first scalar, or its outline.
struct PanelParts {
  std::vector<const Part*> parts;
  std::vector<PanelOverlay> overlays;
  std::vector<const Part*> obstacles;  ///< drawn translucent
};

struct PanelStyle {
  enum class Material { clay, paper, water };
  std::optional<ColorScale> scale;  ///< parts that have its array are coloured; absent: plain
  bool flat = false;                ///< one tone a triangle
  bool edges = false;               ///< edges of the triangles as thin lines
  bool raking = false;              ///< lights that graze: a fold of a few degrees is seen
  Material material = Material::clay;
};

}  // namespace geoprior
