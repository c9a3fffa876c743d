#include "baselines/torus/integration/periodic_spline.h"

#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior::torus {
namespace {

/// Solves a_k x_{k-1} + b_k x_k + c_k x_{k+1} = d_k, indices round, all diagonally dominant: by
/// elimination of the two corners (Sherman and Morrison).
Eigen::MatrixX3d solve_cyclic(const Eigen::VectorXd& a, Eigen::VectorXd b, const Eigen::VectorXd& c,
                              const Eigen::MatrixX3d& d) {
  const Eigen::Index n = b.size();
  const double gamma = -b(0);
  b(0) -= gamma;
  b(n - 1) -= a(0) * c(n - 1) / gamma;
  Eigen::MatrixXd right(n, 4);
  right.leftCols(3) = d;
  right.col(3).setZero();
  right(0, 3) = gamma;
  right(n - 1, 3) = c(n - 1);
  Eigen::VectorXd upper(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double pivot = k == 0 ? b(0) : b(k) - a(k) * upper(k - 1);
    upper(k) = c(k) / pivot;
    if (k > 0) right.row(k) -= a(k) * right.row(k - 1);
    right.row(k) /= pivot;
  }
  for (Eigen::Index k = n - 2; k >= 0; --k) right.row(k) -= upper(k) * right.row(k + 1);
  const auto corner = [&](Eigen::Index column) {
    return right(0, column) + a(0) / gamma * right(n - 1, column);
  };
  Eigen::MatrixX3d x = right.leftCols(3);
  for (int k = 0; k < 3; ++k) x.col(k) -= corner(k) / (1 + corner(3)) * right.col(3);
  return x;
}

}  // namespace

Eigen::MatrixX3d periodic_spline(const Eigen::VectorXd& knots, const Eigen::MatrixX3d& values,
                                 const Eigen::VectorXd& at) {
  const Eigen::Index n = knots.size();
  const auto next = [n](Eigen::Index k) { return k + 1 == n ? 0 : k + 1; };
  Eigen::VectorXd h(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    h(k) = knots(next(k)) + (k + 1 == n ? 1 : 0) - knots(k);
    if (!(h(k) > 0)) throw Error("knots " + std::to_string(k) + " and the next do not ascend");
  }
  // Second derivatives m: h_{k-1} m_{k-1} + 2 (h_{k-1} + h_k) m_k + h_k m_{k+1} = 6 (slopes apart).
  Eigen::VectorXd a(n), b(n), c(n);
  Eigen::MatrixX3d d(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index before = k == 0 ? n - 1 : k - 1;
    a(k) = h(before);
    b(k) = 2 * (h(before) + h(k));
    c(k) = h(k);
    d.row(k) = 6 * ((values.row(next(k)) - values.row(k)) / h(k) -
                    (values.row(k) - values.row(before)) / h(before));
  }
  const Eigen::MatrixX3d m = solve_cyclic(a, b, c, d);
  Eigen::MatrixX3d out(at.size(), 3);
  double period = std::floor(at(0) - knots(0));
  Eigen::Index k = 0;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    while (at(i) - period >= knots(k) + h(k)) {
      if (++k < n) continue;
      k = 0;
      period += 1;
    }
    const double u = at(i) - period - knots(k), v = h(k) - u;
    out.row(i) = (m.row(k) * v * v * v + m.row(next(k)) * u * u * u) / (6 * h(k)) +
                 (values.row(k) / h(k) - m.row(k) * h(k) / 6) * v +
                 (values.row(next(k)) / h(k) - m.row(next(k)) * h(k) / 6) * u;
  }
  return out;
}

}  // namespace geoprior::torus
