#include "baselines/fluid/liquid/particles/transfer.h"

#include <algorithm>
#include <cstring>

#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"
#include "baselines/fluid/liquid/grid/velocity_batch.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr int kTile = 4;  ///< rows of a tile along y and z
constexpr std::size_t kParticleBlock = 4096;
constexpr std::size_t kFaceBlock = 16384;

/// Four floats that the processor handles at once.
using Float4 = float __attribute__((vector_size(16)));

inline void add(float* at, Float4 x) {
  Float4 sum;
  std::memcpy(&sum, at, sizeof(sum));
  sum += x;
  std::memcpy(at, &sum, sizeof(sum));
}

/// Where sums of one component live, and how far rows and slices are apart.
struct FaceSums {
  float* sums = nullptr;  ///< momentum, weight of each face
  std::size_t row = 0, slice = 0;
};

struct Target {
  Eigen::Vector3i cells;
  float cell = 1, per_metre = 1;
  std::array<FaceSums, 3> face;
  float* density = nullptr;
};

/// Adds one component of a particle to the eight faces around it. With `kAffine` the value differs
/// by face: v + gradient . (x_i - x_p).
template <bool kAffine>
inline void add_component(const Target& t, const CellSample& s, const Eigen::Vector3f& x, int a,
                          float v, const Eigen::Vector3f& gradient) {
  const FaceSums& f = t.face[a];
  const AxisSample &sx = s.along(0, a), &sy = s.along(1, a), &sz = s.along(2, a);
  float* at =
      f.sums + 2 * (static_cast<std::size_t>(sx.low) + f.row * static_cast<std::size_t>(sy.low) +
                    f.slice * static_cast<std::size_t>(sz.low));
  const float y1 = sy.fraction, y0 = 1 - y1, z1 = sz.fraction, z0 = 1 - z1;
  const float x1 = sx.fraction, x0 = 1 - x1;
  const Float4 wx{x0, x0, x1, x1};
  Float4 value{v, 1, v, 1};
  Float4 dy{0, 0, 0, 0}, dz{0, 0, 0, 0};
  if constexpr (kAffine) {
    const Eigen::Vector3f low(static_cast<float>(sx.low) + (a == 0 ? 0.0F : 0.5F),
                              static_cast<float>(sy.low) + (a == 1 ? 0.0F : 0.5F),
                              static_cast<float>(sz.low) + (a == 2 ? 0.0F : 0.5F));
    const float base = v + gradient.dot((low - x) * t.cell);
    const Eigen::Vector3f step = gradient * t.cell;
    value = Float4{base, 1, base + step.x(), 1};
    dy = Float4{step.y(), 0, step.y(), 0};
    dz = Float4{step.z(), 0, step.z(), 0};
  }
  const std::size_t row = 2 * f.row, slice = 2 * f.slice;
  add(at, wx * value * (y0 * z0));
  add(at + row, wx * (value + dy) * (y1 * z0));
  add(at + slice, wx * (value + dz) * (y0 * z1));
  add(at + slice + row, wx * (value + dy + dz) * (y1 * z1));
}

inline void add_density(const Target& t, const CellSample& s) {
  const std::size_t row = t.cells.x();
  const std::size_t slice = row * t.cells.y();
  const AxisSample &sx = s.centre[0], &sy = s.centre[1], &sz = s.centre[2];
  float* at = t.density + static_cast<std::size_t>(sx.low) + row * sy.low + slice * sz.low;
  const float x1 = sx.fraction, x0 = 1 - x1;
  const auto pair = [&](float* to, float w) {
    to[0] += x0 * w;
    to[1] += x1 * w;
  };
  pair(at, (1 - sy.fraction) * (1 - sz.fraction));
  pair(at + row, sy.fraction * (1 - sz.fraction));
  pair(at + slice, (1 - sy.fraction) * sz.fraction);
  pair(at + slice + row, sy.fraction * sz.fraction);
}

