#include "solvers/sketch/surface/pinned_transfer.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/numerics/sparse_ldlt.h"
#include "core/parallel.h"

namespace geoprior::sketch {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Half the cotangents of the corners of each triangle, clamped.
Eigen::MatrixX3d half_cotangents(const Eigen::MatrixX3d& X, const Eigen::MatrixX3i& F) {
  Eigen::MatrixX3d half(F.rows(), 3);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = (X.row(F(t, (k + 1) % 3)) - X.row(F(t, k))).transpose();
      const Eigen::Vector3d b = (X.row(F(t, (k + 2) % 3)) - X.row(F(t, k))).transpose();
      const double area = a.cross(b).norm();
      const double cotangent = area > 0 ? a.dot(b) / area : 20;
      half(t, k) = 0.5 * std::clamp(cotangent, -2.0, 20.0);
    }
  }
  return half;
}

}  // namespace

struct PinnedTransfer::Impl {
  Eigen::MatrixX3i F;
  int n;
  EdgeConnectivity edges;
  Sparse pattern;             ///< lower triangle
  std::vector<int> diagonal;  ///< place of each vertex' entry in the pattern
  std::vector<int> off;       ///< place of each edge's
  std::array<SparseLdlt, 3> solver;
  std::array<bool, 3> factorised{};

  Impl(const Eigen::MatrixX3i& triangles, int vertex_count)
      : F(triangles), n(vertex_count), edges(triangles), pattern(vertex_count, vertex_count) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int v = 0; v < n; ++v) entries.emplace_back(v, v, 1.0);
    for (int e = 0; e < edges.edge_count(); ++e) {
      const Edge edge = edges.edge(e);
      entries.emplace_back(edge[1], edge[0], 0.0);
    }
    pattern.setFromTriplets(entries.begin(), entries.end());
    const auto place = [&](int row, int column) {
      const int* begin = pattern.innerIndexPtr() + pattern.outerIndexPtr()[column];
      const int* end = pattern.innerIndexPtr() + pattern.outerIndexPtr()[column + 1];
      return static_cast<int>(std::lower_bound(begin, end, row) - pattern.innerIndexPtr());
    };
    for (int v = 0; v < n; ++v) diagonal.push_back(place(v, v));
    for (int e = 0; e < edges.edge_count(); ++e)
      off.push_back(place(edges.edge(e)[1], edges.edge(e)[0]));
    parallel_blocks(3, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) solver[c].analyze(pattern);
    });
  }

  /// Weights of the edges, and right-hand sides of a surface whose triangles are turned.
  void assemble(const Eigen::MatrixX3d& X, const std::vector<Eigen::Matrix3d>& rotations,
                std::vector<double>& weight, Eigen::MatrixX3d& rhs) const {
    const Eigen::MatrixX3d half = half_cotangents(X, F);
    weight.assign(edges.edge_count(), 0);
    rhs.setZero(n, 3);
    for (int t = 0; t < F.rows(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int i = F(t, k), j = F(t, (k + 1) % 3);
        const double w = half(t, (k + 2) % 3);
        weight[edges.edge_of(3 * t + k)] += w;
        const Eigen::Vector3d turned = w * (rotations[t] * (X.row(i) - X.row(j)).transpose());
        rhs.row(i) += turned.transpose();
        rhs.row(j) -= turned.transpose();
      }
    }
  }

  /// The system of one coordinate: pinned rows become identities, what they give to others goes to
  /// the right-hand side.
  Eigen::VectorXd solve_coordinate(int c, const Eigen::MatrixX3d& X,
                                   const std::vector<double>& weight, Eigen::VectorXd rhs,
                                   std::vector<char> pinned, Eigen::VectorXd value) {
    const bool free = std::find(pinned.begin(), pinned.end(), 1) == pinned.end();
    if (free) {
      pinned[0] = 1;
      value[0] = X(0, c);
    }
    Sparse matrix = pattern;
    double* entry = matrix.valuePtr();
    for (const int place : diagonal) entry[place] = 0;
    for (int e = 0; e < edges.edge_count(); ++e) {
      const auto [i, j] = edges.edge(e);
      const double w = weight[e];
      if (!pinned[i]) entry[diagonal[i]] += w;
      if (!pinned[j]) entry[diagonal[j]] += w;
      if (!pinned[i] && !pinned[j]) entry[off[e]] = -w;
      if (pinned[i] && !pinned[j]) rhs[j] += w * value[i];
      if (pinned[j] && !pinned[i]) rhs[i] += w * value[j];
    }
    for (int v = 0; v < n; ++v) {
      if (!pinned[v]) continue;
      entry[diagonal[v]] = 1;
      rhs[v] = value[v];
    }
    solver[c].factorize(matrix);
    factorised[c] = solver[c].succeeded();
    if (!factorised[c]) return rhs;
    Eigen::VectorXd x = solver[c].solve(rhs);
    if (free) x.array() += X.col(c).mean() - x.mean();
    return x;
  }
};

PinnedTransfer::PinnedTransfer(const Eigen::MatrixX3i& F, int vertex_count)
    : impl_(std::make_unique<Impl>(F, vertex_count)) {}
PinnedTransfer::~PinnedTransfer() = default;
PinnedTransfer::PinnedTransfer(PinnedTransfer&&) noexcept = default;
PinnedTransfer& PinnedTransfer::operator=(PinnedTransfer&&) noexcept = default;

Eigen::MatrixX3d PinnedTransfer::solve(const Eigen::MatrixX3d& X,
                                       const std::vector<Eigen::Matrix3d>& rotations,
                                       const CoordinatePins& pins) {
  std::vector<double> weight;
  Eigen::MatrixX3d rhs;
  impl_->assemble(X, rotations, weight, rhs);
  Eigen::MatrixX3d solved(X.rows(), 3);
  parallel_blocks(3, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const int axis = static_cast<int>(c);
      solved.col(axis) = impl_->solve_coordinate(axis, X, weight, rhs.col(axis), pins.pinned[c],
                                                 pins.value.col(axis));
    }
  });
  for (int c = 0; c < 3; ++c) {
    if (!impl_->factorised[c] || !solved.col(c).allFinite()) {
      throw Error(std::string("the system of coordinate ") + "xyz"[c] + " cannot be solved",
                  "deformation transfer", "triangles with an area, at least one pin a part");
    }
  }
  return solved;
}

}  // namespace geoprior::sketch
