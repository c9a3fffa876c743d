#include "baselines/sketch/flatten/abf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "baselines/sketch/flatten/lscm.h"
#include "core/angles.h"
#include "core/geometry/topology.h"
#include "core/numerics/sparse_ldlt.h"
#include "models/sketch/flatten/conformal_energy.h"
#include "models/sketch/flatten/flat_triangles.h"
#include "models/sketch/pattern/piece_borders.h"

namespace geoprior::sketch {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLeastCurvature = 0.1;  ///< of the Lagrangian, over the objective's own
constexpr double kShareOfAngle = 0.9;    ///< of the way to an angle of 0 or pi
constexpr double kAngleArmijo = 1e-4;
constexpr double kRoundOff = 1e-13;
constexpr int kMostAngleHalvings = 30;
constexpr double kLargestLayoutCotangent = 1e8;

/// Constraints of the inner vertices on the angles of one triangle: rows 2 k and 2 k + 1 are sum
/// and wheel of the vertex at corner k.
using TriangleRows = Eigen::Matrix<double, 6, 3>;
using PerTriangle = Eigen::Vector3d;

class AngleFlattening {
 public:
  AngleFlattening(const TriMesh& disc, double least_angle);

  /// One Newton step.
  /// @return  largest change of an angle (rad), negative when the system could not be solved
  double step();
  /// Largest violation of the constraints.
  [[nodiscard]] double violation() const;
  [[nodiscard]] const Eigen::MatrixX3d& angle() const { return angle_; }

 private:
  [[nodiscard]] TriangleRows rows(int t) const;
  [[nodiscard]] PerTriangle curvature(int t) const;
  [[nodiscard]] PerTriangle pull(int t) const {
    return weight_.row(t).transpose().cwiseProduct((angle_ - aim_).row(t).transpose());
  }
  /// Unknown of row i of a triangle; -1 at the border.
  [[nodiscard]] int unknown(int t, int i) const {
    const int inner = inner_[F_(t, i / 2)];
    return inner < 0 ? -1 : 2 * inner + i % 2;
  }
  [[nodiscard]] Eigen::VectorXd residuals(const Eigen::MatrixX3d& angle) const;
  [[nodiscard]] double merit(const Eigen::MatrixX3d& angle) const;
  void go(const Eigen::MatrixX3d& change);
  bool solve_multipliers();
  [[nodiscard]] Eigen::Matrix<double, 6, 1> multipliers_at(int t) const;

  const Eigen::MatrixX3i& F_;
  std::vector<int> inner_;  ///< number among the inner vertices; -1 at the border
  int inner_count_ = 0;
  Eigen::MatrixX3d aim_, weight_, angle_;  ///< beta, beta^-2, alpha
  double penalty_ = 0;                     ///< of the constraints in the merit function
  Eigen::VectorXd multiplier_;             ///< of sum and wheel of every inner vertex
  SparseLdlt factor_;
  bool analysed_ = false;
};

AngleFlattening::AngleFlattening(const TriMesh& disc, double least_angle)
    : F_(disc.F), inner_(disc.vertex_count(), -1), aim_(disc.F.rows(), 3) {
  const std::vector<bool> border = boundary_vertices(disc.F, disc.vertex_count());
  for (int v = 0; v < disc.vertex_count(); ++v) {
    if (!border[v]) inner_[v] = inner_count_++;
  }
  const std::vector<FlatTriangle> triangles = flat_triangles(disc);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(disc.vertex_count());
  for (int t = 0; t < disc.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      aim_(t, k) = std::clamp(triangles[t].angle[k], least_angle, kPi - 2 * least_angle);
      sum(F_(t, k)) += aim_(t, k);
    }
  }
  for (int t = 0; t < disc.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (inner_[F_(t, k)] >= 0) aim_(t, k) *= kFullTurn / sum(F_(t, k));
    }
  }
  weight_ = aim_.cwiseAbs2().cwiseInverse();
  // At a saddle's tip an aim may be raised, at a peak's to more than a triangle allows.
  angle_ = aim_.cwiseMin(kPi - 2 * least_angle);
  multiplier_ = Eigen::VectorXd::Zero(2 * inner_count_);
}

