#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "baselines/fluid/surface_kernels.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

// Yu and Turk 2013: names and values of the paper.
constexpr float kSmoothing = 0.9F;     ///< lambda: how far a place moves to its neighbours' mean
constexpr float kLargestRatio = 4;     ///< k_r: of the longest to the shortest axis
constexpr int kFewestNeighbours = 25;  ///< N_epsilon: a kernel with fewer is a ball
constexpr float kLonelySize = 0.5F;    ///< k_n: its size
/// Variance along an axis of a full ball of radius 1 with the weights 1 - r^3.
constexpr float kBallVariance = 0.15F;
/// The field is moved out by this share of R, so that a flat surface of jittered particles lies
/// where it does: the smoothing of places draws it inwards. Measured on a pool.
constexpr float kDrawnInwards = 0.40F;

/// A particle as a kernel: its density at x is `height` (1 - |G (x - place)|^2)^3.
struct Kernel {
  Eigen::Vector3f place = Eigen::Vector3f::Zero();
  Eigen::Matrix3f G = Eigen::Matrix3f::Zero();  ///< 1/m; the kernel ends where |G y| = 1
  float height = 0;
};

/// Particles of a full cell: the mean over cells with particles whose six neighbours have some too,
/// or over all cells with particles.
double particles_of_full_cell(const GridShape& shape, const LiquidParticles& particles) {
  const auto& begin = particles.cell_begin;
  const auto count = [&](int i, int j, int k) {
    const std::size_t c = shape.index(i, j, k);
    return begin[c + 1] - begin[c];
  };
  double inner = 0, inner_cells = 0, all_cells = 0;
  for (int k = 0; k < shape.cells.z(); ++k)
    for (int j = 0; j < shape.cells.y(); ++j)
      for (int i = 0; i < shape.cells.x(); ++i) {
        if (count(i, j, k) == 0) continue;
        all_cells += 1;
        if (i == 0 || j == 0 || k == 0 || i + 1 == shape.cells.x() || j + 1 == shape.cells.y() ||
            k + 1 == shape.cells.z())
          continue;
        if (!count(i - 1, j, k) || !count(i + 1, j, k) || !count(i, j - 1, k) ||
            !count(i, j + 1, k) || !count(i, j, k - 1) || !count(i, j, k + 1))
          continue;
        inner += count(i, j, k);
        inner_cells += 1;
      }
  if (inner_cells > 0) return inner / inner_cells;
  return all_cells > 0 ? static_cast<double>(particles.size()) / all_cells : 1;
}

/// Calls `body(begin, end)` for the ranges of particles of the cells within reach of a place given
/// in cells.
template <class Body>
void for_ranges(const GridShape& shape, const LiquidParticles& particles,
                const Eigen::Vector3d& cells, double reach, const Body& body) {
  const CellRange x = cells_in_reach(cells.x(), reach, shape.cells.x()),
                  y = cells_in_reach(cells.y(), reach, shape.cells.y()),
                  z = cells_in_reach(cells.z(), reach, shape.cells.z());
  for (int k = z.begin; k < z.end; ++k)
    for (int j = y.begin; j < y.end; ++j)
      body(particles.cell_begin[shape.index(0, j, k) + static_cast<std::size_t>(x.begin)],
           particles.cell_begin[shape.index(0, j, k) + static_cast<std::size_t>(x.end)]);
}

/// Mean and covariance of the neighbours of a particle with the weights 1 - (r / R)^3.
struct Neighbourhood {
  float weight = 0;
  int count = 0;
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();        ///< from the particle
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();  ///< about the mean
};

Neighbourhood neighbourhood(const GridShape& shape, const LiquidParticles& particles, std::size_t p,
                            float radius) {
  Neighbourhood result;
  const Eigen::Vector3f x = particles.position[p];
  const float square = radius * radius;
  for_ranges(shape, particles, x.cast<double>() / shape.cell,
             static_cast<double>(radius) / shape.cell, [&](std::size_t begin, std::size_t end) {
               for (std::size_t q = begin; q < end; ++q) {
                 const Eigen::Vector3f y = particles.position[q] - x;
                 const float s = y.squaredNorm() / square;
                 if (s >= 1) continue;
                 const float w = 1 - s * std::sqrt(s);
                 result.weight += w;
                 result.mean += w * y;
                 result.covariance += w * y * y.transpose();
                 ++result.count;
               }
             });
  result.mean /= result.weight;  // the particle itself weighs 1
  result.covariance = result.covariance / result.weight - result.mean * result.mean.transpose();
  return result;
}

