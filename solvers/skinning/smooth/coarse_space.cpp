#include "solvers/skinning/smooth/coarse_space.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace geoprior::skinning {
namespace {

constexpr float kSpacing = 0.45F;  // of nodes, in local radii
constexpr float kBump = 2.2F;      // reach of a bump, in spacings
constexpr float kDetour = 1.5F;    // along edges, over the reach of a bump

constexpr int kIterations = 40;
constexpr double kCoarseEnough = 3e-2;  // residual over that of the start

/// Distances along the edges of the rest surface.
class Walk {
 public:
  Walk(const SkinState& state, const CoarseSpace::Rings& rings)
      : state_(state), rings_(rings), distance_(state.size(), kFar) {}

  /// Calls visit(slot) for the slots within `reach` of one, nearest first.
  template <class Visit>
  void from(int start, float reach, const Visit& visit) {
    touched_.assign(1, start);
    distance_[start] = 0;
    queue_.emplace(0.0F, start);
    while (!queue_.empty()) {
      const auto [distance, slot] = queue_.top();
      queue_.pop();
      const std::size_t s = slot;
      if (distance > distance_[s]) continue;
      visit(slot);
      for (int j = rings_.offset[s]; j < rings_.offset[s + 1]; ++j) {
        const int next = rings_.neighbour[j];
        const std::size_t n = next;
        const Float4 edge = state_.rest[n] - state_.rest[s];
        const float there = distance + length3(edge);
        if (there > reach || there >= distance_[n]) continue;
        if (distance_[n] == kFar) touched_.push_back(next);
        distance_[n] = there;
        queue_.emplace(there, next);
      }
    }
    for (const int slot : touched_) distance_[slot] = kFar;
  }

 private:
  static constexpr float kFar = 1e30F;
  using Step = std::pair<float, int>;
  const SkinState& state_;
  const CoarseSpace::Rings& rings_;
  std::vector<float> distance_;
  std::vector<int> touched_;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> queue_;
};

/// Moving least squares (Lancaster and Salkauskas 1981): weights about a slot become those that
/// give back functions which are linear in its tangent plane.
void reproduce_lines(const SkinState& state, std::size_t slot, const Eigen::Vector3d& normal,
                     const std::vector<int>& nodes, std::vector<CoarseSpace::Entry>& entries) {
  if (entries.empty()) return;
  // Of the second moments: keeps few or aligned nodes from large weights of both signs.
  constexpr double kStiff = 1e-3;
  // Among triangles without area there is no normal: any plane does.
  const Eigen::Vector3d up =
      normal.squaredNorm() > 0 ? normal : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = up.unitOrthogonal();
  tangents.col(1) = up.cross(tangents.col(0));
  std::vector<Eigen::Vector3d> basis;
  double reach2 = 1e-30;
  for (const CoarseSpace::Entry& entry : entries) {
    const Float4 way = state.rest[nodes[entry.at]] - state.rest[slot];
    const Eigen::Vector2d along =
        tangents.transpose() * Eigen::Vector3d(static_cast<double>(way[0]),
                                               static_cast<double>(way[1]),
                                               static_cast<double>(way[2]));
    basis.emplace_back(1, along.x(), along.y());
    reach2 = std::max(reach2, along.squaredNorm());
  }
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    basis[i].tail<2>() /= std::sqrt(reach2);
    moments += static_cast<double>(entries[i].weight) * basis[i] * basis[i].transpose();
  }
  moments.diagonal().tail<2>().array() += kStiff * moments(0, 0);
  const Eigen::Vector3d factors = moments.ldlt().solve(Eigen::Vector3d::UnitX());
  double sum = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].weight *= static_cast<float>(factors.dot(basis[i]));
    sum += static_cast<double>(entries[i].weight);
  }
  for (CoarseSpace::Entry& entry : entries) entry.weight /= static_cast<float>(sum);
}

}  // namespace