TriangleRows AngleFlattening::rows(int t) const {
  TriangleRows rows = TriangleRows::Zero();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    rows(2 * k, k) = 1;
    rows(2 * k + 1, next) = 1 / std::tan(angle_(t, next));
    rows(2 * k + 1, last) = -1 / std::tan(angle_(t, last));
  }
  return rows;
}

Eigen::Matrix<double, 6, 1> AngleFlattening::multipliers_at(int t) const {
  Eigen::Matrix<double, 6, 1> at;
  for (int i = 0; i < 6; ++i) at(i) = unknown(t, i) < 0 ? 0 : multiplier_(unknown(t, i));
  return at;
}

/// Second derivatives of the Lagrangian: d^2 log sin x / dx^2 = -1 / sin^2 x.
PerTriangle AngleFlattening::curvature(int t) const {
  const Eigen::Matrix<double, 6, 1> multiplier = multipliers_at(t);
  PerTriangle diagonal;
  for (int k = 0; k < 3; ++k) {
    const double sine = std::sin(angle_(t, k));
    const double wheels = multiplier(2 * ((k + 1) % 3) + 1) - multiplier(2 * ((k + 2) % 3) + 1);
    diagonal(k) = std::max(weight_(t, k) + wheels / (sine * sine), kLeastCurvature * weight_(t, k));
  }
  return diagonal;
}

/// Of the inner vertices' constraints, in the order of the unknowns.
Eigen::VectorXd AngleFlattening::residuals(const Eigen::MatrixX3d& angle) const {
  Eigen::VectorXd residual(2 * inner_count_);
  for (int i = 0; i < inner_count_; ++i) residual.segment<2>(2 * i) << -kFullTurn, 0;
  for (int t = 0; t < F_.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (inner_[F_(t, k)] < 0) continue;
      residual(unknown(t, 2 * k)) += angle(t, k);
      residual(unknown(t, 2 * k + 1)) +=
          std::log(std::sin(angle(t, (k + 1) % 3)) / std::sin(angle(t, (k + 2) % 3)));
    }
  }
  return residual;
}

double AngleFlattening::violation() const {
  const double triangles = (angle_.rowwise().sum().array() - kPi).abs().maxCoeff();
  return inner_count_ > 0 ? std::max(triangles, residuals(angle_).cwiseAbs().maxCoeff())
                          : triangles;
}

