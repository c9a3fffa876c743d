#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/mesh.h"
#include "metrics/volume/box_grid.h"

namespace geoprior {

/// Heights of a surface on vertical lines, for what stands on it.
///
/// The surface may be anyone's: where a line meets it several times (an overhang), the place that
/// is nearest to the point that asks counts. Triangles that are upright to round-off are left out.
class TerrainHeights {
 public:
  /// @throws Error  when no triangle is seen from above
  explicit TerrainHeights(TriMesh mesh);

  /// Height of the surface above or below the point (m); absent where no triangle is. A line
  /// through an edge or a corner meets it, rounded by up to 1e-9 of the triangle.
  [[nodiscard]] std::optional<double> height_near(const Eigen::Vector3d& x) const;

  /// Height of the point over the surface, negative below it (m). Where no triangle is above or
  /// below, the distance from the nearest vertex.
  [[nodiscard]] double gap(const Eigen::Vector3d& x) const;

 private:
  TriMesh mesh_;
  std::vector<int> triangle_;  ///< of each box
  std::optional<BoxGrid> grid_;
};

}  // namespace geoprior
