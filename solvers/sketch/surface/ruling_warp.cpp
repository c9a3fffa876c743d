#include "solvers/sketch/surface/ruling_warp.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/numerics/sparse_ldlt.h"

namespace geoprior::sketch {
namespace {

/// Half width of the band about the diagonal that the warping path keeps to where both runs end.
/// Ours: in a wider one the paths of all drawings here are the same.
constexpr double kBand = 0.15;
constexpr double kUnreached = std::numeric_limits<double>::infinity();
constexpr std::array<std::array<int, 2>, 3> kWarpSteps{{{1, 1}, {1, 0}, {0, 1}}};

/// Table of least costs over pairs of nodes.
class WarpTable {
 public:
  WarpTable(const BorderRun& first, const BorderRun& second, WarpEnd end,
            const RulingWarpOptions& options);
  [[nodiscard]] std::array<int, 2> last_cell(WarpEnd end) const;
  [[nodiscard]] std::vector<std::array<int, 2>> path_to(std::array<int, 2> cell) const;

 private:
  [[nodiscard]] int index(int i, int j) const { return i * m_ + j; }
  [[nodiscard]] bool in_band(int i, int j) const {
    const double across = static_cast<double>(i) / (n_ - 1) - static_cast<double>(j) / (m_ - 1);
    return std::abs(across) <= band_;
  }
  [[nodiscard]] Eigen::Vector2d ruling(int i, int j) const {
    return second_.points[j] - first_.points[i];
  }
  void relax(int i, int j, double collinearity);

  const BorderRun& first_;
  const BorderRun& second_;
  int n_;
  int m_;
  double band_;
  std::vector<double> cost_;
  std::vector<std::int8_t> step_;  ///< taken to a cell, -1: none
};

WarpTable::WarpTable(const BorderRun& first, const BorderRun& second, WarpEnd end,
                     const RulingWarpOptions& options)
    : first_(first),
      second_(second),
      n_(static_cast<int>(first.points.size())),
      m_(static_cast<int>(second.points.size())),
      // A band narrower than two nodes of the shorter run would cut the diagonal itself.
      band_(end == WarpEnd::both_end ? std::max(kBand, 2.0 / (std::min(n_, m_) - 1)) : 1.0),
      cost_(static_cast<std::size_t>(n_) * m_, kUnreached),
      step_(cost_.size(), -1) {
  cost_[0] = 0;
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j < m_; ++j) {
      if (i + j > 0 && in_band(i, j)) relax(i, j, options.collinearity);
    }
  }
}

void WarpTable::relax(int i, int j, double collinearity) {
  // The angles to one ruling differ by the angle between the tangents.
  const double ends = signed_angle(first_.tangents[i], second_.tangents[j]);
  for (int s = 0; s < 3; ++s) {
    const auto [di, dj] = kWarpSteps[s];
    if (i < di || j < dj) continue;
    const double before = cost_[index(i - di, j - dj)];
    if (before == kUnreached) continue;
    const double turn = signed_angle(ruling(i - di, j - dj), ruling(i, j));
    const double cost = before + (di + dj) * ends * ends + collinearity * turn * turn;
    if (cost >= cost_[index(i, j)]) continue;
    cost_[index(i, j)] = cost;
    step_[index(i, j)] = static_cast<std::int8_t>(s);
  }
}

std::array<int, 2> WarpTable::last_cell(WarpEnd end) const {
  if (end == WarpEnd::both_end) return {n_ - 1, m_ - 1};
  std::array<int, 2> best{n_ - 1, m_ - 1};
  double least = kUnreached;
  const bool second_open = end == WarpEnd::second_open;
  for (int k = 1; k < (second_open ? m_ : n_); ++k) {
    const int i = second_open ? n_ - 1 : k, j = second_open ? k : m_ - 1;
    const double mean = cost_[index(i, j)] / (i + j);
    if (mean >= least) continue;
    least = mean;
    best = {i, j};
  }
  return best;
}

