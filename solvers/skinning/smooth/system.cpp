#include "solvers/skinning/smooth/system.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "models/skinning/surface_diffusion.h"

namespace geoprior::skinning {
namespace {

/// Residual over what is asked at which the solution is good enough for a skin.
constexpr double kEnough = 1e-2;

/// Slivers count as this share of the mean area, so that bending them stays finite.
constexpr double kLeastArea = 1e-3;

/// Lengths over which a displacement decays between what is asked and what stands still.
constexpr double kReach = 1.5;

double bending(double cutoff) { return std::pow(cutoff / 7.85, 4); }

/// Squared distance of two boxes.
float gap2(const Float4Bounds& a, const Float4Bounds& b) {
  float sum = 0;
  for (int k = 0; k < 3; ++k) {
    const float gap = std::max({0.0F, a.low[k] - b.high[k], b.low[k] - a.high[k]});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace

SmoothSystem::SmoothSystem(const TriMesh& mesh, const SkinState& state,
                           const std::vector<float>& radius)
    : size_(state.size()) {
  weigh_vertices(mesh, state, radius);
  list_stiffness(mesh, state);
  sum_bend_diagonal();
  bound_blocks(state, radius);
  coarse_.emplace(state, CoarseSpace::Rings{offset_, neighbour_}, radius, vertex_normals(mesh),
                  laplace(), bend_, area_);
  allocate();
}

void SmoothSystem::weigh_vertices(const TriMesh& mesh, const SkinState& state,
                                  const std::vector<float>& radius) {
  const Eigen::VectorXd areas = vertex_areas(mesh);
  const double mean_area = areas.mean();
  for (std::size_t s = 0; s < size_; ++s) {
    const double area = std::max(kLeastArea * mean_area, areas(state.vertex[s]));
    const double r2 = static_cast<double>(radius[s]) * static_cast<double>(radius[s]);
    area_.push_back(static_cast<float>(area / mean_area));
    bend_.push_back(static_cast<float>(r2 * r2 / (area * mean_area)));
  }
}

void SmoothSystem::list_stiffness(const TriMesh& mesh, const SkinState& state) {
  const Eigen::SparseMatrix<double> stiffness = positive_cotangent_laplacian(mesh);
  std::vector<int> slot_of(size_);
  for (std::size_t s = 0; s < size_; ++s) slot_of[state.vertex[s]] = static_cast<int>(s);
  offset_.push_back(0);
  for (std::size_t s = 0; s < size_; ++s) {
    const int v = state.vertex[s];
    for (Eigen::SparseMatrix<double>::InnerIterator it(stiffness, v); it; ++it) {
      if (it.row() == v) {
        diagonal_.push_back(static_cast<float>(it.value()));
        continue;
      }
      neighbour_.push_back(slot_of[it.row()]);
      conductance_.push_back(static_cast<float>(-it.value()));
    }
    offset_.push_back(static_cast<int>(neighbour_.size()));
  }
}

void SmoothSystem::sum_bend_diagonal() {
  for (std::size_t s = 0; s < size_; ++s) {
    float sum = diagonal_[s] * diagonal_[s] * bend_[s];
    for (std::size_t j = offset_[s]; j < static_cast<std::size_t>(offset_[s + 1]); ++j)
      sum += conductance_[j] * conductance_[j] * bend_[neighbour_[j]];
    bend_diagonal_.push_back(sum);
  }
}

void SmoothSystem::bound_blocks(const SkinState& state, const std::vector<float>& radius) {
  near_blocks_.resize(state.block_count());
  bounds_.resize(near_blocks_.size());
  radius_.assign(near_blocks_.size(), 0);
  for (std::size_t s = 0; s < size_; ++s) {
    const std::size_t block = s / SkinState::kBlock;
    bounds_[block].include(state.rest[s]);
    radius_[block] = std::max(radius_[block], radius[s]);
    std::vector<int>& near = near_blocks_[block];
    for (int j = offset_[s]; j < offset_[s + 1]; ++j)
      near.push_back(neighbour_[j] / static_cast<int>(SkinState::kBlock));
  }
  for (std::vector<int>& near : near_blocks_) {
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }
}

Eigen::SparseMatrix<double> SmoothSystem::laplace() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t s = 0; s < size_; ++s) {
    const int row = static_cast<int>(s);
    entries.emplace_back(row, row, static_cast<double>(diagonal_[s]));
    for (int j = offset_[s]; j < offset_[s + 1]; ++j) {
      entries.emplace_back(row, neighbour_[j], -static_cast<double>(conductance_[j]));
    }
  }
  Eigen::SparseMatrix<double> L(size_, size_);
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

void SmoothSystem::allocate() {
  chosen_.assign(near_blocks_.size(), 0);
  partial_.assign(near_blocks_.size(), 0);
  reached_ = chosen_;
  seen_.assign(near_blocks_.size(), 0);
  residual_.assign(size_, Float4{});
  search_ = bent_ = image_ = direction_ = residual_;
  inverse_.assign(size_, 0);
  share_ = inverse_;
}

void SmoothSystem::close(std::vector<Float4>& u) {
  each_open([&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) u[s] = search_[s] = bent_[s] = Float4{};
  });
  std::fill(chosen_.begin(), chosen_.end(), std::uint8_t{0});
  blocks_.clear();
}

void SmoothSystem::open(const std::vector<Demand>& demands, const Options& options) {
  // kappa r^4 / l^4 = mu: the length l at which bending and anchor are equal.
  const double decay = std::sqrt(2.0) * std::pow(bending(options.cutoff) / options.anchor, 0.25);
  list_asked(demands);
  reach_around_asked(static_cast<float>(kReach * decay));
  front_.clear();
  for (int b = 0; b < std::ssize(reached_); ++b)
    if (reached_[b] != 0) front_.push_back(b);
  open(front_);
}

void SmoothSystem::list_asked(const std::vector<Demand>& demands) {
  asked_.clear();
  for (std::size_t b = 0; b < chosen_.size(); ++b) {
    const std::size_t begin = b * SkinState::kBlock;
    const std::size_t end = std::min(size_, begin + SkinState::kBlock);
    bool asked = false;
    for (std::size_t s = begin; s < end && !asked; ++s)
      asked = demands[s].weight * std::abs(demands[s].amount) > 0;
    if (asked) asked_.push_back(static_cast<int>(b));
  }
}

void SmoothSystem::reach_around_asked(float reach) {
  std::fill(reached_.begin(), reached_.end(), std::uint8_t{0});
  for (const int from : asked_) {
    // Through blocks that touch: what is near across a gap belongs to another part of the skin.
    const std::size_t first = from;
    const float limit = reach * radius_[first];
    front_.assign(1, from);
    for (std::size_t i = 0; i < front_.size(); ++i) {
      const std::size_t b = front_[i];
      seen_[b] = static_cast<int>(first) + 1;
      reached_[b] = 1;
      for (const int near : near_blocks_[b]) {
        if (seen_[near] == static_cast<int>(first) + 1) continue;
        seen_[near] = static_cast<int>(first) + 1;
        if (gap2(bounds_[first], bounds_[near]) <= limit * limit) front_.push_back(near);
      }
    }
  }
  std::fill(seen_.begin(), seen_.end(), 0);
}

void SmoothSystem::open(const std::vector<int>& blocks) {
  for (const int block : blocks) {
    std::uint8_t& chosen = chosen_[block];
    if (chosen == 0) blocks_.push_back(block);
    chosen = 1;
  }
  std::sort(blocks_.begin(), blocks_.end());
  coarse_->open(chosen_);
}

void SmoothSystem::bend(const std::vector<Float4>& x, float kappa) {
  each_slot([&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      Float4 sum = splat(diagonal_[s]) * x[s];
      for (std::size_t j = offset_[s]; j < static_cast<std::size_t>(offset_[s + 1]); ++j)
        sum -= splat(conductance_[j]) * x[neighbour_[j]];
      bent_[s] = splat(kappa * bend_[s]) * sum;
    }
  });
}

double SmoothSystem::apply(const std::vector<Demand>& demands, const std::vector<Float4>& x,
                           float kappa, float diagonal) {
  bend(x, kappa);
  each_slot([&](std::size_t block, std::size_t begin, std::size_t end) {
    double product = 0;
    for (std::size_t s = begin; s < end; ++s) {
      Float4 sum = splat(diagonal_[s]) * bent_[s];
      for (std::size_t j = offset_[s]; j < static_cast<std::size_t>(offset_[s + 1]); ++j)
        sum -= splat(conductance_[j]) * bent_[neighbour_[j]];
      const Demand& demand = demands[s];
      sum += splat(area_[s]) *
             (splat(diagonal) * x[s] +
              demand.direction * splat(demand.weight * dot3(demand.direction, x[s])));
      image_[s] = sum;
      product += static_cast<double>(dot3(sum, x[s]));
    }
    partial_[block] = product;
  });
  return sum();
}

double SmoothSystem::sum() const {
  double total = 0;
  for (const int block : blocks_) total += partial_[block];
  return total;
}

double SmoothSystem::precondition(const std::vector<Demand>& demands,
                                  const std::vector<Float4>& residual) {
  each_slot([&](std::size_t block, std::size_t begin, std::size_t end) {
    double product = 0;
    for (std::size_t s = begin; s < end; ++s) {
      // (a I + b d d^T)^-1 by Sherman and Morrison.
      const Float4 d = demands[s].direction;
      direction_[s] =
          splat(inverse_[s]) * (residual[s] - splat(share_[s] * dot3(d, residual[s])) * d);
      product += static_cast<double>(dot3(direction_[s], residual[s]));
    }
    partial_[block] = product;
  });
  return sum();
}

int SmoothSystem::solve(const std::vector<Demand>& demands, const Options& options,
                        std::vector<Float4>& u) {
  if (blocks_.empty()) return 0;
  const auto kappa = static_cast<float>(bending(options.cutoff));
  const auto diagonal = static_cast<float>(options.anchor);
  start_residual(demands, u, kappa, diagonal);
  const double enough = kEnough * kEnough * precondition(demands, search_);
  correct_coarsely(demands, u, kappa, diagonal);
  double energy = precondition(demands, residual_);
  double last = 1;
  int done = 0;
  for (; done < options.iterations && energy > enough; ++done) {
    const auto keep = static_cast<float>(done == 0 ? 0 : energy / last);
    each_open([&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s)
        search_[s] = direction_[s] + splat(keep) * search_[s];
    });
    const auto step = static_cast<float>(energy / apply(demands, search_, kappa, diagonal));
    each_open([&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        u[s] += splat(step) * search_[s];
        residual_[s] -= splat(step) * image_[s];
      }
    });
    last = energy;
    energy = precondition(demands, residual_);
  }
  return done;
}

