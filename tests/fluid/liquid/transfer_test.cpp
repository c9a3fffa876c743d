#include "baselines/fluid/liquid/particles/transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"
#include "core/parallel.h"
#include "tests/fluid/liquid/fixture.h"

namespace geoprior::fluid {
namespace {

using tanks::grid_of;
using tanks::momentum;
using tanks::scattered;

constexpr double kCell = 0.1;

/// Particles to grid and back.
struct RoundTrip {
  GridShape shape;
  MacGrid grid;
  std::array<std::vector<char>, 3> touched;
  ScalarGrid density;
  explicit RoundTrip(const GridShape& s) : shape(s), grid(s) {}
  void run(LiquidParticles& particles, bool affine) {
    if (affine && particles.affine.empty())
      particles.affine.assign(particles.size(), Eigen::Matrix3f::Zero());
    sort_by_cell(shape, particles);
    ParticleToGrid(shape).gather(particles, 8, grid, touched, density);
    grid_to_particles(grid, 0, affine, particles);
  }
};

/// The kernel of the header by its definition, for component a of the velocity (a = 3: the cell
/// centres): hats between the samples of each axis, clamped to the first and last.
struct Kernel {
  GridShape shape;
  int component;

  [[nodiscard]] Eigen::Vector3i samples() const {
    return component < 3 ? shape.face_cells(component) : shape.cells;
  }
  /// Sample i of axis b (m).
  [[nodiscard]] double place(int b, int i) const {
    return shape.cell * (b == component ? i : i + 0.5);
  }
  [[nodiscard]] double hat(int b, int i, double x) const {
    const double clamped = std::clamp(x, place(b, 0), place(b, samples()[b] - 1));
    return std::max(0.0, 1 - std::abs(clamped - place(b, i)) / shape.cell);
  }
  [[nodiscard]] double hat_slope(int b, int i, double x) const {
    if (x < place(b, 0) || x > place(b, samples()[b] - 1) || hat(b, i, x) == 0) return 0;
    return (x < place(b, i) ? 1 : -1) / shape.cell;
  }
  /// Calls f(sample, N, grad N) for the samples that x reaches.
  template <class Function>
  void for_each(const Eigen::Vector3d& x, const Function& f) const {
    const Eigen::Vector3i n = samples();
    for (int k = 0; k < n.z(); ++k)
      for (int j = 0; j < n.y(); ++j)
        for (int i = 0; i < n.x(); ++i) {
          const Eigen::Vector3d h(hat(0, i, x.x()), hat(1, j, x.y()), hat(2, k, x.z()));
          if (h.prod() == 0) continue;
          const Eigen::Vector3d slope(hat_slope(0, i, x.x()), hat_slope(1, j, x.y()),
                                      hat_slope(2, k, x.z()));
          f(Eigen::Vector3i(i, j, k), h.prod(),
            Eigen::Vector3d(slope.x() * h.y() * h.z(), h.x() * slope.y() * h.z(),
                            h.x() * h.y() * slope.z()));
        }
  }
};

/// m_i and m_i u_i of one component over all its samples, as the header has them.
void sum_particles(const Kernel& kernel, const LiquidParticles& particles,
                   std::vector<double>& mass, std::vector<double>& momentum) {
  const Eigen::Vector3i n = kernel.samples();
  mass.assign(n.prod(), 0);
  momentum = mass;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Eigen::Vector3d x = particles.position[p].cast<double>();
    kernel.for_each(x, [&](const Eigen::Vector3i& at, double weight, const Eigen::Vector3d&) {
      const int i = at.x() + n.x() * (at.y() + n.y() * at.z());
      mass[i] += weight;
      if (kernel.component == 3) return;
      double u = particles.velocity[p][kernel.component];
      if (!particles.affine.empty()) {
        const Eigen::Vector3d xi(kernel.place(0, at.x()), kernel.place(1, at.y()),
                                 kernel.place(2, at.z()));
        u += particles.affine[p].row(kernel.component).cast<double>().dot(xi - x);
      }
      momentum[i] += weight * u;
    });
  }
}

/// Particles all over a small grid, with velocity gradients.
LiquidParticles particles_with_gradients(std::uint64_t seed) {
  LiquidParticles particles = scattered(403, {0, 0, 0}, {0.6, 0.5, 0.7}, seed);
  RandomStream random(seed, "gradients");
  particles.affine.resize(particles.size());
  for (Eigen::Matrix3f& c : particles.affine)
    for (int i = 0; i < 9; ++i) c(i / 3, i % 3) = static_cast<float>(random.normal());
  return particles;
}

std::size_t cell_of(const GridShape& shape, const Eigen::Vector3f& x) {
  const Eigen::Vector3i at = (x / static_cast<float>(shape.cell)).array().floor().cast<int>();
  return shape.index(at.x(), at.y(), at.z());
}

TEST(LiquidSort, ParticlesOfACellStandTogetherInTheOrderTheyCame) {
  const GridShape shape = grid_of({7, 5, 6}, kCell);
  LiquidParticles particles = scattered(3000, {0, 0, 0}, {0.7, 0.5, 0.6}, 1);
  for (std::size_t p = 0; p < particles.size(); ++p)
    particles.velocity[p].x() = static_cast<float>(p);  // the place it came from
  sort_by_cell(shape, particles);
  ASSERT_EQ(particles.cell_begin.size(), shape.cell_count() + 1);
  EXPECT_EQ(particles.cell_begin.back(), 3000U);
  for (std::size_t c = 0; c < shape.cell_count(); ++c) {
    for (std::uint32_t p = particles.cell_begin[c]; p < particles.cell_begin[c + 1]; ++p) {
      EXPECT_EQ(cell_of(shape, particles.position[p]), c);
      if (p == particles.cell_begin[c]) continue;
      EXPECT_LT(particles.velocity[p - 1].x(), particles.velocity[p].x());
    }
  }
}

TEST(LiquidSort, ParticlesOutsideCountToTheNearestCell) {
  const GridShape shape = grid_of({4, 4, 4}, kCell);
  LiquidParticles particles;
  particles.position = {{9, 9, 9}, {-1, -1, -1}};
  particles.velocity.assign(2, Eigen::Vector3f::Zero());
  sort_by_cell(shape, particles);
  EXPECT_EQ(particles.cell_begin[1], 1U);
  EXPECT_EQ(particles.cell_begin[63], 1U);
  EXPECT_EQ(particles.position[1].x(), 9);
}

TEST(LiquidTransfer, TilesSumWhatTheKernelSays) {
  const GridShape shape = grid_of({6, 5, 7}, kCell);
  for (const bool affine : {false, true}) {
    LiquidParticles particles = particles_with_gradients(10);
    if (!affine) particles.affine.clear();
    sort_by_cell(shape, particles);
    MacGrid grid(shape);
    std::array<std::vector<char>, 3> touched;
    ScalarGrid density;
    ParticleToGrid(shape).gather(particles, 8, grid, touched, density);
    std::vector<double> mass, momentum;
    for (int a = 0; a < 3; ++a) {
      sum_particles({shape, a}, particles, mass, momentum);
      for (std::size_t i = 0; i < mass.size(); ++i) {
        if (mass[i] < 1e-3) continue;  // the quotient of the floats is round-off there
        // Sums of up to thirty floats near 1, then their quotient.
        EXPECT_NEAR(grid.face[a].values[i], momentum[i] / mass[i], 1e-5 / std::min(1.0, mass[i]));
        EXPECT_EQ(touched[a][i], 1);
      }
    }
    sum_particles({shape, 3}, particles, mass, momentum);
    for (std::size_t i = 0; i < mass.size(); ++i) EXPECT_NEAR(density.values[i], mass[i] / 8, 1e-6);
  }
}

// Without gradients eight particles are taken at a time (403 leave a last batch of three), with
// them one: both are the sum over the samples.
TEST(LiquidTransfer, ParticlesTakeWhatTheKernelSays) {
  const GridShape shape = grid_of({6, 5, 7}, kCell);
  MacGrid field(shape);
  RandomStream random(11, "field");
  for (ScalarGrid& face : field.face)
    for (float& u : face.values) u = static_cast<float>(random.normal());
  for (const bool affine : {false, true}) {
    const LiquidParticles before = particles_with_gradients(12);
    LiquidParticles after = before;
    grid_to_particles(field, 0.25F, affine, after);
    for (std::size_t p = 0; p < before.size(); ++p) {
      const Eigen::Vector3d x = before.position[p].cast<double>();
      for (int a = 0; a < 3; ++a) {
        double u = 0;
        Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
        Kernel{shape, a}.for_each(
            x, [&](const Eigen::Vector3i& at, double weight, const Eigen::Vector3d& slope) {
              const double here = field.face[a](at.x(), at.y(), at.z());
              u += weight * here;
              gradient += slope * here;
            });
        const double kept = 0.25 * before.velocity[p][a];
        EXPECT_NEAR(after.velocity[p][a], kept + u, 1e-5);
        if (!affine) continue;
        EXPECT_LT((after.affine[p].row(a).transpose().cast<double>() - gradient).norm(), 2e-4);
      }
    }
  }
}

TEST(LiquidTransfer, UniformVelocityIsReproducedEverywhere) {
  RoundTrip trip(grid_of({6, 6, 6}, kCell));
  LiquidParticles particles = scattered(2000, {0, 0, 0}, {0.6, 0.6, 0.6}, 2);
  const Eigen::Vector3f u(1.5F, -2, 0.25F);
  for (Eigen::Vector3f& v : particles.velocity) v = u;
  trip.run(particles, false);
  for (int a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < trip.touched[a].size(); ++i) {
      if (trip.touched[a][i] == 0) continue;
      EXPECT_NEAR(trip.grid.face[a].values[i], u[a], 1e-5);
    }
  }
  for (const Eigen::Vector3f& v : particles.velocity) EXPECT_LT((v - u).norm(), 1e-5F);
}

