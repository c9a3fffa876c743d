#include "solvers/sketch/pattern/slope_parts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>

#include "core/connectivity.h"

namespace geoprior::sketch {
namespace {

constexpr int kLloydRounds = 12;
constexpr int kNormalPasses = 2;  ///< of averaging over neighbours: what is smaller is no part

/// Axis and cosine of a part.
struct Slope {
  Eigen::Vector3d axis{0, 0, 1};
  double cosine = 1;

  [[nodiscard]] double error(const Eigen::Vector3d& normal) const {
    const double off = normal.dot(axis) - cosine;
    return off * off;
  }
};

class SlopeDivision {
 public:
  explicit SlopeDivision(const TriMesh& mesh)
      : areas_(triangle_areas(mesh.V, mesh.F)), beside_(mesh.triangle_count()) {
    const EdgeConnectivity edges(mesh.F);
    for (int e = 0; e < edges.edge_count(); ++e) {
      const auto both = edges.half_edges(e);
      if (both.size() != 2) continue;
      beside_[both[0] / 3].push_back(both[1] / 3);
      beside_[both[1] / 3].push_back(both[0] / 3);
    }
    const Eigen::MatrixX3d N = triangle_normals(mesh);
    for (int t = 0; t < mesh.triangle_count(); ++t) normals_.emplace_back(N.row(t).transpose());
    for (int pass = 0; pass < kNormalPasses; ++pass) average_normals();
  }

  std::vector<std::vector<int>> divide(int most) {
    std::vector<std::vector<int>> divisions;
    part_.assign(normals_.size(), 0);
    slopes_ = {fitted(0)};
    while (std::ssize(slopes_) < most) {
      const int seed = worst_triangle();
      slopes_.push_back({normals_[seed], 1});
      std::vector<int> seeds = best_triangles();
      seeds.back() = seed;
      for (int round = 0; round < kLloydRounds; ++round) {
        grow(seeds);
        for (std::size_t p = 0; p < slopes_.size(); ++p) slopes_[p] = fitted(static_cast<int>(p));
        seeds = best_triangles();
      }
      divisions.push_back(part_);
    }
    return divisions;
  }

 private:
  void average_normals() {
    const std::vector<Eigen::Vector3d> before = normals_;
    for (std::size_t t = 0; t < normals_.size(); ++t) {
      Eigen::Vector3d sum = areas_(t) * before[t];
      for (const int s : beside_[t]) sum += areas_(s) * before[s];
      if (sum.norm() > 0) normals_[t] = sum.normalized();
    }
  }

  [[nodiscard]] Slope fitted(int part) const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double area = 0;
    for (std::size_t t = 0; t < part_.size(); ++t) {
      if (part_[t] != part) continue;
      mean += areas_(t) * normals_[t];
      area += areas_(t);
    }
    if (!(area > 0)) return slopes_[part];
    mean /= area;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t t = 0; t < part_.size(); ++t) {
      if (part_[t] != part) continue;
      const Eigen::Vector3d off = normals_[t] - mean;
      spread += areas_(t) * off * off.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
    Slope slope;
    slope.axis = eigen.eigenvectors().col(0);
    slope.cosine = slope.axis.dot(mean);
    return slope;
  }

  [[nodiscard]] int worst_triangle() const {
    int worst = 0;
    double most = -1;
    for (std::size_t t = 0; t < part_.size(); ++t) {
      const double error = slopes_[part_[t]].error(normals_[t]);
      if (error <= most) continue;
      most = error;
      worst = static_cast<int>(t);
    }
    return worst;
  }

  /// Of each part the triangle of least error.
  [[nodiscard]] std::vector<int> best_triangles() const {
    std::vector<int> best(slopes_.size(), 0);
    std::vector<double> least(slopes_.size(), std::numeric_limits<double>::infinity());
    for (std::size_t t = 0; t < part_.size(); ++t) {
      const double error = slopes_[part_[t]].error(normals_[t]);
      if (error >= least[part_[t]]) continue;
      least[part_[t]] = error;
      best[part_[t]] = static_cast<int>(t);
    }
    return best;
  }

  void grow(const std::vector<int>& seeds) {
    using Reached = std::tuple<double, int, int>;  // error, triangle, part
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    std::fill(part_.begin(), part_.end(), -1);
    for (std::size_t p = 0; p < seeds.size(); ++p)
      queue.emplace(-1.0, seeds[p], static_cast<int>(p));
    while (!queue.empty()) {
      const auto [error, t, p] = queue.top();
      queue.pop();
      if (part_[t] >= 0) continue;
      part_[t] = p;
      for (const int s : beside_[t]) {
        if (part_[s] < 0) queue.emplace(slopes_[p].error(normals_[s]), s, p);
      }
    }
    for (int& p : part_) p = std::max(p, 0);  // what no seed reaches
  }

  Eigen::VectorXd areas_;
  std::vector<std::vector<int>> beside_;  ///< triangles across the edges of each
  std::vector<Eigen::Vector3d> normals_;
  std::vector<int> part_;
  std::vector<Slope> slopes_;
};

}  // namespace

std::vector<std::vector<int>> slope_parts(const TriMesh& mesh, int most) {
  return SlopeDivision(mesh).divide(most);
}

}  // namespace geoprior::sketch