void SmoothSystem::start_residual(const std::vector<Demand>& demands, const std::vector<Float4>& u,
                                  float kappa, float diagonal) {
  // Slots of closed blocks are read as neighbours: they hold zero (`close`).
  apply(demands, u, kappa, diagonal);
  each_open([&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const Demand& demand = demands[s];
      const Float4 asked = demand.direction * splat(demand.weight * demand.amount);
      residual_[s] = splat(area_[s]) * asked - image_[s];
      const float same = kappa * bend_diagonal_[s] + area_[s] * diagonal;
      const float along = area_[s] * demand.weight;
      inverse_[s] = 1 / same;
      share_[s] = along / (same + along);
      search_[s] = splat(area_[s]) * asked;
    }
  });
}

void SmoothSystem::correct_coarsely(const std::vector<Demand>& demands, std::vector<Float4>& u,
                                    float kappa, float diagonal) {
  slots_.clear();
  for (const int block : blocks_) {
    const std::size_t first = static_cast<std::size_t>(block) * SkinState::kBlock;
    for (std::size_t s = first; s < std::min(size_, first + SkinState::kBlock); ++s)
      if (demands[s].weight > 0) slots_.push_back(static_cast<int>(s));
  }
  coarse_->solve(demands, slots_, area_, residual_, kappa, diagonal, blocks_, search_);
  apply(demands, search_, kappa, diagonal);
  each_open([&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      u[s] += search_[s];
      residual_[s] -= image_[s];
    }
  });
}

}  // namespace geoprior::skinning