template <bool kAffine>
void add_row(const LiquidParticles& particles, std::size_t begin, std::size_t end,
             const Target& t) {
  for (std::size_t p = begin; p < end; ++p) {
    const Eigen::Vector3f x = particles.position[p] * t.per_metre;
    const Eigen::Vector3f& v = particles.velocity[p];
    const CellSample s(x, t.cells);
    for (int a = 0; a < 3; ++a) {
      Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
      if constexpr (kAffine) gradient = particles.affine[p].row(a).transpose();
      add_component<kAffine>(t, s, x, a, v[a], gradient);
    }
    add_density(t, s);
  }
}

/// One tile: rows y0 … y0 + 3, z0 … z0 + 3 of cells. It reaches one row beyond on either side.
void add_tile(const LiquidParticles& particles, int tile_y, int tile_z, const Target& t) {
  const std::size_t nx = t.cells.x();
  const int y_end = std::min(t.cells.y(), (tile_y + 1) * kTile);
  const int z_end = std::min(t.cells.z(), (tile_z + 1) * kTile);
  for (int k = tile_z * kTile; k < z_end; ++k) {
    for (int j = tile_y * kTile; j < y_end; ++j) {
      const std::size_t row =
          nx * (static_cast<std::size_t>(j) + static_cast<std::size_t>(t.cells.y()) * k);
      const std::size_t begin = particles.cell_begin[row], end = particles.cell_begin[row + nx];
      if (particles.affine.empty()) {
        add_row<false>(particles, begin, end, t);
      } else {
        add_row<true>(particles, begin, end, t);
      }
    }
  }
}

void add_tiles(const LiquidParticles& particles, const Target& t) {
  const int tiles_y = (t.cells.y() + kTile - 1) / kTile;
  const int tiles_z = (t.cells.z() + kTile - 1) / kTile;
  for (int colour = 0; colour < 4; ++colour) {
    const int first_y = colour % 2, first_z = colour / 2;
    const int count_y = (tiles_y - first_y + 1) / 2, count_z = (tiles_z - first_z + 1) / 2;
    if (count_y <= 0 || count_z <= 0) continue;
    const auto count = static_cast<std::size_t>(count_y) * count_z;
    parallel_blocks(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const int n = static_cast<int>(i);
        add_tile(particles, first_y + 2 * (n % count_y), first_z + 2 * (n / count_y), t);
      }
    });
  }
}

/// u = momentum / weight.
void divide(const std::vector<float>& sums, ScalarGrid& velocity, std::vector<char>& touched) {
  touched.resize(velocity.values.size());
  parallel_blocks(velocity.values.size(), kFaceBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float weight = sums[2 * i + 1];
      // Below this the quotient would be one particle's round-off.
      const bool reached = weight > 1e-6F;
      velocity.values[i] = reached ? sums[2 * i] / weight : 0.0F;
      touched[i] = reached ? 1 : 0;
    }
  });
}

}  // namespace

ParticleToGrid::ParticleToGrid(const GridShape& shape) : shape_(shape) {}

void ParticleToGrid::gather(const LiquidParticles& particles, int particles_per_cell,
                            MacGrid& velocity, std::array<std::vector<char>, 3>& touched,
                            ScalarGrid& density) {
  density.size = shape_.cells;
  density.values.assign(shape_.cell_count(), 0.0F);
  Target t;
  t.cells = shape_.cells;
  t.cell = static_cast<float>(shape_.cell);
  t.per_metre = static_cast<float>(1 / shape_.cell);
  t.density = density.values.data();
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i n = shape_.face_cells(a);
    sums_[a].assign(2 * velocity.face[a].values.size(), 0.0F);
    const std::size_t row = n.x();
    t.face[a] = {sums_[a].data(), row, row * n.y()};
  }
  add_tiles(particles, t);
  for (std::size_t a = 0; a < 3; ++a) divide(sums_[a], velocity.face[a], touched[a]);
  const float scale = 1.0F / static_cast<float>(particles_per_cell);
  for (float& d : density.values) d *= scale;
}

