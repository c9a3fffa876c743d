#include "baselines/fluid/liquid/grid/advection.h"

#include <algorithm>

#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"
#include "baselines/fluid/liquid/grid/velocity_batch.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kMovedBlock = 4096;
/// Distance from walls and solids that particles keep (cells): enough for round-off.
constexpr float kClearance = 1e-3F;

/// New places after `step` = dt / h, all lengths in cells.
void runge_kutta(const BatchSampler& velocity, float step, BatchPoints& x) {
  BatchPoints k1, k2, k3, at;
  velocity.sample(x, k1);
  for (int a = 0; a < 3; ++a) at.x[a] = x.x[a] + 0.5F * step * k1.x[a];
  velocity.sample(at, k2);
  for (int a = 0; a < 3; ++a) at.x[a] = x.x[a] + 0.75F * step * k2.x[a];
  velocity.sample(at, k3);
  for (int a = 0; a < 3; ++a)
    x.x[a] += (step / 9) * (2.0F * k1.x[a] + 3.0F * k2.x[a] + 4.0F * k3.x[a]);
}

/// Out of solids: along the gradient as far as the distance says; twice, because the distance is
/// linear only near its samples.
Eigen::Vector3f push_out(const GridSampler& distance, float per_metre, Eigen::Vector3f x) {
  for (int pass = 0; pass < 2; ++pass) {
    const float d = distance(x) * per_metre;
    if (d >= kClearance) break;
    Eigen::Vector3f gradient;
    distance.with_gradient(x, gradient);
    const float length = gradient.norm();
    if (!(length * per_metre > 1e-4F)) break;
    x += (kClearance - d) / length * gradient;
  }
  return x;
}

/// Into the domain; true when the place is beyond the open side.
bool keep_inside(const Eigen::Vector3i& cells, const std::optional<OpenSide>& open,
                 Eigen::Vector3f& x) {
  if (open) {
    const float at = x[open->axis];
    if (open->upper ? at > static_cast<float>(cells[open->axis]) : at < 0) return true;
  }
  for (int a = 0; a < 3; ++a) {
    x[a] = std::clamp(x[a], kClearance, static_cast<float>(cells[a]) - kClearance);
  }
  return false;
}

}  // namespace

void advect_particles(const MacGrid& velocity, double dt, const ScalarGrid* solids,
                      const std::optional<OpenSide>& open, LiquidParticles& particles,
                      std::vector<std::uint8_t>& left) {
  const BatchSampler sampler(velocity);
  const std::optional<GridSampler> distance =
      solids != nullptr ? std::optional<GridSampler>(*solids) : std::nullopt;
  const auto cell = static_cast<float>(velocity.shape.cell);
  const auto per_metre = static_cast<float>(1 / velocity.shape.cell);
  const auto step = static_cast<float>(dt / velocity.shape.cell);
  const Eigen::Vector3i cells = velocity.shape.cells;
  left.assign(particles.size(), 0);
  parallel_blocks(particles.size(), kMovedBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin; first < end; first += kBatch) {
      BatchPoints batch;
      load_batch(particles.position, first, end, per_metre, batch);
      runge_kutta(sampler, step, batch);
      for (std::size_t p = first; p < std::min(first + kBatch, end); ++p) {
        const std::size_t l = p - first;
        Eigen::Vector3f x(batch.x[0][l], batch.x[1][l], batch.x[2][l]);
        left[p] = keep_inside(cells, open, x) ? 1 : 0;
        if (left[p] == 0 && distance) {
          x = push_out(*distance, per_metre, x);
          left[p] = keep_inside(cells, open, x) ? 1 : 0;
        }
        particles.position[p] = x * cell;
      }
    }
  });
}

}  // namespace geoprior::fluid
