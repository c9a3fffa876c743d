#include "models/paper/shell/system.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"

namespace geoprior::paper {
namespace {

/// Elements of a chunk: long enough to outweigh starting a task (microseconds), short enough to
/// share a sheet of a few hundred triangles between cores.
constexpr int kChunk = 32;

}  // namespace

ShellSystem::ShellSystem(const ShellElements& elements, std::vector<int> position,
                         const BlockMatrix& matrix)
    : position_(std::move(position)) {
  sort_elements(elements);
  colour_chunks(elements, matrix.nodes());
  find_targets(elements, matrix);
  chunk_energy_.resize(chunks_.size());
}

void ShellSystem::sort_elements(const ShellElements& elements) {
  std::vector<std::pair<int, int>> keyed(elements.size());
  for (int e = 0; e < elements.size(); ++e) {
    int lowest = static_cast<int>(position_.size());
    for (const int node : elements.nodes(e)) lowest = std::min(lowest, position_[node]);
    keyed[e] = {lowest, e};
  }
  std::sort(keyed.begin(), keyed.end());
  order_.clear();
  for (const auto& [key, e] : keyed) order_.push_back(e);
}

void ShellSystem::colour_chunks(const ShellElements& elements, int vertices) {
  std::vector<std::uint64_t> used(vertices, 0);  // colours at a vertex
  std::vector<std::vector<Chunk>> by_colour;
  for (int begin = 0; begin < elements.size(); begin += kChunk) {
    const Chunk chunk{begin, std::min(elements.size(), begin + kChunk)};
    std::uint64_t taken = 0;
    for (int i = chunk.begin; i < chunk.end; ++i) {
      for (const int node : elements.nodes(order_[i])) taken |= used[node];
    }
    std::size_t colour = 0;
    while (colour < 63 && ((taken >> colour) & 1U) != 0) ++colour;
    // Beyond the last colour every chunk is a colour of its own: slow, never wrong.
    if (colour == 63) colour = std::max<std::size_t>(63, by_colour.size());
    if (by_colour.size() <= colour) by_colour.resize(colour + 1);
    by_colour[colour].push_back(chunk);
    for (int i = chunk.begin; i < chunk.end && colour < 63; ++i) {
      for (const int node : elements.nodes(order_[i])) {
        used[node] |= std::uint64_t{1} << colour;
      }
    }
  }
  colours_.assign(1, 0);
  for (const std::vector<Chunk>& chunks : by_colour) {
    chunks_.insert(chunks_.end(), chunks.begin(), chunks.end());
    colours_.push_back(static_cast<int>(chunks_.size()));
  }
}

void ShellSystem::find_targets(const ShellElements& elements, const BlockMatrix& matrix) {
  int count = 0;
  for (const int e : order_) {
    target_of_.push_back(count);
    const int nodes = static_cast<int>(elements.nodes(e).size());
    count += nodes * (nodes + 1) / 2;
  }
  targets_.resize(count);
  constexpr std::size_t kBlock = 64;
  parallel_blocks(order_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto nodes = elements.nodes(order_[i]);
      Target* target = targets_.data() + target_of_[i];
      for (std::size_t b = 0; b < nodes.size(); ++b) {
        for (std::size_t a = 0; a <= b; ++a) {
          const BlockMatrix::Place place = matrix.place(position_[nodes[a]], position_[nodes[b]]);
          const auto row = static_cast<std::uint8_t>(place.transposed ? b : a);
          const auto column = static_cast<std::uint8_t>(place.transposed ? a : b);
          *target++ = {place.start, place.stride, row, column};
        }
      }
    }
  });
}

void ShellSystem::sum_chunk(const Chunk& chunk, std::size_t index, const ShellElements& elements,
                            const ShellState& state, const Eigen::MatrixX3d& x,
                            ShellElements::Order order, double scale, Eigen::VectorXd& gradient,
                            double* values) const {
  ShellElements::Local local;
  std::array<double, 2> energy{};
  for (int i = chunk.begin; i < chunk.end; ++i) {
    const int e = order_[i];
    elements.evaluate(e, state, x, order, local);
    energy[0] += local.membrane;
    energy[1] += local.bending;
    if (order == ShellElements::Order::energy) continue;
    const auto nodes = elements.nodes(e);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      gradient.segment<3>(3 * position_[nodes[k]]) += local.gradient.segment<3>(3 * k);
    }
    if (order != ShellElements::Order::hessian) continue;
    const Target* target = targets_.data() + target_of_[i];
    const std::size_t pairs = nodes.size() * (nodes.size() + 1) / 2;
    constexpr int kStride = 3 * ShellElements::kMostNodes;
    for (std::size_t p = 0; p < pairs; ++p, ++target) {
      const double* from = local.hessian.data() + 3 * target->column * kStride + 3 * target->row;
      double* to = values + target->start;
      for (int c = 0; c < 3; ++c, from += kStride, to += target->stride) {
        to[0] += scale * from[0];
        to[1] += scale * from[1];
        to[2] += scale * from[2];
      }
    }
  }
  chunk_energy_[index] = energy;
}

void ShellSystem::run(const ShellElements& elements, const ShellState& state,
                      const Eigen::MatrixX3d& x, ShellElements::Order order, double scale,
                      Sums& sums, double* values) const {
  if (order != ShellElements::Order::energy) {
    sums.gradient.setZero(3 * position_.size());
  }
  for (std::size_t colour = 0; colour + 1 < colours_.size(); ++colour) {
    const std::size_t first = colours_[colour];
    parallel_blocks(colours_[colour + 1] - first, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = first + begin; c < first + end; ++c) {
        sum_chunk(chunks_[c], c, elements, state, x, order, scale, sums.gradient, values);
      }
    });
  }
  sums.membrane = sums.bending = 0;
  for (const auto& [membrane, bending] : chunk_energy_) {
    sums.membrane += membrane;
    sums.bending += bending;
  }
}

void ShellSystem::energy(const ShellElements& elements, const ShellState& state,
                         const Eigen::MatrixX3d& x, Sums& sums) const {
  run(elements, state, x, ShellElements::Order::energy, 0, sums, nullptr);
}

void ShellSystem::gradient(const ShellElements& elements, const ShellState& state,
                           const Eigen::MatrixX3d& x, Sums& sums) const {
  run(elements, state, x, ShellElements::Order::gradient, 0, sums, nullptr);
}

void ShellSystem::hessian(const ShellElements& elements, const ShellState& state,
                          const Eigen::MatrixX3d& x, double scale, Sums& sums,
                          BlockMatrix& matrix) const {
  run(elements, state, x, ShellElements::Order::hessian, scale, sums, matrix.values());
}

}  // namespace geoprior::paper
