#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/curvature_fit.h"
#include "models/sound/animation.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

/// A fixed grid of square cells over a pattern. What is measured on it survives every remeshing,
/// and can be compared between meshes.
struct SoundGrid {
  Eigen::Vector2d corner{0, 0};  ///< of the pattern's bounding box, lowest u and v (m)
  double spacing = 0;            ///< side of a cell (m)
  int columns = 0, rows = 0;
  std::vector<char> inside;  ///< whether the centre of a cell lies in the pattern

  [[nodiscard]] int count() const { return columns * rows; }
  [[nodiscard]] int cell(int column, int row) const { return row * columns + column; }
  [[nodiscard]] double cell_area() const { return spacing * spacing; }
  [[nodiscard]] Eigen::Vector2d centre(int cell) const {
    return corner + spacing * Eigen::Vector2d(cell % columns + 0.5, cell / columns + 0.5);
  }
  /// The cell that contains a point, the nearest one of the grid for a point beside it.
  [[nodiscard]] int at(const Eigen::Vector2d& p) const;
  /// The cells right, above, left and below; -1 beyond the grid.
  [[nodiscard]] std::array<int, 4> neighbours(int cell) const;
};

/// @throws Error  on a spacing that is not positive, is wider than the pattern or gives more than
///                2^22 cells
SoundGrid sound_grid(const Pattern& pattern, double spacing);

/// A stretch of the sheet's border, or of a lip, and the cell that it bounds.
struct BorderStretch {
  int cell = 0;
  double length = 0;            ///< in the pattern (m)
  Eigen::Vector2d place{0, 0};  ///< its middle in the pattern (m)
};

/// A sheet at one time, seen on the grid. Rows of cells outside the sheet are zero.
struct SheetField {
  double time = 0;
  std::vector<char> inside;   ///< cells with a triangle of the mesh at their centre
  Eigen::MatrixX3d place;     ///< m
  Eigen::MatrixX3d velocity;  ///< m/s
  Eigen::MatrixX3d normal;    ///< unit, of the triangle
  /// Trace of the shape operator (1/m), the one curvature that a developable surface has: positive
  /// where the sheet is a valley seen from the side of its normals.
  Eigen::VectorXd curvature;
  /// Direction in the pattern in which the sheet is bent least: that of its rulings (unit).
  Eigen::MatrixX2d ruling;
  /// Whether the sheet holds together from a cell to the one on its right and to that above it.
  std::vector<std::array<char, 2>> joined;
  std::vector<BorderStretch> border;
  /// Cells whose curvature is read from other triangles than in the frame before: it may differ
  /// from that frame's though the sheet has not moved.
  std::vector<char> remeshed;

  /// Whether the sheet holds together between a cell and its neighbour `side` (as `neighbours`).
  [[nodiscard]] bool holds(const SoundGrid& grid, int cell, int side) const;
};

/// Sees the frames of an animation on a grid, one after the other.
///
/// Shape operators come from the dihedral angles of the mesh (core/geometry/curvature_fit.h), are
/// taken at the centres of the cells and smoothed over `radius`: by as many passes of the mask (1 4
/// 1)/6 along the rows and columns, not across lips, as give a Gaussian of that standard deviation.
/// So what a mesh wiggles within the radius is no curvature. Where the frames have no velocities,
/// those of the cells are differences of their places.
class SheetSampler {
 public:
  /// @param radius  of the smoothing (m)
  SheetSampler(SoundGrid grid, double radius);
  [[nodiscard]] const SoundGrid& grid() const { return grid_; }
  /// @throws Error  for a snapshot that is not valid (`require_valid`)
  SheetField sample(const SheetSnapshot& frame);
  /// The places of the last frame, from which velocities are taken: state of a checkpoint.
  [[nodiscard]] const std::optional<SheetField>& last() const { return last_; }
  void set_last(SheetField field) { last_ = std::move(field); }

 private:
  struct Cover;
  [[nodiscard]] const Cover& cover_of(const ShellMesh& mesh);
  [[nodiscard]] std::vector<char> remeshed_cells(const Cover& before, const Cover& now) const;
  void smooth(const Cover& cover, Eigen::MatrixX3d& S) const;

  SoundGrid grid_;
  int passes_ = 0;
  std::shared_ptr<const Cover> cover_;  ///< of the last mesh
  std::optional<SheetField> last_;
};

}  // namespace geoprior::sound