void CoarseSpace::place_nodes(const SkinState& state, const Rings& rings,
                              const std::vector<float>& radius, const Eigen::MatrixX3d& normals) {
  Walk walk(state, rings);
  std::vector<int> nodes;
  std::vector<std::uint8_t> covered(size_, 0);
  for (std::size_t s = 0; s < size_; ++s) {
    // Skin without a bone stands still.
    if (covered[s] != 0 || !(radius[s] > 0)) continue;
    nodes.push_back(static_cast<int>(s));
    walk.from(static_cast<int>(s), kSpacing * radius[s], [&](int slot) { covered[slot] = 1; });
  }
  std::vector<std::vector<Entry>> rows(size_);
  for (int n = 0; n < std::ssize(nodes); ++n) {
    const std::size_t centre = nodes[n];
    const float reach = kBump * kSpacing * radius[centre];
    walk.from(nodes[n], kDetour * reach, [&](int slot) {
      const std::size_t s = slot;
      const Float4 way = state.rest[s] - state.rest[centre];
      const float inside = 1 - dot3(way, way) / (reach * reach);
      if (inside > 0) rows[s].push_back({n, inside * inside * inside});
    });
  }
  row_offset_.assign(1, 0);
  std::vector<std::vector<Entry>> columns(nodes.size());
  for (std::size_t s = 0; s < size_; ++s) {
    reproduce_lines(state, s, normals.row(state.vertex[s]), nodes, rows[s]);
    for (const Entry& entry : rows[s]) {
      row_.push_back(entry);
      columns[entry.at].push_back({static_cast<int>(s), entry.weight});
    }
    row_offset_.push_back(row_.size());
  }
  column_offset_.assign(1, 0);
  for (const std::vector<Entry>& column : columns) {
    std::vector<int> blocks;
    for (const Entry& entry : column) {
      column_.push_back(entry);
      blocks.push_back(entry.at / static_cast<int>(SkinState::kBlock));
    }
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    blocks_of_.push_back(std::move(blocks));
    column_offset_.push_back(column_.size());
  }
}

CoarseSpace::CoarseSpace(const SkinState& state, const Rings& rings,
                         const std::vector<float>& radius, const Eigen::MatrixX3d& normals,
                         const Eigen::SparseMatrix<double>& laplace, const std::vector<float>& bend,
                         const std::vector<float>& area)
    : size_(state.size()) {
  place_nodes(state, rings, radius, normals);
  const Eigen::Index nodes = node_count();
  Eigen::SparseMatrix<double> P(size_, nodes);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t s = 0; s < size_; ++s)
    for (const Entry& entry : row(s))
      entries.emplace_back(static_cast<int>(s), entry.at, static_cast<double>(entry.weight));
  P.setFromTriplets(entries.begin(), entries.end());
  const auto diagonal = [](const std::vector<float>& values) {
    return Eigen::Map<const Eigen::VectorXf>(values.data(), values.size()).cast<double>().eval();
  };
  const Eigen::SparseMatrix<double> LP = laplace * P;
  const Eigen::SparseMatrix<double> bent =
      LP.transpose() * (diagonal(bend).asDiagonal() * LP).eval();
  const Eigen::SparseMatrix<double> mass = P.transpose() * (diagonal(area).asDiagonal() * P).eval();
  pair_offset_.assign(1, 0);
  for (Eigen::Index n = 0; n < nodes; ++n) {
    // Where bumps overlap, their Laplacians do.
    Eigen::SparseMatrix<double>::InnerIterator m(mass, n);
    for (Eigen::SparseMatrix<double>::InnerIterator it(bent, n); it; ++it) {
      while (m && m.row() < it.row()) ++m;
      const double both = m && m.row() == it.row() ? m.value() : 0;
      pair_.push_back(
          {static_cast<int>(it.row()), static_cast<float>(it.value()), static_cast<float>(both)});
    }
    pair_offset_.push_back(pair_.size());
  }
  is_open_.assign(node_count(), 0);
  value_.assign(node_count(), Float4{});
  residual_ = search_ = image_ = value_;
  inverse_.assign(node_count(), 0);
}