std::vector<std::array<int, 2>> WarpTable::path_to(std::array<int, 2> cell) const {
  std::vector<std::array<int, 2>> path{cell};
  while (cell[0] + cell[1] > 0) {
    const auto [di, dj] = kWarpSteps[step_[index(cell[0], cell[1])]];
    cell = {cell[0] - di, cell[1] - dj};
    path.push_back(cell);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

/// Tangent of a run between nodes.
Eigen::Vector2d tangent_at(const BorderRun& run, double at) {
  const int i =
      std::clamp(static_cast<int>(std::floor(at)), 0, static_cast<int>(run.points.size()) - 2);
  const double t = at - i;
  return (1 - t) * run.tangents[i] + t * run.tangents[i + 1];
}

/// Mean place on the second run of the cells of each node of the first.
std::vector<double> image_of_cells(const std::vector<std::array<int, 2>>& cells) {
  std::vector<double> sum(cells.back()[0] + 1, 0), count(sum.size(), 0);
  for (const auto& [i, j] : cells) {
    sum[i] += j;
    count[i] += 1;
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= count[i];
  sum.front() = 0;
  sum.back() = cells.back()[1];
  return sum;
}

/// Keeps a map rising and inside [0, last].
void make_rising(std::vector<double>& image, double last) {
  double lowest = 0;
  for (double& s : image) {
    s = std::clamp(s, lowest, last);
    lowest = s;
  }
}

/// One Gauss-Newton step on sum (angle between tangents)^2 + smoothness sum (second difference)^2
/// over the inner places; the first and the last are held.
void refine_once(const BorderRun& first, const BorderRun& second, double smoothness,
                 std::vector<double>& image) {
  const int n = static_cast<int>(image.size());
  const double last = image.back();
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  for (int i = 1; i + 1 < n; ++i) {
    const double low = std::max(image[i] - 0.5, 0.0), high = std::min(image[i] + 0.5, last);
    const double angle = signed_angle(first.tangents[i], tangent_at(second, image[i]));
    const double slope =
        signed_angle(tangent_at(second, low), tangent_at(second, high)) / (high - low);
    entries.emplace_back(i, i, slope * slope);
    gradient(i) += slope * angle;
    constexpr std::array<double, 3> kSecond{1, -2, 1};
    const double bend = image[i - 1] - 2 * image[i] + image[i + 1];
    for (int a = 0; a < 3; ++a) {
      gradient(i - 1 + a) += smoothness * kSecond[a] * bend;
      for (int b = 0; b < 3; ++b)
        entries.emplace_back(i - 1 + a, i - 1 + b, smoothness * kSecond[a] * kSecond[b]);
    }
  }
  constexpr double kHeld = 1e6;
  entries.emplace_back(0, 0, kHeld);
  entries.emplace_back(n - 1, n - 1, kHeld);
  gradient(0) = gradient(n - 1) = 0;
  Eigen::SparseMatrix<double> hessian(n, n);
  hessian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd step = SparseLdlt(hessian).solve(gradient);
  for (int i = 1; i + 1 < n; ++i) image[i] -= step(i);
  make_rising(image, last);
}

}  // namespace

void describe(OptionVisitor& v, RulingWarpOptions& o) {
  v.value("collinearity", o.collinearity,
          {.doc = "weight of the angle between successive rulings beside that of equal end angles",
           .min = 0,
           .max = 1e3});
  v.value("smoothness", o.smoothness,
          {.doc = "weight of second differences of the map when it is refined between nodes",
           .unit = "rad^2",
           .min = 1e-9,
           .max = 1e3});
}

RulingPath warp_rulings(const BorderRun& first, const BorderRun& second, WarpEnd end,
                        const RulingWarpOptions& options) {
  if (first.points.size() < 2 || second.points.size() < 2)
    throw Error("a run of a border has less than two nodes", "ruling warp");
  const WarpTable table(first, second, end, options);
  RulingPath path;
  path.cells = table.path_to(table.last_cell(end));
  path.image = image_of_cells(path.cells);
  constexpr int kRefinements = 8;
  for (int k = 0; k < kRefinements && path.image.back() > 0; ++k)
    refine_once(first, second, options.smoothness, path.image);
  return path;
}

}  // namespace geoprior::sketch
