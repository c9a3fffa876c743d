#include "solvers/skinning/projection/relaxation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/planar.h"
#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

constexpr std::size_t kRelaxedBlocksPerTask = 8;

Eigen::Vector3d to_vector(Float4 v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Mean-value coordinates of the origin in a polygon in the plane; false unless star-shaped.
bool mean_value_coordinates(const std::vector<Eigen::Vector2d>& ring, std::vector<double>& weight) {
  const std::size_t n = ring.size();
  std::vector<double> half_tangent(n);
  double turn = 0;
  for (std::size_t j = 0; j < n; ++j) {
    const Eigen::Vector2d& a = ring[j];
    const Eigen::Vector2d& b = ring[(j + 1) % n];
    const double angle = signed_angle(a, b);
    if (!(angle > 1e-6) || angle > std::numbers::pi - 1e-3) return false;
    turn += angle;
    half_tangent[j] = std::tan(angle / 2);
  }
  if (std::abs(turn - 2 * std::numbers::pi) > 1e-6) return false;
  weight.resize(n);
  double sum = 0;
  for (std::size_t j = 0; j < n; ++j) {
    weight[j] = (half_tangent[(j + n - 1) % n] + half_tangent[j]) / ring[j].norm();
    sum += weight[j];
  }
  for (double& w : weight) w /= sum;
  return true;
}

void prepare_vertex(SkinState& state, std::size_t s) {
  const std::size_t begin = state.ring_offset[s];
  const std::size_t end = state.ring_offset[s + 1];
  const Eigen::Vector3d inward = to_vector(state.gradient[s]);
  if (end - begin < 3 || !(inward.norm() > 0)) return;
  const Eigen::Vector3d normal = -inward.normalized();
  const Eigen::Vector3d x = normal.unitOrthogonal();
  const Eigen::Vector3d y = normal.cross(x);
  std::vector<Eigen::Vector2d> ring;
  for (std::size_t j = begin; j < end; ++j) {
    const Eigen::Vector3d d = to_vector(state.position[state.ring[j]] - state.position[s]);
    ring.emplace_back(d.dot(x), d.dot(y));
  }
  std::vector<double> weight;
  if (!mean_value_coordinates(ring, weight)) return;
  for (std::size_t j = begin; j < end; ++j) {
    state.ring_weight[j] = static_cast<float>(weight[j - begin]);
  }
}

float relaxation_share(RelaxationLaw law, float error) {
  const float e = std::min(1.0F, std::abs(error));
  if (law == RelaxationLaw::paper) {
    const float rest = (1 - e) * (1 - e);
    return std::max(0.0F, 1 - rest * rest);
  }
  const float rest = 1 - std::min(1.0F, 2 * e);
  return 0.5F * (1 - rest * rest);
}

void relax_vertex(SkinState& state, std::size_t s, RelaxationLaw law) {
  const Float4 p = state.position[s];
  const Float4 gradient = state.gradient[s];
  const float slope2 = dot3(gradient, gradient);
  state.next[s] = p;
  if (!(slope2 > 0)) return;
  Float4 mean{};
  for (int j = state.ring_offset[s]; j < state.ring_offset[s + 1]; ++j) {
    mean += splat(state.ring_weight[j]) * (state.position[state.ring[j]] - p);
  }
  const Float4 tangential = mean - xyz(gradient) * splat(dot3(mean, gradient) / slope2);
  state.next[s] = p + tangential * splat(relaxation_share(law, gradient[3]));
}

template <class Body>
void for_active(SkinState& state, const Body& body) {
  parallel_blocks(state.live_blocks.size(), kRelaxedBlocksPerTask,
                  [&body](std::size_t begin, std::size_t end) { body(begin, end); });
}

}  // namespace

void prepare_relaxation(SkinState& state) {
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (state.owner[s] >= 0) prepare_vertex(state, s);
  }
}

void relax(SkinState& state, RelaxationLaw law) {
  const auto each_active = [&state](std::size_t begin, std::size_t end, const auto& visit) {
    for (std::size_t b = begin; b < end; ++b) {
      const std::size_t block = state.live_blocks[b];
      const std::size_t first = block * SkinState::kBlock;
      const std::size_t last = first + state.active_count[block];
      for (std::size_t i = first; i < last; ++i) visit(static_cast<std::size_t>(state.active[i]));
    }
  };
  for_active(state, [&](std::size_t begin, std::size_t end) {
    each_active(begin, end, [&](std::size_t s) { relax_vertex(state, s, law); });
  });
  for_active(state, [&](std::size_t begin, std::size_t end) {
    each_active(begin, end, [&](std::size_t s) { state.position[s] = state.next[s]; });
  });
}

}  // namespace geoprior::skinning
