#include "models/sketch/flatten/symmetric_dirichlet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/numerics/sparse_ldlt.h"

namespace geoprior::sketch {
namespace {

using SparseReal = Eigen::SparseMatrix<double>;

constexpr double kLeastFlatHeight = 1e-4;  ///< of a triangle, over its longest edge
constexpr double kShareOfCollapse = 0.9;   ///< to where a triangle loses its area
constexpr double kDirichletArmijo = 1e-4;
constexpr int kMostDirichletHalvings = 40;
constexpr double kHessianRidge = 1e-10;  ///< over the mean of the Hessian's diagonal

/// Gradients of the three hat functions on a triangle in space, as complex numbers, and its area.
struct HatGradients {
  std::array<Complex, 3> gradient{};
  double area = 0;
};

/// The map of one triangle: J v = a v + b conj(v).
struct TriangleMap {
  Complex a, b;
  [[nodiscard]] double large() const { return std::abs(a) + std::abs(b); }
  [[nodiscard]] double small() const { return std::abs(a) - std::abs(b); }
};

HatGradients hat_gradients(const FlatTriangle& t) {
  std::size_t base = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::abs(t.edge[k]) > std::abs(t.edge[base])) base = k;
  }
  const double length = std::abs(t.edge[base]);
  const Complex along = t.edge[base] / length;
  const double height = std::max(2 * t.area / length, kLeastFlatHeight * length);
  const double foot = -std::real(std::conj(along) * t.edge[(base + 2) % 3]);
  const Complex apex = along * Complex(foot, height);
  HatGradients hats;
  hats.area = length * height / 2;
  std::array<Complex, 3> edge{};
  edge[base] = t.edge[base];
  edge[(base + 1) % 3] = apex - t.edge[base];
  edge[(base + 2) % 3] = -apex;
  for (std::size_t k = 0; k < 3; ++k)
    hats.gradient[k] = Complex(0, 1) * edge[(k + 1) % 3] / (2 * hats.area);
  return hats;
}

double dirichlet_density(double s1, double s2) {
  return (s1 * s1 + s2 * s2 + 1 / (s1 * s1) + 1 / (s2 * s2)) / 2;
}

/// First t > 0 at which the triangle with corners z + t d has no area; infinity when there is none.
double time_of_collapse(const std::array<Complex, 3>& z, const std::array<Complex, 3>& d) {
  const auto cross = [](const Complex& p, const Complex& q) { return std::imag(std::conj(p) * q); };
  const Complex u = z[1] - z[0], v = z[2] - z[0], du = d[1] - d[0], dv = d[2] - d[0];
  const double c = cross(u, v), b = cross(u, dv) + cross(du, v), a = cross(du, dv);
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return std::numeric_limits<double>::infinity();
  // c > 0. The root that is formed without cancellation, and the other by the product of both.
  const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  double first = std::numeric_limits<double>::infinity();
  if (a != 0 && q / a > 0) first = q / a;
  if (q != 0 && c / q > 0) first = std::min(first, c / q);
  return first;
}

class SymmetricDirichlet {
 public:
  SymmetricDirichlet(std::span<const FlatTriangle> triangles, const Eigen::MatrixX3i& F,
                     Eigen::Index vertex_count)
      : F_(F), n_(vertex_count), gradient_(2 * vertex_count), hessian_(2 * n_, 2 * n_) {
    hats_.reserve(triangles.size());
    for (const FlatTriangle& t : triangles) {
      hats_.push_back(hat_gradients(t));
      area_ += hats_.back().area;
    }
  }

  [[nodiscard]] double energy(const Eigen::VectorXcd& z) const;
  [[nodiscard]] double area() const { return area_; }
  /// The Newton step at z.
  Eigen::VectorXcd step(const Eigen::VectorXcd& z);
  /// Change of the energy to first order along a step.
  [[nodiscard]] double slope(const Eigen::VectorXcd& step) const;
  [[nodiscard]] double longest_step(const Eigen::VectorXcd& z, const Eigen::VectorXcd& step) const;

 private:
  [[nodiscard]] std::array<Complex, 3> corners(const Eigen::VectorXcd& z, int t) const {
    return {z(F_(t, 0)), z(F_(t, 1)), z(F_(t, 2))};
  }
  [[nodiscard]] TriangleMap map(const Eigen::VectorXcd& z, int t) const;
  void add_triangle(const Eigen::VectorXcd& z, int t);
  void add_square(int t, double weight, const std::array<Complex, 3>& form);

  const Eigen::MatrixX3i& F_;
  Eigen::Index n_;
  double area_ = 0;
  std::vector<HatGradients> hats_;
  Eigen::VectorXd gradient_;
  std::vector<Eigen::Triplet<double>> entries_;
  SparseReal hessian_;
  SparseLdlt factor_;
  bool analysed_ = false;
};

TriangleMap SymmetricDirichlet::map(const Eigen::VectorXcd& z, int t) const {
  TriangleMap m{0, 0};
  for (int k = 0; k < 3; ++k) {
    m.a += z(F_(t, k)) * std::conj(hats_[t].gradient[k]) / 2.0;
    m.b += z(F_(t, k)) * hats_[t].gradient[k] / 2.0;
  }
  return m;
}

double SymmetricDirichlet::energy(const Eigen::VectorXcd& z) const {
  double sum = 0;
  for (int t = 0; t < std::ssize(hats_); ++t) {
    const TriangleMap m = map(z, t);
    if (!(m.small() > 0)) return std::numeric_limits<double>::infinity();
    sum += hats_[t].area * dirichlet_density(m.large(), m.small());
  }
  return sum;
}