// The kernel is a partition of unity, folded at walls: nothing of a particle is lost.
TEST(LiquidTransfer, DensitySumsToTheNumberOfParticles) {
  RoundTrip trip(grid_of({6, 5, 4}, kCell));
  LiquidParticles particles = scattered(2000, {0, 0, 0}, {0.6, 0.5, 0.4}, 3);
  trip.run(particles, false);
  double sum = 0;
  for (const float d : trip.density.values) sum += static_cast<double>(d);
  EXPECT_NEAR(sum * 8, 2000, 2e-3);
}

TEST(LiquidTransfer, PicAndApicKeepMomentum) {
  for (const bool affine : {false, true}) {
    RoundTrip trip(grid_of({8, 8, 8}, kCell));
    LiquidParticles particles = scattered(1500, {0.2, 0.2, 0.2}, {0.6, 0.6, 0.6}, 4);
    const Eigen::Vector3d before = momentum(particles);
    const double energy = kinetic_energy(trip.shape, particles);
    trip.run(particles, affine);
    EXPECT_LT((momentum(particles) - before).norm(), 1e-3) << affine;
    // Unlike energy: velocities of neighbours are averaged.
    EXPECT_LT(kinetic_energy(trip.shape, particles), 0.9 * energy);
  }
}

// Jiang et al. 2015, proposition 5.5: velocity and gradient that the grid gives particles, given
// back to the grid, have its angular momentum. (C of PIC is 0: it keeps less.)
TEST(LiquidTransfer, ApicKeepsTheAngularMomentumOfASpinningBallPicDoesNot) {
  const Eigen::Vector3d centre(0.8, 0.8, 0.8);
  const auto grid_spin = [&](const RoundTrip& trip, const LiquidParticles& particles) {
    // Each particle stands for its share of the mass of the faces around it.
    double spin = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Eigen::Vector3f x = particles.position[p] / static_cast<float>(kCell);
      const CellSample s(x, trip.shape.cells);
      for (int a = 0; a < 2; ++a) {
        const AxisSample &sx = s.along(0, a), &sy = s.along(1, a), &sz = s.along(2, a);
        for (int c = 0; c < 8; ++c) {
          const int dx = c % 2, dy = c / 2 % 2, dz = c / 4;
          const float w = (dx != 0 ? sx.fraction : 1 - sx.fraction) *
                          (dy != 0 ? sy.fraction : 1 - sy.fraction) *
                          (dz != 0 ? sz.fraction : 1 - sz.fraction);
          const Eigen::Vector3d at(sx.low + dx + (a == 0 ? 0 : 0.5),
                                   sy.low + dy + (a == 1 ? 0 : 0.5), 0);
          const double u = trip.grid.face[a](sx.low + dx, sy.low + dy, sz.low + dz);
          const double arm = a == 0 ? -(at.y() * kCell - centre.y()) : at.x() * kCell - centre.x();
          spin += static_cast<double>(w) * arm * u;
        }
      }
    }
    return spin;
  };
  std::array<double, 2> kept{};
  for (const bool affine : {false, true}) {
    LiquidParticles particles;
    for (const LiquidParticles all = scattered(6000, {0.5, 0.5, 0.5}, {1.1, 1.1, 1.1}, 5);
         const Eigen::Vector3f& x : all.position) {
      const Eigen::Vector3d r = x.cast<double>() - centre;
      if (r.norm() > 0.25) continue;
      particles.position.push_back(x);
      particles.velocity.push_back(Eigen::Vector3d(-r.y(), r.x(), 0).cast<float>());
    }
    RoundTrip trip(grid_of({16, 16, 16}, kCell));
    trip.run(particles, affine);
    const double before = grid_spin(trip, particles);
    for (int n = 0; n < 10; ++n) trip.run(particles, affine);
    kept[affine ? 1 : 0] = grid_spin(trip, particles) / before;
  }
  EXPECT_NEAR(kept[1], 1, 1e-4);
  EXPECT_LT(kept[0], 0.7);
}

