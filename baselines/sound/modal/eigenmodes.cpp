#include "baselines/sound/modal/eigenmodes.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/numerics/sparse_ldlt.h"
#include "core/random.h"

namespace geoprior::sound {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Below this many unknowns, and where a third of all modes is wanted, the matrix is taken as
/// dense.
constexpr int kDense = 150;
/// Searches for modes that were missed.
constexpr int kMostRounds = 6;

/// Eigenvalues of the operator in units of `unit`, and their vectors.
struct Pairs {
  Eigen::VectorXd value;
  Eigen::MatrixXd vector;
};

/// Factorisation of A - shift I.
class ShiftedFactor {
 public:
  explicit ShiftedFactor(const Sparse& A) : A_(A) { solver_.analyze(A); }

  void factorise(double shift) {
    solver_.factorize(A_, -shift);
    if (!solver_.succeeded()) throw Error("the stiffness cannot be factorised", "modes of a sheet");
  }
  /// Eigenvalues of A below the shift (Sylvester's law of inertia).
  [[nodiscard]] int count_below() const {
    return static_cast<int>((solver_.pivots().array() < 0).count());
  }
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return solver_.solve(b); }

 private:
  const Sparse& A_;
  SparseLdlt solver_;
};

/// P (A - sigma I)^-1 P, P taking out the columns of `known`, as Spectra wants it.
class DeflatedInverse {
 public:
  using Scalar = double;
  DeflatedInverse(ShiftedFactor& factor, const Eigen::MatrixXd& known)
      : factor_(factor), known_(known) {}
  [[nodiscard]] Eigen::Index rows() const { return known_.rows(); }
  [[nodiscard]] Eigen::Index cols() const { return known_.rows(); }
  void set_shift(double sigma) { factor_.factorise(sigma); }
  void perform_op(const double* in, double* out) const {
    Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(in, rows());
    take_out(y);
    y = factor_.solve(y);
    take_out(y);
    Eigen::Map<Eigen::VectorXd>(out, rows()) = y;
  }
  void take_out(Eigen::VectorXd& y) const { y -= known_ * (known_.transpose() * y); }

 private:
  ShiftedFactor& factor_;
  const Eigen::MatrixXd& known_;
};

/// The lowest `count` pairs beside the known vectors, from a random start.
Pairs lanczos(ShiftedFactor& factor, const Eigen::MatrixXd& known, int count, int round) {
  const auto n = static_cast<int>(known.rows());
  DeflatedInverse inverse(factor, known);
  const int basis = std::min(n, 2 * count + 20);
  Spectra::SymEigsShiftSolver<DeflatedInverse> solver(inverse, count, basis, -1);
  RandomStream random(static_cast<std::uint64_t>(round), "modes of a sheet");
  Eigen::VectorXd start(n);
  for (double& x : start) x = random.normal();
  inverse.take_out(start);
  try {
    solver.init(start.data());
    solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-10, Spectra::SortRule::SmallestAlge);
  } catch (const std::exception& error) {
    throw Error("Lanczos' method fails: " + std::string(error.what()), "modes of a sheet");
  }
  if (solver.info() != Spectra::CompInfo::Successful)
    throw Error("Lanczos' method does not converge", "modes of a sheet");
  return {solver.eigenvalues(), solver.eigenvectors()};
}

/// Columns of both in the order of their values.
Pairs merged(const Pairs& a, const Pairs& b) {
  Eigen::VectorXd value(a.value.size() + b.value.size());
  value << a.value, b.value;
  Eigen::MatrixXd vector(b.vector.rows(), value.size());
  vector << a.vector, b.vector;
  std::vector<int> order(value.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return value[i] < value[j]; });
  return {value(order), vector(Eigen::all, order)};
}

