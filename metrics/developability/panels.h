#pragma once

#include <span>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// Area of some triangles of a mesh (m^2).
double panel_area(const TriMesh& mesh, std::span<const int> triangles);

/// Gauss images (metrics/developability/developability.h) of the panels of a surface: means by
/// area.
struct PanelImages {
  double great_circle_thinness = 0;
  double small_circle_thinness = 0;
  double circle_rms = 0;  ///< of the nearer of each panel's two circles (rad)
};
/// @param panels  triangles of each, rows of F
/// @throws Error  without panels; as `gauss_image`
PanelImages panel_images(const TriMesh& mesh, std::span<const std::vector<int>> panels);

}  // namespace geoprior
