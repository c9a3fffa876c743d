#include "baselines/fluid/liquid/surface/kernels.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr int kSteps = 1024;  ///< of the table

/// Integral of (1 - z^2)^4 from -1 to x: the kernel's mass on one side of a plane, up to a factor.
double mass_below(double x) {
  const double x2 = x * x;
  const double odd = x * (1 + x2 * (-4.0 / 3 + x2 * (6.0 / 5 + x2 * (-4.0 / 7 + x2 / 9))));
  return odd + 128.0 / 315;
}

/// What is measured at the distance -x from the surface (inside for x > 0).
double measured_at(FlatSurfaceProfile::Measure measure, double x) {
  const double mass = mass_below(x);
  if (measure == FlatSurfaceProfile::Measure::density) return mass / mass_below(1);
  // The first moment of (1 - z^2)^4 is -(1 - x^2)^5 / 10.
  return mass > 1e-15 ? std::pow(1 - x * x, 5) / (10 * mass) : 1;
}

}  // namespace

FlatSurfaceProfile::FlatSurfaceProfile(Measure measure) : distance_(kSteps + 1) {
  const double rises = measure == Measure::density ? 1 : -1;
  for (int s = 0; s <= kSteps; ++s) {
    const double wanted = static_cast<double>(s) / kSteps;
    double low = -1, high = 1;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (rises * (measured_at(measure, middle) - wanted) < 0 ? low : high) = middle;
    }
    distance_[s] = std::max(static_cast<float>(-0.5 * (low + high)), -kDeepest);
  }
}

float FlatSurfaceProfile::distance(float measured) const {
  const float at = std::clamp(measured, 0.0F, 1.0F) * kSteps;
  const int step = std::min(static_cast<int>(at), kSteps - 1);
  const float t = at - static_cast<float>(step);
  const std::size_t i = step;
  return distance_[i] + t * (distance_[i + 1] - distance_[i]);
}

namespace {

constexpr std::uint8_t kSomeFull = 1, kSomeEmpty = 2;

using Bits = std::vector<std::uint8_t>;

/// Replaces one axis of cells by nodes: each gathers the bits of the cells within reach.
/// `inner` and `outer` count the entries before and after that axis.
Bits gather_axis(const Bits& cells, std::size_t inner, int cell_count, std::size_t outer,
                 int node_count, double cells_per_node, double reach) {
  Bits nodes(inner * node_count * outer, 0);
  const auto work = outer * node_count;
  parallel_blocks(work, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const std::size_t o = w / node_count;
      const auto n = static_cast<int>(w % node_count);
      const CellRange range = cells_in_reach(n * cells_per_node, reach, cell_count);
      std::uint8_t* to = nodes.data() + w * inner;
      for (int c = range.begin; c < range.end; ++c) {
        const std::uint8_t* from =
            cells.data() + (o * cell_count + static_cast<std::size_t>(c)) * inner;
        for (std::size_t i = 0; i < inner; ++i) to[i] = static_cast<std::uint8_t>(to[i] | from[i]);
      }
    }
  });
  return nodes;
}

}  // namespace

CellRange cells_in_reach(double place, double reach, int cells) {
  const auto begin = static_cast<int>(std::floor(place - reach));
  const auto end = static_cast<int>(std::ceil(place + reach));
  return {std::clamp(begin, 0, cells), std::clamp(end, 0, cells)};
}

std::vector<NodeSurroundings> node_surroundings(const GridShape& shape,
                                                const LiquidParticles& particles,
                                                const GridShape& field_shape, double reach) {
  Bits bits(shape.cell_count());
  parallel_blocks(bits.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      bits[c] = particles.cell_begin[c + 1] > particles.cell_begin[c] ? kSomeFull : kSomeEmpty;
  });
  const double step = field_shape.cell / shape.cell;
  std::size_t inner = 1;
  for (int a = 0; a < 3; ++a) {
    std::size_t outer = 1;
    for (int b = a + 1; b < 3; ++b) outer *= static_cast<std::size_t>(shape.cells[b]);
    const int nodes = field_shape.cells[a] + 1;
    bits = gather_axis(bits, inner, shape.cells[a], outer, nodes, step, reach);
    inner *= static_cast<std::size_t>(nodes);
  }
  std::vector<NodeSurroundings> result(bits.size());
  std::transform(bits.begin(), bits.end(), result.begin(), [](std::uint8_t b) {
    return b == kSomeFull                  ? NodeSurroundings::full
           : b == (kSomeFull | kSomeEmpty) ? NodeSurroundings::mixed
                                           : NodeSurroundings::empty;
  });
  return result;
}