Pairs lowest_sparse(const Sparse& A, const Eigen::MatrixXd& rigid, int count) {
  ShiftedFactor factor(A);
  Pairs found{{}, Eigen::MatrixXd(A.rows(), 0)};
  int missing = count;
  for (int round = 0; round < kMostRounds && missing > 0; ++round) {
    Eigen::MatrixXd known(A.rows(), rigid.cols() + found.vector.cols());
    known << rigid, found.vector;
    found = merged(found, lanczos(factor, known, missing, round));
    // Counted just below the last one wanted, which may have equals.
    const double last = found.value[count - 1] * (1 - 1e-6);
    factor.factorise(last);
    const auto below = static_cast<int>((found.value.array() < last).count());
    missing = factor.count_below() - static_cast<int>(rigid.cols()) - below;
  }
  if (missing > 0)
    throw Error(std::to_string(missing) + " modes were not found", "modes of a sheet");
  return {found.value.head(count), found.vector.leftCols(count)};
}

Pairs lowest_dense(const Sparse& A, const Eigen::MatrixXd& rigid, int count) {
  Eigen::MatrixXd full = A;  // lower triangle, as the solver reads it
  // Rigid motions are lifted above all modes.
  full += 2 * full.norm() * rigid * rigid.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(full);
  return {solver.eigenvalues().head(count), solver.eigenvectors().leftCols(count)};
}

/// The component that is the first of the largest is positive.
void fix_signs(Eigen::MatrixXd& shape) {
  for (Eigen::Index k = 0; k < shape.cols(); ++k) {
    Eigen::Index at = 0;
    const double largest = shape.col(k).cwiseAbs().maxCoeff();
    while (std::abs(shape(at, k)) < (1 - 1e-6) * largest) ++at;
    if (shape(at, k) < 0) shape.col(k) *= -1;
  }
}

double area(const ShellMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) sum += pattern_area(mesh, t);
  return sum;
}

int wanted_modes(const ModalOperator& op, const Sparse& A, double unit,
                 const ModalOptions& options) {
  const auto rigid = static_cast<int>(op.rigid.cols());
  const int available = op.unknowns - rigid;
  if (options.most < 1)
    throw Error(std::to_string(options.most) + " modes are asked for", "most", "1 or more");
  if (!options.up_to) {
    if (options.most <= available) return options.most;
    throw Error(std::to_string(options.most) + " modes are asked for of a mesh with " +
                    std::to_string(op.mass.size()) + " vertices",
                "most", "at most " + std::to_string(available));
  }
  if (!std::isfinite(*options.up_to) || !(*options.up_to > 0))
    throw Error("is not positive", "up_to", "a frequency in Hz");
  const double omega = 2 * std::numbers::pi * *options.up_to;
  ShiftedFactor factor(A);
  factor.factorise(omega * omega / unit);
  return std::min({options.most, available, factor.count_below() - rigid});
}

}  // namespace

Modes eigenmodes(const PaperMaterial& material, const ShellState& state,
                 const ModalSupports& supports, const ModalOptions& options) {
  const ModalOperator op(material, state, supports, options.bending);
  const double unit =
      100 * material.bending_stiffness() / (material.area_density * std::pow(area(state.mesh), 2));
  const Sparse A = op.stiffness / unit;
  const int count = wanted_modes(op, A, unit, options);
  Modes modes;
  modes.mass = op.mass;
  if (count <= 0) {
    modes.shape.resize(3 * op.mass.size(), 0);
    return modes;
  }
  const bool dense = op.unknowns <= kDense || 3 * (count + 10) > op.unknowns;
  const Pairs pairs = dense ? lowest_dense(A, op.rigid, count) : lowest_sparse(A, op.rigid, count);
  modes.frequency = (unit * pairs.value.cwiseMax(0)).cwiseSqrt() / (2 * std::numbers::pi);
  modes.shape = op.displacements(pairs.vector);
  fix_signs(modes.shape);
  return modes;
}

double resolved_frequency(const PaperMaterial& material, const ShellMesh& mesh) {
  const EdgeConnectivity edges(mesh.triangles);
  double length = 0;
  for (const auto& [u, v] : edges.edges())
    length += (mesh.pattern.row(u) - mesh.pattern.row(v)).norm();
  length /= edges.edge_count();
  const double k = 2 * std::numbers::pi / (8 * length);
  return k * k * std::sqrt(material.bending_stiffness() / material.area_density) /
         (2 * std::numbers::pi);
}

}  // namespace geoprior::sound