/// Adds weight (sum_k Re(conj(form_k) dz_k))^2 / 2 to the quadratic model.
void SymmetricDirichlet::add_square(int t, double weight, const std::array<Complex, 3>& form) {
  for (int i = 0; i < 6; ++i) {
    const int row = 2 * F_(t, i / 2) + i % 2;
    const double f = i % 2 == 0 ? form[i / 2].real() : form[i / 2].imag();
    for (int j = 0; j < 6; ++j) {
      const int column = 2 * F_(t, j / 2) + j % 2;
      const double g = j % 2 == 0 ? form[j / 2].real() : form[j / 2].imag();
      if (row >= column) entries_.emplace_back(row, column, weight * f * g);
    }
  }
}

/// With s1 = |a| + |b|, s2 = |a| - |b|: along s1 and s2 the second derivatives are 1 + 3 s^-4,
/// across a and b they are (dE/d|a|) / |a| and (dE/d|b|) / |b|.
void SymmetricDirichlet::add_triangle(const Eigen::VectorXcd& z, int t) {
  const TriangleMap m = map(z, t);
  const double s1 = m.large(), s2 = m.small(), area = hats_[t].area;
  const Complex a = m.a / std::abs(m.a);
  const Complex b = std::abs(m.b) > 0 ? m.b / std::abs(m.b) : Complex(1);
  std::array<Complex, 3> along_1{}, along_2{}, across_a{}, across_b{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Complex p = a * hats_[t].gradient[k] / 2.0;
    const Complex q = b * std::conj(hats_[t].gradient[k]) / 2.0;
    along_1[k] = p + q;
    along_2[k] = p - q;
    across_a[k] = Complex(0, 1) * p;
    across_b[k] = Complex(0, 1) * q;
  }
  const double cube = s1 * s2 * s1 * s2 * s1 * s2, squares = s1 * s1 + s2 * s2;
  add_square(t, area * (1 + 3 / (s1 * s1 * s1 * s1)), along_1);
  add_square(t, area * (1 + 3 / (s2 * s2 * s2 * s2)), along_2);
  add_square(t, area * std::max(0.0, 2 * (1 - (squares - s1 * s2) / cube)), across_a);
  add_square(t, area * 2 * (1 + (squares + s1 * s2) / cube), across_b);
  for (int k = 0; k < 3; ++k) {
    const Complex pull =
        area * ((s1 - 1 / (s1 * s1 * s1)) * along_1[k] + (s2 - 1 / (s2 * s2 * s2)) * along_2[k]);
    gradient_(2 * F_(t, k)) += pull.real();
    gradient_(2 * F_(t, k) + 1) += pull.imag();
  }
}

Eigen::VectorXcd SymmetricDirichlet::step(const Eigen::VectorXcd& z) {
  gradient_.setZero();
  entries_.clear();
  for (int t = 0; t < std::ssize(hats_); ++t) add_triangle(z, t);
  hessian_.setFromTriplets(entries_.begin(), entries_.end());
  // Translations, and turns at a minimum, cost nothing: a small cost to every coordinate.
  const double ridge = kHessianRidge * hessian_.diagonal().mean();
  hessian_.diagonal().array() += ridge;
  if (!analysed_) factor_.analyze(hessian_);
  analysed_ = true;
  factor_.factorize(hessian_);
  if (!factor_.succeeded()) return Eigen::VectorXcd::Zero(n_);
  const Eigen::VectorXd solved = factor_.solve(-gradient_);
  Eigen::VectorXcd result(n_);
  for (Eigen::Index v = 0; v < n_; ++v) result(v) = {solved(2 * v), solved(2 * v + 1)};
  return result;
}

double SymmetricDirichlet::slope(const Eigen::VectorXcd& step) const {
  double sum = 0;
  for (Eigen::Index v = 0; v < n_; ++v)
    sum += gradient_(2 * v) * step(v).real() + gradient_(2 * v + 1) * step(v).imag();
  return sum;
}

double SymmetricDirichlet::longest_step(const Eigen::VectorXcd& z,
                                        const Eigen::VectorXcd& step) const {
  double first = std::numeric_limits<double>::infinity();
  for (int t = 0; t < std::ssize(hats_); ++t)
    first = std::min(first, time_of_collapse(corners(z, t), corners(step, t)));
  return std::min(1.0, kShareOfCollapse * first);
}

}  // namespace

SymmetricDirichletReport lower_symmetric_dirichlet(std::span<const FlatTriangle> triangles,
                                                   const Eigen::MatrixX3i& F, Eigen::VectorXcd& z,
                                                   const SymmetricDirichletOptions& options) {
  for (int t = 0; t < F.rows(); ++t) {
    if (!(twice_signed_area(z(F(t, 0)), z(F(t, 1)), z(F(t, 2))) > 0)) {
      throw Error("triangle is turned over before the first step", "triangle " + std::to_string(t),
                  "a map that turns none over");
    }
  }
  SymmetricDirichlet problem(triangles, F, z.size());
  double energy = problem.energy(z);
  SymmetricDirichletReport report;
  while (report.iterations < options.iterations) {
    ++report.iterations;
    const Eigen::VectorXcd step = problem.step(z);
    const double slope = problem.slope(step);
    double length = problem.longest_step(z, step);
    double next = energy;
    int halvings = 0;
    for (; halvings < kMostDirichletHalvings; ++halvings, length /= 2) {
      next = problem.energy(z + length * step);
      if (next <= energy + kDirichletArmijo * length * slope) break;
    }
    if (halvings == kMostDirichletHalvings || !(slope < 0)) break;
    z += length * step;
    const double fall = energy - next;
    energy = next;
    if (fall <= options.tolerance * energy) break;
  }
  report.energy = energy / problem.area();
  return report;
}

}  // namespace geoprior::sketch
