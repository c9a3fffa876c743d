#include "baselines/paper/adaptive/pop_filter.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/planar.h"
#include "core/numerics/sparse_ldlt.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/sheet/pattern_locator.h"
#include "models/paper/shell/elements.h"

namespace geoprior::paper {
namespace {

using Order = ShellElements::Order;

constexpr int kSteps = 5;
/// mu: stiffness per mass with which a vertex stays where it is (1/s^2). Far below that of bending
/// at the scale of a small triangle, so that it only rules out free motion.
constexpr double kStay = 1e3;
/// Halvings of a step before the filter gives up.
constexpr int kHalvings = 10;

Eigen::VectorXd vertex_areas(const ShellMesh& mesh) {
  Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    const Eigen::Vector2d a = mesh.pattern.row(mesh.triangles(f, 0)),
                          b = mesh.pattern.row(mesh.triangles(f, 1)),
                          c = mesh.pattern.row(mesh.triangles(f, 2));
    for (int k = 0; k < 3; ++k) area[mesh.triangles(f, k)] += cross(b - a, c - a) / 6;
  }
  return area;
}

/// The objective of the filter over the positions of the vertices that may move.
class Relaxation {
 public:
  Relaxation(const Sheet& sheet, const StepperOptions& options, const ShellState& before,
             const Eigen::MatrixX3d& forces, const std::vector<bool>& changed,
             const std::vector<int>& held, const ShellState& state);

  /// Newton step for the vertices that may move; false when none can.
  bool step(Eigen::MatrixX3d& x) const;

 private:
  [[nodiscard]] double objective(const Eigen::MatrixX3d& x) const;
  void assemble(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient,
                Eigen::SparseMatrix<double>& hessian) const;

  const ShellState& state_;
  Eigen::MatrixX3d start_;
  Eigen::MatrixX3d load_;     ///< per vertex, that balanced the old mesh (N)
  Eigen::VectorXd stay_;      ///< mu m_i (N/m)
  std::vector<int> unknown_;  ///< number of each vertex among those that move, -1
  int unknowns_ = 0;
  ShellElements elements_;
  std::vector<int> active_;  ///< elements with a vertex that moves
};

Relaxation::Relaxation(const Sheet& sheet, const StepperOptions& options, const ShellState& before,
                       const Eigen::MatrixX3d& forces, const std::vector<bool>& changed,
                       const std::vector<int>& held, const ShellState& state)
    : state_(state), start_(state.x), elements_(state.mesh, sheet.material, options.bending) {
  const Eigen::VectorXd area = vertex_areas(state.mesh);
  const Eigen::MatrixX3d density = forces.array().colwise() / vertex_areas(before.mesh).array();
  const PatternLocator locator(before.mesh);
  const int n = state.mesh.vertex_count();
  load_ = Eigen::MatrixX3d::Zero(n, 3);
  unknown_.assign(n, -1);
  for (int v = 0; v < n; ++v) {
    if (!changed[v]) continue;
    if (std::binary_search(held.begin(), held.end(), v)) continue;
    unknown_[v] = unknowns_++;
    const PatternLocator::Place place = locator.locate(state.mesh.pattern.row(v));
    for (int k = 0; k < 3; ++k) {
      load_.row(v) -=
          area[v] * place.weights[k] * density.row(before.mesh.triangles(place.triangle, k));
    }
  }
  stay_ = kStay * sheet.material.area_density * area;
  for (int e = 0; e < elements_.size(); ++e) {
    const auto nodes = elements_.nodes(e);
    if (std::any_of(nodes.begin(), nodes.end(), [&](int v) { return unknown_[v] >= 0; })) {
      active_.push_back(e);
    }
  }
}

double Relaxation::objective(const Eigen::MatrixX3d& x) const {
  ShellElements::Local local;
  double sum = 0;
  for (const int e : active_) {
    elements_.evaluate(e, state_, x, Order::energy, local);
    sum += local.membrane + local.bending;
  }
  for (int v = 0; v < state_.mesh.vertex_count(); ++v) {
    if (unknown_[v] < 0) continue;
    const Eigen::RowVector3d d = x.row(v) - start_.row(v);
    sum += 0.5 * stay_[v] * d.squaredNorm() - load_.row(v).dot(d);
  }
  return sum;
}

void Relaxation::assemble(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient,
                          Eigen::SparseMatrix<double>& hessian) const {
  gradient = Eigen::VectorXd::Zero(3 * unknowns_);
  std::vector<Eigen::Triplet<double>> entries;
  ShellElements::Local local;
  for (const int e : active_) {
    elements_.evaluate(e, state_, x, Order::hessian, local);
    const auto nodes = elements_.nodes(e);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const int row = unknown_[nodes[i]];
      if (row < 0) continue;
      const Eigen::Index at = 3 * i;
      gradient.segment<3>(3 * row) += local.gradient.segment<3>(at);
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        const int column = unknown_[nodes[j]];
        if (column < 0) continue;
        for (int p = 0; p < 3; ++p) {
          for (int q = 0; q < 3; ++q) {
            entries.emplace_back(3 * row + p, 3 * column + q,
                                 local.hessian(at + p, static_cast<Eigen::Index>(3 * j) + q));
          }
        }
      }
    }
  }
  for (int v = 0; v < state_.mesh.vertex_count(); ++v) {
    const int row = unknown_[v];
    if (row < 0) continue;
    gradient.segment<3>(3 * row) +=
        (stay_[v] * (x.row(v) - start_.row(v)) - load_.row(v)).transpose();
    for (int p = 0; p < 3; ++p) entries.emplace_back(3 * row + p, 3 * row + p, stay_[v]);
  }
  hessian.resize(3 * unknowns_, 3 * unknowns_);
  hessian.setFromTriplets(entries.begin(), entries.end());
}

bool Relaxation::step(Eigen::MatrixX3d& x) const {
  if (unknowns_ == 0) return false;
  Eigen::VectorXd gradient;
  Eigen::SparseMatrix<double> hessian;
  assemble(x, gradient, hessian);
  const SparseLdlt factor(hessian);
  if (!factor.succeeded()) return false;
  const Eigen::VectorXd move = factor.solve(gradient);
  const double here = objective(x), slope = gradient.dot(move);
  double share = 1;
  for (int halving = 0; halving <= kHalvings; ++halving, share /= 2) {
    Eigen::MatrixX3d moved = x;
    for (int v = 0; v < state_.mesh.vertex_count(); ++v) {
      const int row = unknown_[v];
      if (row >= 0) moved.row(v) -= share * move.segment<3>(3 * row).transpose();
    }
    if (!(objective(moved) <= here - 1e-4 * share * slope)) continue;
    x = moved;
    return true;
  }
  return false;
}

}  // namespace

int filter_pops(const Sheet& sheet, const StepperOptions& options, const ShellState& before,
                const Eigen::MatrixX3d& forces, const std::vector<bool>& changed,
                const std::vector<int>& held, ShellState& state) {
  const Relaxation relaxation(sheet, options, before, forces, changed, held, state);
  Eigen::MatrixX3d x = state.x;
  int steps = 0;
  while (steps < kSteps && relaxation.step(x)) ++steps;
  state.x = x;
  return steps;
}

}  // namespace geoprior::paper
