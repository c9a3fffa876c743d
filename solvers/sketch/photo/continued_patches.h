#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "solvers/sketch/photo/pixel_image.h"

namespace geoprior::sketch {

/// Colours of a pattern's patches that go on where their own are not known (`continued_colours`).
///
/// A pattern may be finer than the photograph that its colours are from; lines are then as wide as
/// many pixels. So every `step`th pixel of every `step`th row stands for a cell, cells are
/// continued, and a pixel is between those whose middles are around it.
class ContinuedPatches {
 public:
  /// @param width, height  of the pattern (pixels)
  /// @param step           pixels a cell, at least 1
  /// @param patches        their number
  ContinuedPatches(int width, int height, int step, int patches);

  /// A colour of a patch that is known.
  void know(std::size_t pixel, int patch, const Eigen::Vector3d& colour);
  /// A pixel of a patch whose colour is wanted; after all that are known.
  void want(std::size_t pixel, int patch);
  /// @param reach  largest distance from what is known (cells)
  void fill(double reach);
  /// Nothing where no known colour of the patch is in reach.
  [[nodiscard]] std::optional<Eigen::Vector3d> colour(std::size_t pixel, int patch) const;

 private:
  [[nodiscard]] std::size_t cell_of(std::size_t pixel) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> cell_colour(int x, int y, int patch) const;

  int width_, step_;  ///< of the pattern (pixels), pixels a cell
  PixelImage cells_;
  std::vector<int> known_;  ///< patch whose colour a cell has; -1: none
  std::vector<std::vector<std::size_t>> region_, wanted_;                    ///< of each patch
  std::vector<std::unordered_map<std::size_t, Eigen::Vector3d>> continued_;  ///< likewise
};

}  // namespace geoprior::sketch
