#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "testbed/view/panel/content.h"

namespace geoprior {

/// A thing of a name, as far as a panel shows it.
struct SeenName {
  std::string name;
  /// A point inside the largest connected piece that is seen of it, near that piece's centroid
  /// (pixels: x to the right, y downwards from the top left corner).
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double pixels = 0;  ///< that are seen of it
};

/// What a panel of that size shows of the things that a named array of its parts and overlays tells
/// apart: what is nearest to the eye at each pixel, found by a depth buffer of at most 500 by 500
/// cells. Things of one name in several parts are one; what shows less than four cells is not seen.
/// Obstacles hide nothing, grids neither hide nor are named. In the order of the names.
std::vector<SeenName> seen_names(const PanelParts& parts, const ViewWindow& window,
                                 const std::string& array, int width_px, int height_px);

}  // namespace geoprior
