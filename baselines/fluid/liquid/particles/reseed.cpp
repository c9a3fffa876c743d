#include "baselines/fluid/liquid/particles/reseed.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior::fluid {
namespace {

/// Mixes seed, step and cell into one number: neighbouring cells get unrelated streams.
RandomStream cell_stream(const SeedRule& rule, std::size_t cell) {
  std::uint64_t x = rule.seed + 0x9E3779B97F4A7C15ULL * (rule.step + 1);
  x ^= 0xD1B54A32D192ED03ULL * (static_cast<std::uint64_t>(cell) + 1);
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return RandomStream(x ^ (x >> 31U), static_cast<std::uint64_t>(cell));
}

/// Jittered places in the unit cell, one in each of `count` of n^3 boxes.
void jittered_places(RandomStream& random, int count, std::vector<Eigen::Vector3d>& places) {
  int n = 1;
  while (n * n * n < count) ++n;
  std::vector<int> box(n * n * n);
  for (std::size_t i = 0; i < box.size(); ++i) box[i] = static_cast<int>(i);
  places.clear();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if (static_cast<int>(box.size()) != count) {
      const auto rest = static_cast<std::uint32_t>(box.size() - i);
      std::swap(box[i], box[i + random.below(rest)]);
    }
    const Eigen::Vector3d corner(box[i] % n, box[i] / n % n, box[i] / (n * n));
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    places.push_back((corner + Eigen::Vector3d(x, y, z)) / n);
  }
}

/// Free of solids, and by more than round-off.
bool is_free(const ScalarGrid* solids, const Eigen::Vector3f& cells) {
  return solids == nullptr || GridSampler(*solids)(cells) > 0;
}

void append(const Eigen::Vector3f& position, const Eigen::Vector3f& velocity, bool affine,
            LiquidParticles& particles) {
  particles.position.push_back(position);
  particles.velocity.push_back(velocity);
  if (affine) particles.affine.push_back(Eigen::Matrix3f::Zero());
}

std::uint32_t particles_in(const LiquidParticles& particles, std::size_t cell) {
  return particles.cell_begin[cell + 1] - particles.cell_begin[cell];
}

/// Cells from `low` up to `high` that a box touches.
struct TankCells {
  Eigen::Vector3i low, high;
};

TankCells cells_of(const GridShape& shape, const Eigen::AlignedBox3d& box) {
  TankCells range{Eigen::Vector3i::Zero(), shape.cells};
  for (int a = 0; a < 3; ++a) {
    const double n = shape.cells[a];
    const double low = (box.min()[a] - shape.origin[a]) / shape.cell;
    const double high = (box.max()[a] - shape.origin[a]) / shape.cell;
    range.low[a] = static_cast<int>(std::clamp(std::floor(low), 0.0, n));
    range.high[a] = static_cast<int>(std::clamp(std::ceil(high), 0.0, n));
  }
  return range;
}

}  // namespace

std::size_t fill_shape(const GridShape& shape, const ShapeDistance& body,
                       const Eigen::Vector3d& velocity, const ScalarGrid* solids, bool only_empty,
                       const SeedRule& rule, LiquidParticles& particles) {
  const TankCells range = cells_of(shape, body.bounds());
  const int slices = range.high.z() - range.low.z();
  if (slices <= 0) return 0;
  std::vector<std::vector<Eigen::Vector3f>> found(slices);
  const double reach = shape.cell * std::sqrt(0.75);
  parallel_blocks(found.size(), 1, [&](std::size_t begin, std::size_t) {
    const int k = range.low.z() + static_cast<int>(begin);
    std::vector<Eigen::Vector3d> places;
    for (int j = range.low.y(); j < range.high.y(); ++j) {
      for (int i = range.low.x(); i < range.high.x(); ++i) {
        const std::size_t cell = shape.index(i, j, k);
        if (only_empty && particles_in(particles, cell) > 0) continue;
        if (body(shape.cell_centre(i, j, k)) > reach) continue;
        RandomStream random = cell_stream(rule, cell);
        jittered_places(random, rule.particles_per_cell, places);
        for (const Eigen::Vector3d& place : places) {
          const Eigen::Vector3d x = Eigen::Vector3d(i, j, k) + place;
          if (body(shape.origin + shape.cell * x) >= 0) continue;
          if (!is_free(solids, x.cast<float>())) continue;
          found[begin].push_back((shape.cell * x).cast<float>());
        }
      }
    }
  });
  std::size_t count = 0;
  for (const auto& slice : found) {
    for (const Eigen::Vector3f& x : slice)
      append(x, velocity.cast<float>(), rule.affine, particles);
    count += slice.size();
  }
  return count;
}

