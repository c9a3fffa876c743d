#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "models/paper/sheet/sheet.h"

/// Frequencies of rectangular plates and cylindrical panels by the Rayleigh-Ritz method in products
/// of Legendre polynomials: the oracle of the modal reference. Ten to sixteen polynomials a side
/// give the lowest dozen frequencies to 1e-5.
namespace geoprior::paper::ritz {

/// Abscissae and weights of Gauss' rule on [-1, 1] (Newton's method on the Legendre polynomial).
struct GaussRule {
  Eigen::VectorXd x, weight;
  explicit GaussRule(int n) : x(n), weight(n) {
    for (int i = 0; i < n; ++i) {
      double z = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
      for (int k = 0; k < 100; ++k) {
        double p = 1, before = 0;
        for (int j = 1; j <= n; ++j) {
          const double next = ((2 * j - 1) * z * p - (j - 1) * before) / j;
          before = p;
          p = next;
        }
        slope = n * (z * p - before) / (z * z - 1);
        z -= p / slope;
      }
      x[i] = z;
      weight[i] = 2 / ((1 - z * z) * slope * slope);
    }
  }
};

/// Integrals over [0, length] of products of derivatives of the basis functions of one side: the
/// Legendre polynomials, or (1 + x)^2 times them, which are clamped at 0.
class Side {
 public:
  Side(int count, double length, bool clamped) {
    const GaussRule rule(count + 6);
    const Eigen::Index n = rule.x.size();
    // Value, first and second derivative at the abscissae.
    std::array<Eigen::MatrixXd, 3> f;
    for (auto& m : f) m = Eigen::MatrixXd::Zero(n, count);
    f[0].col(0).setOnes();
    if (count > 1) {
      f[0].col(1) = rule.x;
      f[1].col(1).setOnes();
    }
    for (int j = 2; j < count; ++j) {
      f[0].col(j) =
          ((2 * j - 1) * rule.x.cwiseProduct(f[0].col(j - 1)) - (j - 1) * f[0].col(j - 2)) / j;
      for (std::size_t d = 1; d < 3; ++d)
        f[d].col(j) = f[d].col(j - 2) + (2 * j - 1) * f[d - 1].col(j - 1);
    }
    if (clamped) {
      const Eigen::VectorXd g = (1 + rule.x.array()).square(), dg = 2 * (1 + rule.x.array());
      f[2] = g.asDiagonal() * f[2] + 2 * (dg.asDiagonal() * f[1]) + 2 * f[0];
      f[1] = g.asDiagonal() * f[1] + dg.asDiagonal() * f[0];
      f[0] = g.asDiagonal() * f[0];
    }
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t q = 0; q < 3; ++q)
        integral_[p][q] = f[p].transpose() * rule.weight.asDiagonal() * f[q] *
                          std::pow(2 / length, static_cast<double>(p + q) - 1);
    count_ = count;
  }
  [[nodiscard]] const Eigen::MatrixXd& integral(int p, int q) const { return integral_[p][q]; }
  [[nodiscard]] int count() const { return count_; }

 private:
  std::array<std::array<Eigen::MatrixXd, 3>, 3> integral_;
  int count_ = 0;
};

/// `factor` times a derivative, p times along x and q times along s, of component c of the
/// displacement.
struct Term {
  int c, p, q;
  double factor;
};
/// Of (xx, xs, ss).
using Strain = std::array<std::vector<Term>, 3>;

/// Adds stiffness/2 times the integral of (1 - nu) |e|^2 + nu tr(e)^2.
inline void add_energy(const Side& x, const Side& s, const Strain& strain, double stiffness,
                       double nu, Eigen::MatrixXd& K) {
  Eigen::Matrix3d law;
  law << 1, 0, nu, 0, 2 * (1 - nu), 0, nu, 0, 1;
  const Eigen::Index block = x.count() * s.count();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (const Term& a : strain[i])
        for (const Term& b : strain[j]) {
          const double factor = stiffness * law(i, j) * a.factor * b.factor;
          if (factor == 0) continue;
          const Eigen::MatrixXd& X = x.integral(a.p, b.p);
          const Eigen::MatrixXd& S = s.integral(a.q, b.q);
          for (Eigen::Index m = 0; m < X.rows(); ++m)
            for (Eigen::Index n = 0; n < X.cols(); ++n)
              K.block(a.c * block + m * s.count(), b.c * block + n * s.count(), s.count(),
                      s.count()) += factor * X(m, n) * S;
        }
}

/// omega^2 of all modes, rigid ones included.
inline Eigen::VectorXd eigenvalues(const Side& x, const Side& s, int components, double rho,
                                   const Eigen::MatrixXd& K) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(K.rows(), K.cols());
  const Eigen::Index block = x.count() * s.count();
  for (int c = 0; c < components; ++c)
    for (Eigen::Index m = 0; m < x.count(); ++m)
      for (Eigen::Index n = 0; n < x.count(); ++n)
        M.block(c * block + m * s.count(), c * block + n * s.count(), s.count(), s.count()) =
            rho * x.integral(0, 0)(m, n) * s.integral(0, 0);
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// Frequencies (Hz) of the lowest `count` modes of a flat plate a x b after the first `rigid`; its
/// side at x = 0 clamped, or free as the others.
inline Eigen::VectorXd plate(const PaperMaterial& material, double a, double b, bool clamped,
                             int count, int polynomials = 14) {
  const Side x(polynomials, a, clamped), s(polynomials, b, false);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(x.count() * s.count(), x.count() * s.count());
  const Strain bending{{{{0, 2, 0, 1}}, {{0, 1, 1, 1}}, {{0, 0, 2, 1}}}};
  add_energy(x, s, bending, material.bending_stiffness(), material.poisson_ratio, K);
  return eigenvalues(x, s, 1, material.area_density, K)
             .segment(clamped ? 0 : 3, count)
             .cwiseSqrt() /
         (2 * std::numbers::pi);
}

/// The same of a free panel of a cylinder of curvature `kappa` whose rulings run along x, a long;
/// b is its arc. Koiter's strains: u along x, v along the arc s, w outwards,
///   eps  = (u_x, (u_s + v_x) / 2, v_s + kappa w),
///   kappa = (w_xx, w_xs - kappa v_x, w_ss - 2 kappa v_s - kappa^2 w).
inline Eigen::VectorXd panel(const PaperMaterial& material, double a, double b, double kappa,
                             int count, int polynomials = 12) {
  const Side x(polynomials, a, false), s(polynomials, b, false);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * x.count() * s.count(), 3 * x.count() * s.count());
  const Strain membrane{
      {{{0, 1, 0, 1}}, {{0, 0, 1, 0.5}, {1, 1, 0, 0.5}}, {{1, 0, 1, 1}, {2, 0, 0, kappa}}}};
  const Strain bending{{{{2, 2, 0, 1}},
                        {{2, 1, 1, 1}, {1, 1, 0, -kappa}},
                        {{2, 0, 2, 1}, {1, 0, 1, -2 * kappa}, {2, 0, 0, -kappa * kappa}}}};
  add_energy(x, s, membrane, material.membrane_stiffness(), material.poisson_ratio, K);
  add_energy(x, s, bending, material.bending_stiffness(), material.poisson_ratio, K);
  return eigenvalues(x, s, 3, material.area_density, K).segment(6, count).cwiseSqrt() /
         (2 * std::numbers::pi);
}

}  // namespace geoprior::paper::ritz