/// With H the diagonal Hessian, g the gradient of the objective, J the constraints and c their
/// residuals: (J H^-1 J') multiplier = c - J H^-1 g. The triangles' rows of J are eliminated one by
/// one: each acts on its own angles alone.
bool AngleFlattening::solve_multipliers() {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(21 * F_.rows());
  Eigen::VectorXd right = residuals(angle_);
  for (int t = 0; t < F_.rows(); ++t) {
    const PerTriangle inverse = curvature(t).cwiseInverse();
    const TriangleRows scaled = rows(t) * inverse.asDiagonal();
    const Eigen::Matrix<double, 6, 1> coupling = scaled.rowwise().sum();
    const double own = inverse.sum();
    const PerTriangle gradient = pull(t);
    const double own_right = angle_.row(t).sum() - kPi - inverse.dot(gradient);
    const Eigen::Matrix<double, 6, 6> block =
        scaled * rows(t).transpose() - coupling * coupling.transpose() / own;
    const Eigen::Matrix<double, 6, 1> part = scaled * gradient + coupling * (own_right / own);
    for (int i = 0; i < 6; ++i) {
      const int row = unknown(t, i);
      if (row < 0) continue;
      right(row) -= part(i);
      for (int j = 0; j < 6; ++j) {
        const int column = unknown(t, j);
        if (column >= 0 && row >= column) entries.emplace_back(row, column, block(i, j));
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(right.size(), right.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  if (!analysed_) factor_.analyze(matrix);
  analysed_ = true;
  factor_.factorize(matrix);
  if (!factor_.succeeded()) return false;
  const Eigen::VectorXd solved = factor_.solve(right);
  if (!solved.allFinite()) return false;
  multiplier_ = solved;
  return true;
}

double AngleFlattening::merit(const Eigen::MatrixX3d& angle) const {
  return weight_.cwiseProduct((angle - aim_).cwiseAbs2()).sum() / 2 +
         penalty_ *
             ((angle.rowwise().sum().array() - kPi).abs().sum() + residuals(angle).lpNorm<1>());
}

/// Goes along a Newton step until the merit function falls enough; at a penalty above the
/// multipliers every Newton step lowers it at first (Han 1977).
void AngleFlattening::go(const Eigen::MatrixX3d& change) {
  double length = 1;
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    const double d = change.data()[i], at = angle_.data()[i];
    const double room = d < 0 ? at : kPi - at;
    if (std::abs(d) * length > kShareOfAngle * room) length = kShareOfAngle * room / std::abs(d);
  }
  const double before = merit(angle_);
  const double objective = weight_.cwiseProduct((angle_ - aim_).cwiseAbs2()).sum() / 2;
  const double slope =
      weight_.cwiseProduct(angle_ - aim_).cwiseProduct(change).sum() - (before - objective);
  for (int halvings = 0; halvings < kMostAngleHalvings; ++halvings, length /= 2) {
    const Eigen::MatrixX3d tried = angle_ + length * change;
    if (merit(tried) <= before + kAngleArmijo * length * slope + kRoundOff * before) {
      angle_ = tried;
      return;
    }
  }
}

double AngleFlattening::step() {
  const Eigen::Index m = F_.rows();
  Eigen::MatrixX3d inverse(m, 3);  // before the multipliers change
  for (int t = 0; t < static_cast<int>(m); ++t)
    inverse.row(t) = curvature(t).cwiseInverse().transpose();
  if (inner_count_ > 0 && !solve_multipliers()) return -1;
  penalty_ = std::max(penalty_, inner_count_ > 0 ? 2 * multiplier_.cwiseAbs().maxCoeff() : 0.0);
  Eigen::MatrixX3d change(m, 3);
  for (int t = 0; t < static_cast<int>(m); ++t) {
    const PerTriangle h = inverse.row(t).transpose();
    PerTriangle force = pull(t) + rows(t).transpose() * multipliers_at(t);
    const double own = (angle_.row(t).sum() - kPi - h.dot(force)) / h.sum();
    penalty_ = std::max(penalty_, 2 * std::abs(own));
    force.array() += own;
    change.row(t) = -h.cwiseProduct(force).transpose();
  }
  go(change);
  return change.cwiseAbs().maxCoeff();
}

}  // namespace

AbfAngles abf_angles(const TriMesh& disc) {
  constexpr int kNewtonSteps = 100;               // most; ten are usual
  constexpr double kAbfTolerance = 1e-11;         // of the constraints and of the last angles (rad)
  constexpr double kLeastAngle = 0.05 * kDegree;  // angles of thinner triangles are aimed at this
  disc_border(disc, "angle-based flattening");
  AngleFlattening problem(disc, kLeastAngle);
  AbfAngles result;
  while (result.iterations < kNewtonSteps && !result.converged) {
    ++result.iterations;
    const double change = problem.step();
    if (change < 0) break;
    result.converged = change <= std::sqrt(kAbfTolerance) && problem.violation() <= kAbfTolerance;
  }
  result.angle = problem.angle();
  result.constraint = problem.violation();
  return result;
}

Eigen::MatrixX2d flatten_abf(const TriMesh& disc) {
  const std::vector<int> border = disc_border(disc, "angle-based flattening");
  const AbfAngles angles = abf_angles(disc);
  std::vector<std::array<double, 3>> cot;
  cot.reserve(disc.triangle_count());
  for (int t = 0; t < disc.triangle_count(); ++t) {
    cot.push_back(opposite_cotangents({angles.angle(t, 0), angles.angle(t, 1), angles.angle(t, 2)},
                                      kLargestLayoutCotangent));
  }
  const std::array<int, 2> pins = farthest_pair(disc, border);
  Eigen::VectorXcd z = pinned_conformal_map(conformal_energy(disc.F, cot, disc.vertex_count()),
                                            pins, {Complex(0), Complex(1)});
  scale_to_area(flat_triangles(disc), disc.F, z);
  return to_points(z);
}

}  // namespace geoprior::sketch