// C_p = sum u grad N is exact for a linear field, and so is what particles give back.
TEST(LiquidTransfer, ApicReproducesALinearVelocity) {
  RoundTrip trip(grid_of({8, 8, 8}, kCell));
  Eigen::Matrix3f gradient;
  gradient << 1, 2, -1, 0.5F, -2, 3, 4, 0, 1;
  LiquidParticles particles = scattered(3000, {0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}, 6);
  for (std::size_t p = 0; p < particles.size(); ++p)
    particles.velocity[p] = gradient * particles.position[p];
  particles.affine.assign(particles.size(), gradient);
  trip.run(particles, true);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_LT((particles.velocity[p] - gradient * particles.position[p]).norm(), 1e-4F);
    EXPECT_LT((particles.affine[p] - gradient).norm(), 1e-3F);
  }
}

// FLIP with a fraction of 0 adds the change of the grid: no change, no loss.
TEST(LiquidTransfer, KeptVelocityPlusFieldIsTheFlipUpdate) {
  const GridShape shape = grid_of({6, 6, 6}, kCell);
  LiquidParticles particles = scattered(500, {0, 0, 0}, {0.6, 0.6, 0.6}, 7);
  const std::vector<Eigen::Vector3f> before = particles.velocity;
  MacGrid field(shape);
  for (float& u : field.face[2].values) u = -3;
  grid_to_particles(field, 0.5F, false, particles);
  for (std::size_t p = 0; p < before.size(); ++p)
    EXPECT_LT((particles.velocity[p] - (0.5F * before[p] + Eigen::Vector3f(0, 0, -3))).norm(),
              1e-6F);
}

