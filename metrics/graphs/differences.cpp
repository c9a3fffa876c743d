#include "metrics/graphs/differences.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

double histogram_sum(std::span<const double> bins) {
  double sum = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (!std::isfinite(bins[i]) || bins[i] < 0)
      throw Error("is negative or not finite", "histogram, bin " + std::to_string(i));
    sum += bins[i];
  }
  if (!(sum > 0)) throw Error("is empty", "histogram");
  return sum;
}

}  // namespace

double histogram_distance(std::span<const double> a, std::span<const double> b) {
  const double sum_a = histogram_sum(a), sum_b = histogram_sum(b);
  double sum = 0;
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i)
    sum += std::abs((i < a.size() ? a[i] / sum_a : 0) - (i < b.size() ? b[i] / sum_b : 0));
  return sum / 2;
}

Eigen::VectorXd laplacian_spectrum(int nodes, std::span<const std::array<int, 2>> edges) {
  Eigen::MatrixXd adjacency = Eigen::MatrixXd::Zero(nodes, nodes);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [a, b] = edges[e];
    if (a < 0 || b < 0 || a >= nodes || b >= nodes)
      throw Error("ends at no node", "graph, edge " + std::to_string(e),
                  "0 to " + std::to_string(nodes - 1));
    if (a == b) continue;
    adjacency(a, b) += 1;
    adjacency(b, a) += 1;
  }
  if (nodes == 0) return {};
  const Eigen::VectorXd degree = adjacency.rowwise().sum();
  Eigen::VectorXd scale(nodes);
  for (int i = 0; i < nodes; ++i) scale[i] = degree[i] > 0 ? 1 / std::sqrt(degree[i]) : 0;
  Eigen::MatrixXd laplacian = -(scale.asDiagonal() * adjacency * scale.asDiagonal());
  for (int i = 0; i < nodes; ++i)
    if (degree[i] > 0) laplacian(i, i) += 1;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(laplacian, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

double spectral_distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() == 0 || b.size() == 0) throw Error("is empty", "spectrum");
  double sum = 0, at = 0;
  Eigen::Index i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double end_a = static_cast<double>(i + 1) / static_cast<double>(a.size());
    const double end_b = static_cast<double>(j + 1) / static_cast<double>(b.size());
    const double end = std::min(end_a, end_b);
    sum += (end - at) * std::abs(a[i] - b[j]);
    at = end;
    if (end_a <= end) ++i;
    if (end_b <= end) ++j;
  }
  return sum;
}

}  // namespace geoprior
