#include "experiments/skinning/weights/box_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/numerics/sparse_ldlt.h"
#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

/// Multipliers and bounds that are violated by less, in units of x, are round-off.
constexpr double kRoundOff = 1e-11;

/// Unknowns whose unbounded values are this near to a bound, or beyond it, are held there at first.
constexpr double kHeldAtFirst = 0.01;

/// Where changes of all violating unknowns go round in circles, conditions that hold to this are
/// met, and of what violates them only what does so by this share of the largest violation changes.
constexpr double kNegligible = 1e-5;
constexpr double kLargeShare = 0.3;

/// Changes of all violating unknowns in a row that may leave no fewer of them.
constexpr int kBlockChances = 10;

void require_factor(const SparseLdlt& factor) {
  if (!factor.succeeded())
    throw Error("a quadratic program of the weights has no unique solution", "bounded weights",
                "a mesh without degenerate parts");
}

/// One column: which unknowns are free, and what follows from that.
class ActiveSet {
 public:
  ActiveSet(const Eigen::SparseMatrix<double>& Q, const Eigen::VectorXd& diagonal,
            const Eigen::VectorXd& c, const Eigen::VectorXd& unbounded)
      : Q_(Q), diagonal_(diagonal), c_(c), x_(unbounded), bound_(unbounded.size(), Bound::none) {
    for (Eigen::Index i = 0; i < x_.size(); ++i) hold_outside(i, kHeldAtFirst);
  }

  /// Solves for the free unknowns and lists those that violate a condition.
  void solve() {
    std::vector<int> free_index(bound_.size(), -1);
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (bound_[i] == Bound::none) {
        free_index[i] = static_cast<int>(free.size());
        free.push_back(i);
      } else {
        x_(i) = bound_[i] == Bound::lower ? 0 : 1;
      }
    }
    solve_free(free, free_index);
    gradient_ = Q_ * x_ - c_;
    violating_.clear();
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (violation(i) > kRoundOff) violating_.push_back(i);
    }
  }

  [[nodiscard]] const std::vector<Eigen::Index>& violating() const { return violating_; }

  /// Changes the unknowns that violate a condition by at least this share of the largest violation.
  void change_violating(double share) {
    double largest = 0;
    for (const Eigen::Index i : violating_) largest = std::max(largest, violation(i));
    for (const Eigen::Index i : violating_) {
      if (violation(i) < share * largest) continue;
      if (bound_[i] == Bound::none) {
        hold_outside(i);
      } else {
        bound_[i] = Bound::none;
      }
    }
  }

  [[nodiscard]] Eigen::VectorXd bounded() const { return x_.cwiseMax(0.0).cwiseMin(1.0); }
  [[nodiscard]] double residual() const {
    double worst = 0;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      worst = std::max(worst, violation(i));
      if (bound_[i] == Bound::none) worst = std::max(worst, std::abs(gradient_(i)) / diagonal_(i));
    }
    return worst;
  }

 private:
  enum class Bound : char { none, lower, upper };

  void hold_outside(Eigen::Index i, double margin = 0) {
    if (x_(i) < margin) bound_[i] = Bound::lower;
    if (x_(i) > 1 - margin) bound_[i] = Bound::upper;
  }

  [[nodiscard]] double violation(Eigen::Index i) const {
    if (bound_[i] == Bound::none) return std::max(-x_(i), x_(i) - 1);
    return (bound_[i] == Bound::lower ? -gradient_(i) : gradient_(i)) / diagonal_(i);
  }

  void solve_free(const std::vector<Eigen::Index>& free, const std::vector<int>& free_index) {
    if (free.empty()) return;
    const Eigen::Index n = free.size();
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd rhs(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      rhs(k) = c_(free[k]);
      for (Eigen::SparseMatrix<double>::InnerIterator it(Q_, free[k]); it; ++it) {
        if (free_index[it.row()] >= 0) {
          entries.emplace_back(free_index[it.row()], static_cast<int>(k), it.value());
        } else {
          rhs(k) -= it.value() * x_(it.row());
        }
      }
    }
    Eigen::SparseMatrix<double> part(n, n);
    part.setFromTriplets(entries.begin(), entries.end());
    const SparseLdlt factor(part);
    require_factor(factor);
    const Eigen::VectorXd solution = factor.solve(rhs);
    for (Eigen::Index k = 0; k < n; ++k) x_(free[k]) = solution(k);
  }

  const Eigen::SparseMatrix<double>& Q_;
  const Eigen::VectorXd& diagonal_;
  Eigen::VectorXd c_;
  Eigen::VectorXd x_;
  Eigen::VectorXd gradient_;
  std::vector<Bound> bound_;
  std::vector<Eigen::Index> violating_;
};

/// Changes the active set until nothing violates a condition; returns how often.
int pivot(ActiveSet& set, int max_pivots) {
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int chances = kBlockChances;
  for (int pivots = 1; pivots <= max_pivots; ++pivots) {
    set.solve();
    const std::vector<Eigen::Index>& violating = set.violating();
    if (violating.empty()) return pivots;
    const bool fewer = violating.size() < fewest;
    if (fewer) fewest = violating.size();
    chances = fewer ? kBlockChances : chances - 1;
    if (chances < 0 && set.residual() <= kNegligible) return pivots;
    set.change_violating(chances < 0 ? kLargeShare : 0);
  }
  throw Error("the bounded weights of a bone were not found in " + std::to_string(max_pivots) +
                  " changes of the active set: " + std::to_string(set.violating().size()) +
                  " vertices violate a bound",
              "bounded weights", "a shorter length, or a mesh without slivers");
}

}  // namespace

BoxSolution solve_in_box(const BoxProgram& program, int max_pivots) {
  const SparseLdlt factor(program.Q);
  require_factor(factor);
  const Eigen::VectorXd diagonal = program.Q.diagonal();
  const std::size_t m = program.C.cols();
  BoxSolution solution;
  solution.X.resize(program.C.rows(), program.C.cols());
  std::vector<int> pivots(m);
  std::vector<double> residual(m);
  parallel_blocks(m, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const Eigen::VectorXd c = program.C.col(j);
      ActiveSet set(program.Q, diagonal, c, factor.solve(c));
      pivots[j] = pivot(set, max_pivots);
      residual[j] = set.residual();
      solution.X.col(j) = set.bounded();
    }
  });
  solution.pivots = *std::max_element(pivots.begin(), pivots.end());
  solution.residual = *std::max_element(residual.begin(), residual.end());
  return solution;
}

}  // namespace geoprior::skinning
