#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace geoprior::fluid {

/// Where numbers of a regular grid of cells sit: x runs fastest. Single precision: a liquid's grid
/// is bound by memory, and its truncation errors are far above 1e-7.
struct GridShape {
  Eigen::Vector3i cells{0, 0, 0};
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< lower corner (m)
  double cell = 1;                                   ///< h (m)

  [[nodiscard]] std::size_t cell_count() const {
    return static_cast<std::size_t>(cells.x()) * cells.y() * cells.z();
  }
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(cells.x()) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(cells.y()) * k);
  }
  [[nodiscard]] Eigen::Vector3d cell_centre(int i, int j, int k) const {
    return origin + cell * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5);
  }
  [[nodiscard]] Eigen::Vector3d node(int i, int j, int k) const {
    return origin + cell * Eigen::Vector3d(i, j, k);
  }
  /// Shape of the faces normal to `axis` (cells + 1 along it), as a grid of its own.
  [[nodiscard]] Eigen::Vector3i face_cells(int axis) const {
    Eigen::Vector3i n = cells;
    n[axis] += 1;
    return n;
  }
};

/// Numbers at the points of a box grid, x fastest.
struct ScalarGrid {
  Eigen::Vector3i size{0, 0, 0};
  std::vector<float> values;

  ScalarGrid() = default;
  ScalarGrid(const Eigen::Vector3i& n, float fill)
      : size(n), values(static_cast<std::size_t>(n.x()) * n.y() * n.z(), fill) {}
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size.x()) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(size.y()) * k);
  }
  float& operator()(int i, int j, int k) { return values[index(i, j, k)]; }
  [[nodiscard]] float operator()(int i, int j, int k) const { return values[index(i, j, k)]; }
};

/// Staggered velocity (Harlow and Welch 1965): component `a` at the centres of the faces normal to
/// axis `a`.
struct MacGrid {
  GridShape shape;
  std::array<ScalarGrid, 3> face;  ///< m/s, size shape.face_cells(a)

  MacGrid() = default;
  explicit MacGrid(const GridShape& grid);
};

/// How much of each face and cell is free of solids, and how fast the solids move there.
struct SolidFractions {
  std::array<ScalarGrid, 3> open;      ///< of faces: area fraction free of solid, 0 … 1
  std::array<ScalarGrid, 3> velocity;  ///< of the solid at faces (m/s), where open < 1
  ScalarGrid
      distance;  ///< at the nodes (cells + 1): to the nearest solid or wall, negative inside (m)
};

}  // namespace geoprior::fluid
