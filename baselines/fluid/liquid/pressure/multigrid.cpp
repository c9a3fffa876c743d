#include "baselines/fluid/liquid/pressure/multigrid.h"

#include <algorithm>
#include <array>
#include <deque>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr int kCoarsestUnknowns = 60;
constexpr int kCoarsestSweeps = 12;       ///< of each direction
constexpr float kCoarseStiffness = 0.5F;  ///< see make_multigrid_approximation
/// An aggregate whose row keeps less than this share of the diagonals below it is a whole enclosed
/// region: what is left is round-off, and it gets no correction.
constexpr float kEmptyRow = 1e-5F;

using Floats = std::vector<float>;

/// One level: its system, its vectors and how it hangs on the next finer one.
struct Level {
  PressureSystem owned;  ///< empty on the finest level
  const PressureSystem* system = nullptr;
  Floats inverse_diagonal, right, value;
  std::vector<std::int32_t> parent;  ///< on the next coarser level, of every unknown
  std::vector<std::array<std::int32_t, 4>> even_children;  ///< on the next finer level, 0: none
};

void invert_diagonal(Level& level) {
  const PressureSystem& a = *level.system;
  level.inverse_diagonal.resize(a.diagonal.size());
  for (std::size_t c = 0; c < a.diagonal.size(); ++c)
    level.inverse_diagonal[c] = a.diagonal[c] > 0 ? 1 / a.diagonal[c] : 0;
  level.right.assign(a.diagonal.size(), 0);
  level.value.assign(a.diagonal.size(), 0);
}

/// Gauss–Seidel on the unknowns by_colour[from … to).
void relax(const Level& level, Floats& x, int from, int to) {
  const PressureSystem& a = *level.system;
  const std::size_t offset = from;
  parallel_blocks(to - from, kPressureBlock, [&](std::size_t begin, std::size_t end) {
    float* values = x.data();
    for (std::size_t s = begin; s < end; ++s) {
      const std::size_t c = a.by_colour[offset + s];
      values[c] = level.inverse_diagonal[c] * (level.right[c] + a.neighbours<float>(values, c));
    }
  });
}

/// First even half sweep from x = 0; odd unknowns are overwritten by the next half sweep.
void relax_even_from_zero(const Level& level, Floats& x) {
  const PressureSystem& a = *level.system;
  parallel_blocks(a.even, kPressureBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const int c = a.by_colour[s];
      x[c] = level.inverse_diagonal[c] * level.right[c];
    }
  });
}

/// Cells of the coarse grid that hold an unknown of the fine one.
std::vector<std::uint8_t> mark_coarse(const PressureSystem& fine, const Eigen::Vector3i& coarse) {
  const std::size_t nx = coarse.x(), ny = coarse.y(), nz = coarse.z();
  const std::size_t fx = fine.size.x(), fy = fine.size.y(), fz = fine.size.z();
  std::vector<std::uint8_t> marked(nx * ny * nz, 0);
  parallel_blocks(nz, 2, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = 2 * begin; k < std::min(fz, 2 * end); ++k)
      for (std::size_t j = 0; j < fy; ++j) {
        const std::int32_t* row = fine.number.data() + fx * (j + fy * k);
        std::uint8_t* to = marked.data() + nx * (j / 2 + ny * (k / 2));
        for (std::size_t i = 0; i < fx; ++i) to[i / 2] |= static_cast<std::uint8_t>(row[i] > 0);
      }
  });
  return marked;
}

/// Adds up the fine coefficients below the coarse unknown `c`.
void gather_coefficients(const PressureSystem& fine, PressureSystem& coarse, Level& level,
                         std::vector<std::int32_t>& parent, std::size_t c) {
  const std::array<int, 3> n{fine.size.x(), fine.size.y(), fine.size.z()};
  const auto at = coarse.cell[c];
  const int base[3] = {2 * (at % coarse.size.x()), 2 * (at / coarse.size.x() % coarse.size.y()),
                       2 * (at / (coarse.size.x() * coarse.size.y()))};
  float diagonal = 0, gathered = 0;
  std::array<float, 3> link{0, 0, 0};
  std::array<std::int32_t, 4> children{0, 0, 0, 0};
  std::size_t child_count = 0;
  for (int o = 0; o < 8; ++o) {
    const int d[3] = {o & 1, (o >> 1) & 1, o >> 2};
    const int i = base[0] + d[0], j = base[1] + d[1], k = base[2] + d[2];
    if (i >= n[0] || j >= n[1] || k >= n[2]) continue;
    const std::size_t f =
        fine.number[static_cast<std::size_t>(i) +
                    static_cast<std::size_t>(n[0]) *
                        (static_cast<std::size_t>(j) + static_cast<std::size_t>(n[1]) * k)];
    if (f == 0) continue;
    parent[f] = static_cast<std::int32_t>(c);
    if (((d[0] + d[1] + d[2]) & 1) == 0) children[child_count++] = static_cast<std::int32_t>(f);
    diagonal += fine.diagonal[f];
    gathered += fine.diagonal[f];
    for (std::size_t a = 0; a < 3; ++a) {
      if (d[a] == 1) {
        link[a] += fine.link[a][f];
      } else {
        diagonal -= 2 * fine.link[a][f];  // inside the aggregate, in both rows
      }
    }
  }
  coarse.diagonal[c] = diagonal > kEmptyRow * gathered ? kCoarseStiffness * diagonal : 0;
  for (std::size_t a = 0; a < 3; ++a) coarse.link[a][c] = kCoarseStiffness * link[a];
  level.even_children[c] = children;
}

