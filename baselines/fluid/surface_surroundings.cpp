#include <algorithm>
#include <cmath>

#include "baselines/fluid/surface_kernels.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

constexpr std::uint8_t kSomeFull = 1, kSomeEmpty = 2;

using Bits = std::vector<std::uint8_t>;

/// Replaces one axis of cells by nodes: each gathers the bits of the cells within reach.
/// `inner` and `outer` count the entries before and after that axis.
Bits gather_axis(const Bits& cells, std::size_t inner, int cell_count, std::size_t outer,
                 int node_count, double cells_per_node, double reach) {
  Bits nodes(inner * static_cast<std::size_t>(node_count) * outer, 0);
  const auto work = outer * static_cast<std::size_t>(node_count);
  parallel_blocks(work, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const std::size_t o = w / static_cast<std::size_t>(node_count);
      const auto n = static_cast<int>(w % static_cast<std::size_t>(node_count));
      const CellRange range = cells_in_reach(n * cells_per_node, reach, cell_count);
      std::uint8_t* to = nodes.data() + w * inner;
      for (int c = range.begin; c < range.end; ++c) {
        const std::uint8_t* from =
            cells.data() +
            (o * static_cast<std::size_t>(cell_count) + static_cast<std::size_t>(c)) * inner;
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

}  // namespace geoprior
