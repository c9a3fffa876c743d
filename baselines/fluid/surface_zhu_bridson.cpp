#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "baselines/fluid/surface_kernels.h"
#include "core/parallel.h"

namespace geoprior {
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
      for (std::size_t a = 0; a < 3; ++a)
        places.x[a][p] = particles.position[p][static_cast<Eigen::Index>(a)];
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
    mean[a] = total(sums.mean[static_cast<std::size_t>(a)]) / weight;
    slope[a] = total(sums.slope[static_cast<std::size_t>(a)]);
    moment(a, a) = total(sums.moment[static_cast<std::size_t>(a)]);
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
        sums.add(places, node, 1 / radius,
                 particles.cell_begin[row + static_cast<std::size_t>(columns.begin)],
                 particles.cell_begin[row + static_cast<std::size_t>(columns.end)]);
      }
    return radius * (profile.distance(mean_offset(sums, r)) - at_surface);
  };
  const float inside = radius * (profile.distance(0) - at_surface);
  const auto rows = static_cast<std::size_t>(field.size.y());
  parallel_blocks(rows * static_cast<std::size_t>(field.size.z()), 16,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t w = begin; w < end; ++w) {
                      const auto j = static_cast<int>(w % rows), k = static_cast<int>(w / rows);
                      const CellRange y = cells_in_reach(j * step, reach, shape.cells.y()),
                                      z = cells_in_reach(k * step, reach, shape.cells.z());
                      for (int i = 0; i < field.size.x(); ++i) {
                        const std::size_t n = field.index(i, j, k);
                        if (around[n] == NodeSurroundings::full) field.values[n] = inside;
                        if (around[n] == NodeSurroundings::mixed)
                          field.values[n] = node_value(i, y, z, j, k);
                      }
                    }
                  });
  return field;
}

}  // namespace geoprior