namespace {

/// Beyond the last centre of an axis the interpolant is constant: a slope there would carry a
/// velocity to the wall that no particle has, and energy with it.
void flatten_at_walls(const Eigen::Vector3f& x, const Eigen::Vector3i& cells,
                      Eigen::Matrix3f& gradient) {
  for (int b = 0; b < 3; ++b) {
    if (x[b] > 0.5F && x[b] < static_cast<float>(cells[b]) - 0.5F) continue;
    for (int a = 0; a < 3; ++a)
      if (a != b) gradient(a, b) = 0;
  }
}

void take_with_gradient(const MacGrid& field, float keep, std::size_t begin, std::size_t end,
                        LiquidParticles& particles) {
  const FaceSampler sampler(field);
  const auto per_metre = static_cast<float>(1 / field.shape.cell);
  const Eigen::Vector3i& cells = field.shape.cells;
  for (std::size_t p = begin; p < end; ++p) {
    const Eigen::Vector3f x = particles.position[p] * per_metre;
    const CellSample s(x, cells);
    Eigen::Vector3f& v = particles.velocity[p];
    Eigen::Matrix3f& gradient = particles.affine[p];
    for (int a = 0; a < 3; ++a) {
      const CornerValues c = sampler.corners(s, a);
      const float fx = s.along(0, a).fraction, fy = s.along(1, a).fraction,
                  fz = s.along(2, a).fraction;
      v[a] = keep * v[a] + c.value(fx, fy, fz);
      gradient.row(a) = c.gradient(fx, fy, fz).transpose() * per_metre;
    }
    flatten_at_walls(x, cells, gradient);
  }
}

void take(const MacGrid& field, float keep, std::size_t begin, std::size_t end,
          LiquidParticles& particles) {
  const BatchSampler sampler(field);
  const auto per_metre = static_cast<float>(1 / field.shape.cell);
  for (std::size_t first = begin; first < end; first += kBatch) {
    BatchPoints x, u;
    load_batch(particles.position, first, end, per_metre, x);
    sampler.sample(x, u);
    for (std::size_t p = first; p < std::min(first + kBatch, end); ++p) {
      const std::size_t l = p - first;
      const Eigen::Vector3f change(u.x[0][l], u.x[1][l], u.x[2][l]);
      particles.velocity[p] = keep * particles.velocity[p] + change;
    }
  }
}

}  // namespace

void grid_to_particles(const MacGrid& field, float keep, bool affine, LiquidParticles& particles) {
  parallel_blocks(particles.size(), kParticleBlock, [&](std::size_t begin, std::size_t end) {
    if (affine) {
      take_with_gradient(field, keep, begin, end, particles);
    } else {
      take(field, keep, begin, end, particles);
    }
  });
}

double kinetic_energy(const GridShape& shape, const LiquidParticles& particles) {
  const auto per_metre = static_cast<float>(1 / shape.cell);
  const double h2 = shape.cell * shape.cell;
  std::vector<double> sums((particles.size() + kParticleBlock - 1) / kParticleBlock, 0.0);
  parallel_blocks(particles.size(), kParticleBlock, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t p = begin; p < end; ++p) {
      sum += static_cast<double>(particles.velocity[p].squaredNorm());
      if (particles.affine.empty()) continue;
      const CellSample s(particles.position[p] * per_metre, shape.cells);
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          // Second moment of the two weights of an axis.
          const double f = s.along(b, a).fraction;
          const double c = particles.affine[p](a, b);
          sum += h2 * f * (1 - f) * c * c;
        }
      }
    }
    sums[begin / kParticleBlock] = sum;
  });
  double total = 0;
  for (const double sum : sums) total += sum;
  return 0.5 * total;
}

}  // namespace geoprior::fluid