namespace {

constexpr std::size_t kLanes = 8;
constexpr float kLowEigenvalue = 0.4F, kHighEigenvalue = 3.5F;  ///< Solenthaler et al. 2007

using Lanes = std::array<float, kLanes>;

/// Coordinates apart, so that eight particles are read at once; padded by one group.
struct ParticlePlaces {
  std::array<std::vector<float>, 3> x;
};

ParticlePlaces split(const LiquidParticles& particles) {
  ParticlePlaces places;
  for (auto& x : places.x) x.resize(particles.size() + kLanes, 0);
  parallel_blocks(particles.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t a = 0; a < 3; ++a) places.x[a][p] = particles.position[p][a];
  });
  return places;
}

/// Weighted sums over the particles around a node; y_i = x_i - x, s = |y|^2 / R^2,
/// k = (1 - s)^3, g = (1 - s)^2.
struct Sums {
  Lanes weight{};                 ///< k
  std::array<Lanes, 3> mean{};    ///< k y
  std::array<Lanes, 3> slope{};   ///< g y
  std::array<Lanes, 6> moment{};  ///< g y y^T: xx, yy, zz, xy, xz, yz

  /// Adds particles [begin, end); `unit` = 1 / R.
  void add(const ParticlePlaces& places, const std::array<float, 3>& node, float unit,
           std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; p += kLanes) {
      const float* px = places.x[0].data() + p;
      const float* py = places.x[1].data() + p;
      const float* pz = places.x[2].data() + p;
      const std::size_t here = end - p;
      for (std::size_t l = 0; l < kLanes; ++l) {
        const float x = (px[l] - node[0]) * unit, y = (py[l] - node[1]) * unit,
                    z = (pz[l] - node[2]) * unit;
        const float s = 1 - (x * x + y * y + z * z);
        const float q = l < here && s > 0 ? s : 0.0F;
        const float g = q * q, k = g * q;
        weight[l] += k;
        mean[0][l] += k * x;
        mean[1][l] += k * y;
        mean[2][l] += k * z;
        const float gx = g * x, gy = g * y, gz = g * z;
        slope[0][l] += gx;
        slope[1][l] += gy;
        slope[2][l] += gz;
        moment[0][l] += gx * x;
        moment[1][l] += gy * y;
        moment[2][l] += gz * z;
        moment[3][l] += gx * y;
        moment[4][l] += gx * z;
        moment[5][l] += gy * z;
      }
    }
  }
};

float total(const Lanes& l) {
  return ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
}

/// Largest eigenvalue of a symmetric matrix (trigonometric form, Smith 1961).
float largest_eigenvalue(const Eigen::Matrix3f& m) {
  const float mean = m.trace() / 3;
  const Eigen::Matrix3f b = m - mean * Eigen::Matrix3f::Identity();
  const float p2 = b.squaredNorm() / 6;
  if (!(p2 > 1e-12F)) return mean;
  const float p = std::sqrt(p2);
  const float r = std::clamp(b.determinant() / (2 * p2 * p), -1.0F, 1.0F);
  return mean + 2 * p * std::cos(std::acos(r) / 3);
}

/// Share of r_p that is left where the mean place moves faster than the node: 1 up to an eigenvalue
/// of 0.4.
float radius_share(float eigenvalue) {
  if (eigenvalue <= kLowEigenvalue) return 1;
  const float gamma =
      std::max((kHighEigenvalue - eigenvalue) / (kHighEigenvalue - kLowEigenvalue), 0.0F);
  return gamma * (gamma * (gamma - 3) + 3);
}

