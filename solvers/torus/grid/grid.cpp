#include "solvers/torus/grid/grid.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <thread>

#include "core/error.h"
#include "core/limits.h"
#include "core/parallel.h"
#include "models/torus/frames.h"
#include "models/torus/sampling.h"
#include "solvers/torus/grid/grid_rows.h"

namespace geoprior::torus {
namespace {

/// Rows of a band: with three corrugations a twelfth of the rows are computed twice.
constexpr int kBand = 64;
/// Bands between two looks at whether the user wants to stop; no more threads are used.
constexpr int kBandsAtOnce = 16;

/// Stages of a band, each its rows.
using BandMemory = std::vector<GridRows>;

/// Memory of bands that are done, for those to come: as many as there are threads.
class BandMemories {
 public:
  std::unique_ptr<BandMemory> take(std::size_t stages) {
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) return std::make_unique<BandMemory>(stages);
    auto memory = std::move(free_.back());
    free_.pop_back();
    return memory;
  }
  void give(std::unique_ptr<BandMemory> memory) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(memory));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<BandMemory>> free_;
};

/// A point that somebody asked for: column of a row, entry of the plan, row of its matrix.
struct AskedNode {
  int row = 0, column = 0;
  int entry = 0;
  Eigen::Index at = 0;
};

class GridTorus final : public TorusMap {
 public:
  GridTorus(const TorusInput& input, int n) : input_(input), n_(n) {}

  [[nodiscard]] std::optional<int> grid() const override { return n_; }

  void plan(std::span<const TorusSamples> all, RunContext& context) override {
    collect(all);
    require_memory(band_bytes() * threads(), static_cast<double>(n_) * n_, "points of a grid",
                   "options.points");
    const int bands = (n_ + kBand - 1) / kBand;
    bad_.assign(bands, {});
    for (int first = 0; first < bands && !context.stop_requested(); first += kBandsAtOnce) {
      const int count = std::min(kBandsAtOnce, bands - first);
      parallel_blocks(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
          auto stages = memories_.take(most_ + 1);
          compute(first + static_cast<int>(b), *stages);
          memories_.give(std::move(stages));
        }
      });
      context.progress(static_cast<double>(first + count) / bands);
    }
    for (const BadNode& bad : bad_)
      if (bad.corrugation >= 0)
        refuse_coefficient(input_, bad.corrugation, bad.rho,
                           Eigen::Vector2d(bad.column, (bad.row % n_ + n_) % n_) / n_);
  }

  Eigen::MatrixX3d points(std::size_t i, const TorusSamples& /*samples*/,
                          RunContext& /*context*/) override {
    return std::move(points_[i]);
  }

 private:
  void collect(std::span<const TorusSamples> all) {
    nodes_.assign((n_ + kBand - 1) / kBand, {});
    for (const TorusSamples& samples : all) {
      const int entry = static_cast<int>(points_.size());
      points_.emplace_back(samples.at.rows(), 3);
      stage_.push_back(samples.corrugations);
      most_ = std::max(most_, samples.corrugations);
      for (Eigen::Index at = 0; at < samples.at.rows(); ++at) {
        const int column = grid_node(samples.at(at, 0), n_), row = grid_node(samples.at(at, 1), n_);
        nodes_[row / kBand].push_back({row, column, entry, at});
      }
    }
  }

  /// Of all stages of a band.
  [[nodiscard]] double band_bytes() const {
    double rows = 0;
    for (int k = 0; k <= most_; ++k) rows += kBand + 2. * kRowReach * (most_ - k);
    return rows * 3 * sizeof(double) * n_;
  }
  static int threads() {
    return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kBandsAtOnce);
  }

  void compute(int band, BandMemory& stages) {
    const int begin = band * kBand, end = std::min(n_, begin + kBand);
    corrugate_band(input_, n_, begin, end, stages, bad_[band]);
    for (const AskedNode& asked : nodes_[band])
      for (int c = 0; c < 3; ++c)
        points_[asked.entry](asked.at, c) =
            stages[stage_[asked.entry]].row(c, asked.row)[asked.column];
  }

  TorusInput input_;
  int n_;
  int most_ = 0;  ///< corrugations
  std::vector<int> stage_;
  std::vector<Eigen::MatrixX3d> points_;
  std::vector<std::vector<AskedNode>> nodes_;  ///< of each band
  std::vector<BadNode> bad_;
  BandMemories memories_;
};

}  // namespace

void describe(OptionVisitor& v, GridOptions& options) {
  v.value("points", options.points,
          {.doc = "points n of the grid along each side of the square", .min = 16, .max = 200000});
}

std::unique_ptr<Process> make_grid_torus(const TorusInput& input, const GridOptions& options) {
  return make_torus_process(input, [n = options.points](const TorusInput& given, RunContext&) {
    return std::make_unique<GridTorus>(given, n);
  });
}

}  // namespace geoprior::torus