void CoarseSpace::open(const std::vector<std::uint8_t>& chosen) {
  nodes_.clear();
  for (std::size_t n = 0; n < node_count(); ++n) {
    const std::vector<int>& blocks = blocks_of_[n];
    const bool inside =
        std::all_of(blocks.begin(), blocks.end(), [&](int b) { return chosen[b] != 0; });
    is_open_[n] = inside ? 1 : 0;
    value_[n] = search_[n] = Float4{};
    if (inside) nodes_.push_back(static_cast<int>(n));
  }
}

void CoarseSpace::apply(const std::vector<Demand>& demands, const std::vector<int>& slots,
                        const std::vector<float>& area, float kappa, float diagonal) {
  for (const int node : nodes_) {
    const std::size_t n = node;
    Float4 sum{};
    for (std::size_t j = pair_offset_[n]; j < pair_offset_[n + 1]; ++j) {
      const Pair& pair = pair_[j];
      sum += splat(kappa * pair.bend + diagonal * pair.mass) * search_[pair.node];
    }
    image_[n] = sum;
  }
  for (const int slot : slots) {
    const std::size_t s = slot;
    const Demand& demand = demands[s];
    Float4 x{};
    for (const Entry& entry : row(s)) x += splat(entry.weight) * search_[entry.at];
    const Float4 answer =
        demand.direction * splat(area[s] * demand.weight * dot3(demand.direction, x));
    for (const Entry& entry : row(s)) image_[entry.at] += splat(entry.weight) * answer;
  }
}

void CoarseSpace::solve(const std::vector<Demand>& demands, const std::vector<int>& slots,
                        const std::vector<float>& area, const std::vector<Float4>& residual,
                        float kappa, float diagonal, const std::vector<int>& blocks,
                        std::vector<Float4>& u) {
  double energy = 0;
  for (const int node : nodes_) {
    const std::size_t n = node;
    Float4 sum{};
    float asked = 0;
    for (std::size_t j = column_offset_[n]; j < column_offset_[n + 1]; ++j) {
      const std::size_t s = column_[j].at;
      const float weight = column_[j].weight;
      sum += splat(weight) * residual[s];
      asked += weight * weight * area[s] * demands[s].weight;
    }
    float own = asked;
    for (std::size_t j = pair_offset_[n]; j < pair_offset_[n + 1]; ++j)
      if (pair_[j].node == node) own += kappa * pair_[j].bend + diagonal * pair_[j].mass;
    inverse_[n] = 1 / own;
    residual_[n] = sum;
    value_[n] = search_[n] = Float4{};
    energy += static_cast<double>(inverse_[n] * dot3(sum, sum));
  }
  const double enough = kCoarseEnough * kCoarseEnough * energy;
  double last = 1;
  for (int i = 0; i < kIterations && energy > enough; ++i) {
    const auto keep = static_cast<float>(i == 0 ? 0 : energy / last);
    for (const int node : nodes_) {
      const std::size_t n = node;
      search_[n] = splat(inverse_[n]) * residual_[n] + splat(keep) * search_[n];
    }
    apply(demands, slots, area, kappa, diagonal);
    double along = 0;
    for (const int node : nodes_) {
      const std::size_t n = node;
      along += static_cast<double>(dot3(search_[n], image_[n]));
    }
    const auto step = static_cast<float>(energy / along);
    last = energy;
    energy = 0;
    for (const int node : nodes_) {
      const std::size_t n = node;
      value_[n] += splat(step) * search_[n];
      residual_[n] -= splat(step) * image_[n];
      energy += static_cast<double>(inverse_[n] * dot3(residual_[n], residual_[n]));
    }
  }
  for (const int block : blocks) {
    const std::size_t first = static_cast<std::size_t>(block) * SkinState::kBlock;
    for (std::size_t s = first; s < std::min(size_, first + SkinState::kBlock); ++s) {
      Float4 sum{};
      for (const Entry& entry : row(s)) sum += splat(entry.weight) * value_[entry.at];
      u[s] = sum;
    }
  }
}

}  // namespace geoprior::skinning