class Multigrid final : public PressureApproximation {
 public:
  void build(const PressureSystem& system) override {
    std::size_t used = 1;
    if (levels_.empty()) levels_.emplace_back();
    levels_[0].system = &system;
    invert_diagonal(levels_[0]);
    while (levels_[used - 1].system->n > kCoarsestUnknowns &&
           levels_[used - 1].system->size.maxCoeff() > 2) {
      if (levels_.size() == used) levels_.emplace_back();
      coarsen(levels_[used - 1], levels_[used]);
      ++used;
    }
    depth_ = used;
  }

  void apply(const std::vector<double>& r, std::vector<double>& z) override {
    Level& finest = levels_[0];
    const double largest = largest_magnitude(r);
    const double scale = largest > 0 ? largest : 1;  // keeps single precision in its range
    parallel_blocks(r.size(), kPressureBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) finest.right[c] = static_cast<float>(r[c] / scale);
    });
    cycle(0);
    parallel_blocks(r.size(), kPressureBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) z[c] = scale * static_cast<double>(finest.value[c]);
    });
  }

 private:
  static void coarsen(Level& fine, Level& coarse) {
    const PressureSystem& a = *fine.system;
    coarse.system = &coarse.owned;
    const Eigen::Vector3i size = (a.size.array() + 1) / 2;
    coarse.owned.number_cells(size, mark_coarse(a, size));
    coarse.owned.resize_coefficients();
    fine.parent.assign(a.diagonal.size(), 0);
    coarse.even_children.assign(coarse.owned.diagonal.size(), {0, 0, 0, 0});
    parallel_blocks(coarse.owned.n, kPressureBlock / 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin + 1; c <= end; ++c)
        gather_coefficients(a, coarse.owned, coarse, fine.parent, c);
    });
    invert_diagonal(coarse);
  }

  void cycle(std::size_t l) {
    Level& level = levels_[l];
    const PressureSystem& a = *level.system;
    relax_even_from_zero(level, level.value);
    relax(level, level.value, a.even, a.n);
    if (l + 1 == depth_) {
      for (int s = 1; s < kCoarsestSweeps; ++s) {
        relax(level, level.value, 0, a.even);
        relax(level, level.value, a.even, a.n);
      }
      for (int s = 1; s < kCoarsestSweeps; ++s) {
        relax(level, level.value, a.even, a.n);
        relax(level, level.value, 0, a.even);
      }
    } else {
      restrict_residual(level, levels_[l + 1]);
      cycle(l + 1);
      correct(level, levels_[l + 1]);
    }
    relax(level, level.value, a.even, a.n);
    relax(level, level.value, 0, a.even);
  }

  /// Odd rows were relaxed last: their residual is 0.
  static void restrict_residual(const Level& fine, Level& coarse) {
    const PressureSystem& a = *fine.system;
    parallel_blocks(coarse.system->n, kPressureBlock / 4, [&](std::size_t begin, std::size_t end) {
      const float* x = fine.value.data();
      for (std::size_t c = begin + 1; c <= end; ++c) {
        float sum = 0;
        for (const std::int32_t child : coarse.even_children[c]) {
          const std::size_t f = child;
          if (f == 0) break;
          sum += fine.right[f] - a.diagonal[f] * x[f] + a.neighbours<float>(x, f);
        }
        coarse.right[c] = sum;
      }
    });
  }

  /// Odd unknowns follow from the even ones in the next half sweep.
  static void correct(Level& fine, const Level& coarse) {
    const PressureSystem& a = *fine.system;
    parallel_blocks(a.even, kPressureBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        const int c = a.by_colour[s];
        fine.value[c] += coarse.value[fine.parent[c]];
      }
    });
  }

  std::deque<Level> levels_;  ///< never move: `system` points into them
  std::size_t depth_ = 1;
};

}  // namespace

std::unique_ptr<PressureApproximation> make_multigrid_approximation() {
  return std::make_unique<Multigrid>();
}

}  // namespace geoprior::fluid
