#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "baselines/fluid/liquid/grid/mac_grid.h"

namespace geoprior::fluid {

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

/// Stable counting sort by cell (x fastest): the same order for any thread count. Particles outside
/// the grid count to the nearest cell.
void sort_by_cell(const GridShape& shape, LiquidParticles& particles);

/// `sort_by_cell` with buffers that stay from one call to the next: no allocation once warm.
///
/// Two levels, so that counters fit into the cache: blocks of particles are counted and spread by
/// row of cells (y, z), then every row is sorted by x.
class CellSorter {
 public:
  void sort(const GridShape& shape, LiquidParticles& particles);

 private:
  void count_rows(const GridShape& shape, const LiquidParticles& particles);
  void spread_rows(std::size_t rows);
  void sort_rows(const GridShape& shape, LiquidParticles& particles);
  void gather(LiquidParticles& particles);

  std::size_t block_ = 0;             ///< particles counted together
  std::vector<std::uint32_t> cell_;   ///< of each particle
  std::vector<std::uint32_t> count_;  ///< particles, then next place, of row r in block b
  std::vector<std::uint32_t> row_begin_;
  std::vector<std::uint32_t> by_row_;  ///< particles in order of rows
  std::vector<std::uint32_t> order_;   ///< particles in order of cells
  LiquidParticles sorted_;
};

/// Removes the particles whose flag is not zero; the others keep their order. Leaves cell_begin as
/// it was.
void remove_particles(const std::vector<std::uint8_t>& removed, LiquidParticles& particles);

}  // namespace geoprior::fluid