// A face's energy is m_i u_i^2 / 2 when particles agree, as those of a linear field do.
TEST(LiquidTransfer, KineticEnergyIsThatOfTheGridForALinearField) {
  RoundTrip trip(grid_of({8, 8, 8}, kCell));
  LiquidParticles particles = scattered(3000, {0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}, 9);
  Eigen::Matrix3f gradient = Eigen::Matrix3f::Zero();
  gradient(0, 0) = 3;
  gradient(0, 1) = -2;
  for (std::size_t p = 0; p < particles.size(); ++p)
    particles.velocity[p] = gradient * particles.position[p];
  particles.affine.assign(particles.size(), gradient);
  trip.run(particles, true);
  double grid_energy = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Eigen::Vector3f x = particles.position[p] / static_cast<float>(kCell);
    const CellSample s(x, trip.shape.cells);
    for (int c = 0; c < 8; ++c) {
      const std::array<int, 3> d{c % 2, c / 2 % 2, c / 4};
      double w = 1;
      std::array<int, 3> at{};
      for (int b = 0; b < 3; ++b) {
        const AxisSample& along = s.along(b, 0);
        w *= static_cast<double>(d[b] != 0 ? along.fraction : 1 - along.fraction);
        at[b] = along.low + d[b];
      }
      const double u = trip.grid.face[0](at[0], at[1], at[2]);
      grid_energy += 0.5 * w * u * u;
    }
  }
  EXPECT_NEAR(kinetic_energy(trip.shape, particles) / grid_energy, 1, 1e-4);
}

TEST(LiquidTransfer, SameBytesWithOneAndTwoThreads) {
  std::array<RoundTrip, 2> trip{RoundTrip(grid_of({20, 20, 20}, kCell)),
                                RoundTrip(grid_of({20, 20, 20}, kCell))};
  std::array<LiquidParticles, 2> particles;
  for (int t = 0; t < 2; ++t) {
    const std::size_t i = t;
    particles[i] = scattered(60000, {0, 0, 0}, {2, 2, 2}, 8);
    with_threads(t + 1, [&] { trip[i].run(particles[i], true); });
  }
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_EQ(trip[0].grid.face[a].values, trip[1].grid.face[a].values);
  EXPECT_EQ(trip[0].density.values, trip[1].density.values);
  EXPECT_EQ(0, std::memcmp(particles[0].affine.data(), particles[1].affine.data(),
                           particles[0].size() * sizeof(Eigen::Matrix3f)));
}

}  // namespace
}  // namespace geoprior::fluid