Kernel kernel_of(const Neighbourhood& around, const Eigen::Vector3f& x, float radius,
                 float ball_height) {
  Kernel kernel{x + kSmoothing * around.mean, {}, 0};
  Eigen::Vector3f size = Eigen::Vector3f::Constant(kLonelySize);
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();
  if (around.count >= kFewestNeighbours) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
    eigen.computeDirect(around.covariance / (kBallVariance * radius * radius));
    axes = eigen.eigenvectors();
    const float largest = std::clamp(eigen.eigenvalues().maxCoeff(), 0.1F, 1.0F);
    size = eigen.eigenvalues().cwiseMax(largest / kLargestRatio).cwiseMin(1);
  }
  kernel.G = axes * size.cwiseInverse().asDiagonal() * axes.transpose() / radius;
  kernel.height = ball_height / size.prod();
  return kernel;
}

/// Kernels of all particles; those whose neighbours fill the kernel's reach are balls in place.
std::vector<Kernel> make_kernels(const GridShape& shape, const LiquidParticles& particles,
                                 float radius) {
  const double volume =
      std::pow(shape.cell, 3) / particles_of_full_cell(shape, particles);  // of a particle
  const auto ball_height =
      static_cast<float>(volume * 315 / (64 * std::numbers::pi * std::pow(radius, 3)));
  const double reach = static_cast<double>(radius) / shape.cell;
  // Seen from the cells' lower corners; a cell further covers the particles inside.
  const auto around = node_surroundings(shape, particles, shape, reach + 1);
  const Eigen::Matrix3f ball = Eigen::Matrix3f::Identity() / radius;
  std::vector<Kernel> kernels(particles.size());
  const auto nx = static_cast<std::size_t>(shape.cells.x()),
             ny = static_cast<std::size_t>(shape.cells.y());
  parallel_blocks(shape.cell_count(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const std::size_t i = c % nx, j = c / nx % ny, k = c / (nx * ny);
      const bool full = around[i + (nx + 1) * (j + (ny + 1) * k)] == NodeSurroundings::full;
      for (std::size_t p = particles.cell_begin[c]; p < particles.cell_begin[c + 1]; ++p)
        kernels[p] = full ? Kernel{particles.position[p], ball, ball_height}
                          : kernel_of(neighbourhood(shape, particles, p, radius),
                                      particles.position[p], radius, ball_height);
    }
  });
  return kernels;
}

}  // namespace

ScalarGrid anisotropic_field(const GridShape& shape, const LiquidParticles& particles,
                             const LiquidSurfaceOptions& options, const GridShape& field_shape) {
  const double reach = options.kernel_radius * options.particle_radius;  // in cells
  const auto radius = static_cast<float>(reach * shape.cell);
  // Smoothing moves a place by up to 0.4 R towards the liquid.
  const double wider = 1.4 * reach;
  const std::vector<Kernel> kernels = make_kernels(shape, particles, radius);
  const auto around = node_surroundings(shape, particles, field_shape, reach);
  const FlatSurfaceProfile profile(FlatSurfaceProfile::Measure::density);
  ScalarGrid field(field_shape.cells + Eigen::Vector3i::Ones(), radius * (1 - kDrawnInwards));
  const auto node_value = [&](const Eigen::Vector3d& x) {
    float density = 0;
    const Eigen::Vector3f at = x.cast<float>();
    for_ranges(shape, particles, x / shape.cell, wider, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) {
        const Eigen::Vector3f y = at - kernels[p].place;
        if (y.squaredNorm() >= radius * radius) continue;
        const float s = 1 - (kernels[p].G * y).squaredNorm();
        if (s > 0) density += kernels[p].height * s * s * s;
      }
    });
    return radius * (profile.distance(density) - kDrawnInwards);
  };
  const float inside = -radius * (FlatSurfaceProfile::kDeepest + kDrawnInwards);
  const auto rows = static_cast<std::size_t>(field.size.y());
  parallel_blocks(rows * static_cast<std::size_t>(field.size.z()), 16,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t w = begin; w < end; ++w) {
                      const auto j = static_cast<int>(w % rows), k = static_cast<int>(w / rows);
                      for (int i = 0; i < field.size.x(); ++i) {
                        const std::size_t n = field.index(i, j, k);
                        if (around[n] == NodeSurroundings::full) field.values[n] = inside;
                        if (around[n] == NodeSurroundings::mixed)
                          field.values[n] = node_value(field_shape.cell * Eigen::Vector3d(i, j, k));
                      }
                    }
                  });
  return field;
}

}  // namespace geoprior
