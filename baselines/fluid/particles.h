#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "baselines/fluid/mac_grid.h"

namespace geoprior {

/// Liquid particles, sorted by cell: those of cell c are `cell_begin[c] … cell_begin[c + 1])`.
/// Positions in single precision relative to the grid's origin, so that the error is 1e-7 of the
/// domain.
struct LiquidParticles {
  std::vector<Eigen::Vector3f> position;  ///< m, from the grid's origin
  std::vector<Eigen::Vector3f> velocity;  ///< m/s
  std::vector<Eigen::Matrix3f> affine;    ///< APIC: velocity gradient (1/s); empty otherwise
  std::vector<std::uint32_t> cell_begin;  ///< cells + 1 entries, valid after `sort_by_cell`
  [[nodiscard]] std::size_t size() const { return position.size(); }
};

/// Stable counting sort by cell (x fastest): the same order for any thread count.
void sort_by_cell(const GridShape& shape, LiquidParticles& particles);

}  // namespace geoprior
