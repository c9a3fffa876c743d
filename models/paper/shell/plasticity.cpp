#include "models/paper/shell/plasticity.h"

#include <atomic>
#include <cmath>

#include "core/parallel.h"

namespace geoprior::paper {

double curvature_norm(const Eigen::Vector3d& s) {
  return std::sqrt(s[0] * s[0] + 2 * s[1] * s[1] + s[2] * s[2]);
}

int flow_plastically(const ShellElements& elements, double yield_curvature, ShellState& state) {
  std::atomic<int> yielded{0};
  constexpr std::size_t kBlock = 256;
  const std::size_t count = elements.size();
  parallel_blocks(count, kBlock, [&](std::size_t begin, std::size_t end) {
    for (auto e = static_cast<int>(begin); e < static_cast<int>(end); ++e) {
      const Eigen::Vector3d elastic = elements.elastic_curvature(e, state, state.x);
      const double norm = curvature_norm(elastic);
      if (!(norm > yield_curvature)) continue;
      state.plastic_curvature.row(e) += (1 - yield_curvature / norm) * elastic.transpose();
      state.damage[e] += norm / yield_curvature - 1;
      yielded.fetch_add(1, std::memory_order_relaxed);
    }
  });
  return yielded;
}

}  // namespace geoprior::paper
