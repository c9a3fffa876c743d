#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Pixels over a part of the plane z = 0, the upper row first.
struct PixelGrid {
  Eigen::Vector2d origin{0, 0};  ///< lower left corner (m)
  double pixel = 1;              ///< side (m)
  int width = 1;
  int height = 1;

  /// Middle of a pixel.
  [[nodiscard]] Eigen::Vector2d place(int x, int y) const {
    return origin + pixel * Eigen::Vector2d(x + 0.5, height - y - 0.5);
  }
  /// Pixel coordinates of a place: whole numbers are the middles of pixels.
  [[nodiscard]] Eigen::Vector2d pixels_at(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d q = (place - origin) / pixel;
    return {q.x() - 0.5, height - q.y() - 0.5};
  }
};

/// What an eye at z = infinity sees at the middle of each pixel.
struct NearestTriangles {
  std::vector<int> triangle;             ///< -1: nothing; row by row as in the grid
  std::vector<double> depth;             ///< z of what is seen (m); -infinity: nothing
  std::vector<Eigen::Vector3d> weights;  ///< barycentric

  [[nodiscard]] bool covered(std::size_t pixel) const { return triangle[pixel] >= 0; }
};

/// Orthographic z-buffer. Of triangles of equal depth the first is seen; a pixel whose middle lies
/// on an edge belongs to every triangle of the edge, so that there are no cracks.
NearestTriangles nearest_triangles(const TriMesh& mesh, const PixelGrid& grid);

}  // namespace geoprior::sketch