void set_velocity_inside(const GridShape& shape, const ShapeDistance& body,
                         const Eigen::Vector3d& velocity, LiquidParticles& particles) {
  const TankCells range = cells_of(shape, body.bounds());
  const Eigen::Vector3f v = velocity.cast<float>();
  for (int k = range.low.z(); k < range.high.z(); ++k) {
    for (int j = range.low.y(); j < range.high.y(); ++j) {
      if (range.low.x() >= range.high.x()) continue;
      const std::size_t first = shape.index(range.low.x(), j, k);
      const std::size_t last = shape.index(range.high.x() - 1, j, k);
      for (std::uint32_t p = particles.cell_begin[first]; p < particles.cell_begin[last + 1]; ++p) {
        if (body(shape.origin + particles.position[p].cast<double>()) >= 0) continue;
        particles.velocity[p] = v;
        if (!particles.affine.empty()) particles.affine[p].setZero();
      }
    }
  }
}

namespace {

/// True when the cell and its six neighbours (walls too) are liquid.
bool is_surrounded(const ScalarGrid& distance, int i, int j, int k) {
  const Eigen::Vector3i at(i, j, k);
  if (distance(i, j, k) >= 0) return false;
  for (int a = 0; a < 3; ++a) {
    for (const int step : {-1, 1}) {
      Eigen::Vector3i n = at;
      n[a] += step;
      if (n[a] < 0 || n[a] >= distance.size[a]) continue;
      if (distance(n.x(), n.y(), n.z()) >= 0) return false;
    }
  }
  return true;
}

/// Cells that have too few or too many, in order.
struct Uneven {
  struct Cell {
    int i, j, k;
    int change;  ///< particles to add (positive) or to remove
  };
  std::vector<Cell> cells;
};

Uneven find_uneven(const ScalarGrid& distance, const LiquidParticles& particles, int per_cell,
                   std::int64_t& balance) {
  Uneven uneven;
  std::size_t cell = 0;
  for (int k = 0; k < distance.size.z(); ++k) {
    for (int j = 0; j < distance.size.y(); ++j) {
      for (int i = 0; i < distance.size.x(); ++i, ++cell) {
        const int count = static_cast<int>(particles_in(particles, cell));
        const int most = balance > 0 ? per_cell * 3 / 2 : 2 * per_cell;
        const int least = balance < 0 ? std::max(3, per_cell * 5 / 8) : 3;
        if (count >= least && count <= most) continue;
        if (count < least && (count > per_cell || !is_surrounded(distance, i, j, k))) continue;
        const int change = count < least ? least - count : most - count;
        uneven.cells.push_back({i, j, k, change});
        balance += change;
      }
    }
  }
  return uneven;
}

}  // namespace

bool reseed(const MacGrid& velocity, const ScalarGrid& distance, const SeedRule& filling,
            std::int64_t& balance, LiquidParticles& particles) {
  const GridShape& shape = velocity.shape;
  SeedRule rule = filling;
  rule.seed ^= 0xA0761D6478BD642FULL;  // not the numbers that a source of this step drew
  const Uneven uneven = find_uneven(distance, particles, rule.particles_per_cell, balance);
  if (uneven.cells.empty()) return false;
  const FaceSampler sampler(velocity);
  std::vector<std::uint8_t> removed(particles.size(), 0);
  bool removes = false;
  LiquidParticles added;
  for (const Uneven::Cell& c : uneven.cells) {
    const std::size_t cell = shape.index(c.i, c.j, c.k);
    if (c.change < 0) {
      // Which particles go is drawn: in a cell they stand in the order of their arrival.
      RandomStream random = cell_stream(rule, cell);
      const std::uint32_t first = particles.cell_begin[cell], count = particles_in(particles, cell);
      for (int taken = 0; taken < -c.change;) {
        std::uint8_t& gone = removed[first + random.below(count)];
        if (gone != 0) continue;
        gone = 1;
        ++taken;
      }
      removes = true;
      continue;
    }
    RandomStream random = cell_stream(rule, cell);
    std::vector<Eigen::Vector3d> places;
    jittered_places(random, c.change, places);
    for (const Eigen::Vector3d& place : places) {
      const Eigen::Vector3f x = (Eigen::Vector3d(c.i, c.j, c.k) + place).cast<float>();
      append(x * static_cast<float>(shape.cell), sampler(x), rule.affine, added);
    }
  }
  if (removes) remove_particles(removed, particles);
  for (std::size_t p = 0; p < added.size(); ++p) {
    append(added.position[p], added.velocity[p], rule.affine, particles);
  }
  return true;
}

}  // namespace geoprior::fluid
