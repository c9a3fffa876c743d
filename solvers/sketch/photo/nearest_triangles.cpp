#include "solvers/sketch/photo/nearest_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

using TriangleCorners = std::array<Eigen::Vector3d, 3>;

/// First and last pixel of a row or column that a range of pixel coordinates may cover.
std::array<int, 2> pixel_range(double low, double high, int count) {
  const double most = static_cast<double>(count) - 1;
  return {static_cast<int>(std::clamp(std::ceil(low - 1e-9), 0.0, most + 1)),
          static_cast<int>(std::clamp(std::floor(high + 1e-9), -1.0, most))};
}

void paint_triangle(const TriangleCorners& c, int number, const PixelGrid& grid,
                    NearestTriangles& seen) {
  constexpr double kOnEdge = -1e-12;
  std::array<Eigen::Vector2d, 3> p;
  for (int k = 0; k < 3; ++k) p[k] = grid.pixels_at(c[k].head<2>());
  const double whole = cross(p[1] - p[0], p[2] - p[0]);
  if (whole == 0) return;
  const auto [left, right] = pixel_range(std::min({p[0].x(), p[1].x(), p[2].x()}),
                                         std::max({p[0].x(), p[1].x(), p[2].x()}), grid.width);
  const auto [top, bottom] = pixel_range(std::min({p[0].y(), p[1].y(), p[2].y()}),
                                         std::max({p[0].y(), p[1].y(), p[2].y()}), grid.height);
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector2d q(x, y);
      Eigen::Vector3d w(cross(p[1] - q, p[2] - q) / whole, cross(p[2] - q, p[0] - q) / whole, 0);
      w.z() = 1 - w.x() - w.y();
      if (w.minCoeff() < kOnEdge) continue;
      const double z = w.x() * c[0].z() + w.y() * c[1].z() + w.z() * c[2].z();
      const std::size_t i = static_cast<std::size_t>(y) * grid.width + x;
      if (!(z > seen.depth[i])) continue;
      seen.depth[i] = z;
      seen.triangle[i] = number;
      seen.weights[i] = w;
    }
  }
}

}  // namespace

NearestTriangles nearest_triangles(const TriMesh& mesh, const PixelGrid& grid) {
  const std::size_t count = static_cast<std::size_t>(grid.width) * grid.height;
  NearestTriangles seen;
  seen.triangle.assign(count, -1);
  seen.depth.assign(count, -std::numeric_limits<double>::infinity());
  seen.weights.assign(count, Eigen::Vector3d::Zero());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    TriangleCorners corners;
    for (int k = 0; k < 3; ++k) corners[k] = mesh.V.row(mesh.F(t, k)).transpose();
    paint_triangle(corners, static_cast<int>(t), grid, seen);
  }
  return seen;
}

}  // namespace geoprior::sketch