/// |x - xbar| - r_p over R from the sums, plus r = r_p / R where r_p did not shrink.
float mean_offset(const Sums& sums, float r) {
  const float weight = total(sums.weight);
  if (!(weight > 1e-12F)) return 1;
  Eigen::Vector3f mean, slope;
  Eigen::Matrix3f moment;
  for (int a = 0; a < 3; ++a) {
    mean[a] = total(sums.mean[a]) / weight;
    slope[a] = total(sums.slope[a]);
    moment(a, a) = total(sums.moment[a]);
  }
  moment(0, 1) = moment(1, 0) = total(sums.moment[3]);
  moment(0, 2) = moment(2, 0) = total(sums.moment[4]);
  moment(1, 2) = moment(2, 1) = total(sums.moment[5]);
  // grad xbar = 6 / W sum of (y_i - ybar) g y_i^T in units of R; its symmetric part.
  const Eigen::Matrix3f gradient =
      6 / weight * (moment - 0.5F * (mean * slope.transpose() + slope * mean.transpose()));
  return mean.norm() + r * (1 - radius_share(largest_eigenvalue(gradient)));
}

}  // namespace

ScalarGrid zhu_bridson_field(const GridShape& shape, const LiquidParticles& particles,
                             const LiquidSurfaceOptions& options, const GridShape& field_shape) {
  const double reach = options.kernel_radius * options.particle_radius;  // in cells
  const auto radius = static_cast<float>(reach * shape.cell);
  const auto r = static_cast<float>(1 / options.kernel_radius);
  const auto around = node_surroundings(shape, particles, field_shape, reach);
  const ParticlePlaces places = split(particles);
  const FlatSurfaceProfile profile(FlatSurfaceProfile::Measure::mean_offset);
  const float at_surface = profile.distance(r);
  ScalarGrid field(field_shape.cells + Eigen::Vector3i::Ones(), radius * (1 - at_surface));
  const double step = field_shape.cell / shape.cell;
  const auto node_value = [&](int i, const CellRange& rows, const CellRange& layers, int j, int k) {
    const CellRange columns = cells_in_reach(i * step, reach, shape.cells.x());
    const std::array<float, 3> node{static_cast<float>(i * field_shape.cell),
                                    static_cast<float>(j * field_shape.cell),
                                    static_cast<float>(k * field_shape.cell)};
    Sums sums;
    for (int z = layers.begin; z < layers.end; ++z)
      for (int y = rows.begin; y < rows.end; ++y) {
        // The cells of a row are neighbours in memory, and so are their particles.
        const std::size_t row = shape.index(0, y, z);
        sums.add(places, node, 1 / radius, particles.cell_begin[row + columns.begin],
                 particles.cell_begin[row + columns.end]);
      }
    return radius * (profile.distance(mean_offset(sums, r)) - at_surface);
  };
  const float inside = radius * (profile.distance(0) - at_surface);
  const std::size_t rows = field.size.y();
  parallel_blocks(rows * field.size.z(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const auto j = static_cast<int>(w % rows), k = static_cast<int>(w / rows);
      const CellRange y = cells_in_reach(j * step, reach, shape.cells.y()),
                      z = cells_in_reach(k * step, reach, shape.cells.z());
      for (int i = 0; i < field.size.x(); ++i) {
        const std::size_t n = field.index(i, j, k);
        if (around[n] == NodeSurroundings::full) field.values[n] = inside;
        if (around[n] == NodeSurroundings::mixed) field.values[n] = node_value(i, y, z, j, k);
      }
    }
  });
  return field;
}

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
  const std::size_t nx = shape.cells.x(), ny = shape.cells.y();
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
  const std::size_t rows = field.size.y();
  parallel_blocks(rows * field.size.z(), 16, [&](std::size_t begin, std::size_t end) {
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

}  // namespace geoprior::fluid
