#include "solvers/paper/shell/isometry_projection.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/numerics/sparse_ldlt.h"
#include "solvers/paper/shell/green_strain.h"

namespace geoprior::paper {
namespace {

using Eigen::Matrix2d;
using Matrix = Eigen::SparseMatrix<double>;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Damping mu at the start, over the squared mean edge length, and how it changes.
constexpr double kDamping = 1e-6;
constexpr double kLeastDamping = 1e-10;
constexpr double kDampingUp = 30;
constexpr double kDampingDown = 0.1;
/// Longest move of a vertex in one iteration, in mean edge lengths: beyond it the linearisation
/// says nothing.
constexpr double kLongestMove = 0.3;

struct Triangle {
  std::array<int, 3> vertices;
  Eigen::Matrix<double, 3, 2> shape;  ///< gradients of the hat functions, one row a corner (1/m)
  double area = 0;                    ///< m^2
  /// Place in the matrix of each entry of the element's matrix; -1: above the diagonal or held.
  std::array<int, 81> place;
};

/// Deformation gradient, 3 x 2.
Eigen::Matrix<double, 3, 2> gradient_of_map(const Triangle& t, const Eigen::MatrixX3d& x) {
  Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();
  for (int k = 0; k < 3; ++k) {
    F += x.row(t.vertices[k]).transpose() * t.shape.row(k);
  }
  return F;
}

/// The part of a symmetric matrix with eigenvalues > 0.
Matrix2d positive_part(const Matrix2d& G) {
  const double mean = (G(0, 0) + G(1, 1)) / 2;
  const double radius = std::hypot((G(0, 0) - G(1, 1)) / 2, G(0, 1));
  if (mean - radius >= 0) return G;
  if (mean + radius <= 0) return Matrix2d::Zero();
  // One eigenvalue of each sign: (mean + radius) times the projector on its eigenvector.
  return (mean + radius) / (2 * radius) * (G - (mean - radius) * Matrix2d::Identity());
}

/// Derivative of (G_00, G_11, sqrt2 G_01) by the nine coordinates of the corners.
Eigen::Matrix<double, 3, 9> strain_derivative(const Triangle& t,
                                              const Eigen::Matrix<double, 3, 2>& F) {
  Eigen::Matrix<double, 3, 9> J;
  const Eigen::RowVector3d f0 = F.col(0), f1 = F.col(1);
  for (int k = 0; k < 3; ++k) {
    const double a = t.shape(k, 0), b = t.shape(k, 1);
    J.block<1, 3>(0, 3 * k) = a * f0;
    J.block<1, 3>(1, 3 * k) = b * f1;
    J.block<1, 3>(2, 3 * k) = (a * f1 + b * f0) / std::numbers::sqrt2;
  }
  return J;
}

}  // namespace

struct IsometryProjector::Impl {
  std::vector<bool> held;
  std::vector<int> free_index;  ///< of each vertex; -1: held
  std::vector<Triangle> triangles;
  Eigen::VectorXd mass;  ///< of each vertex, as area (m^2)
  double mean_length = 1;
  Matrix matrix;
  std::vector<int> diagonal;  ///< places of the diagonal
  SparseLdlt solver;

  void build(const ShellMesh& mesh);
  void build_matrix();
  [[nodiscard]] int unknown(const Triangle& t, int k) const;
  [[nodiscard]] double merit(const Eigen::MatrixX3d& x, double& largest) const;
  void assemble(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient);
  [[nodiscard]] Eigen::VectorXd straining(const Eigen::MatrixX3d& x,
                                          const Eigen::MatrixX3d& v) const;
  bool factorise(double mu);
  bool iterate(ShellState& state, double& mu, double& merit_now, double& largest);
  void move(Eigen::MatrixX3d& x, const Eigen::VectorXd& step) const;
  void calm(ShellState& state, double mu);
};

/// Index of coordinate k = 0 ... 8 of a triangle among the unknowns; negative when held.
int IsometryProjector::Impl::unknown(const Triangle& t, int k) const {
  const int i = free_index[t.vertices[k / 3]];
  return i < 0 ? -1 : 3 * i + k % 3;
}

void IsometryProjector::Impl::build(const ShellMesh& mesh) {
  mass = Eigen::VectorXd::Zero(mesh.vertex_count());
  double length = 0;
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    Triangle t{};
    for (int k = 0; k < 3; ++k) {
      t.vertices[k] = mesh.triangles(f, k);
      length += (mesh.pattern.row(mesh.triangles(f, (k + 1) % 3)) -
                 mesh.pattern.row(mesh.triangles(f, k)))
                    .norm();
    }
    Matrix2d rest;
    rest.col(0) = mesh.pattern.row(t.vertices[1]) - mesh.pattern.row(t.vertices[0]);
    rest.col(1) = mesh.pattern.row(t.vertices[2]) - mesh.pattern.row(t.vertices[0]);
    t.area = rest.determinant() / 2;
    t.shape.bottomRows<2>() = rest.inverse();
    t.shape.row(0) = -t.shape.row(1) - t.shape.row(2);
    for (const int v : t.vertices) mass[v] += t.area / 3;
    triangles.push_back(t);
  }
  mean_length = length / (3 * mesh.triangle_count());
  free_index.assign(held.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i]) free_index[i] = next++;
  }
  matrix.resize(3 * next, 3 * next);
  build_matrix();
}

void IsometryProjector::Impl::build_matrix() {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Triangle& t : triangles) {
    for (int c = 0; c < 9; ++c) {
      for (int r = 0; r < 9; ++r) {
        const int row = unknown(t, r), col = unknown(t, c);
        if (col >= 0 && row >= col) entries.emplace_back(row, col, 1.0);
      }
    }
  }
  matrix.setFromTriplets(entries.begin(), entries.end());
  const auto place = [&](int row, int col) {
    const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[col];
    const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[col + 1];
    return static_cast<int>(std::lower_bound(begin, end, row) - matrix.innerIndexPtr());
  };
  for (Triangle& t : triangles) {
    for (int c = 0; c < 9; ++c) {
      for (int r = 0; r < 9; ++r) {
        const int row = unknown(t, r), col = unknown(t, c);
        t.place[9 * c + r] = col >= 0 && row >= col ? place(row, col) : -1;
      }
    }
  }
  diagonal.clear();
  for (int k = 0; k < matrix.rows(); ++k) diagonal.push_back(place(k, k));
  if (matrix.rows() > 0) solver.analyze(matrix);
}

double IsometryProjector::Impl::merit(const Eigen::MatrixX3d& x, double& largest) const {
  double sum = 0;
  largest = 0;
  for (const Triangle& t : triangles) {
    const Matrix2d G = green_strain(gradient_of_map(t, x));
    sum += t.area * G.squaredNorm();
    largest = std::max(largest, largest_principal(G));
  }
  return sum;
}

/// Gauss-Newton matrix (without damping) and gradient of half the merit. Stretch adds its geometric
/// stiffness: it is positive semidefinite and calms steps out of a nearly flat plane.
void IsometryProjector::Impl::assemble(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  double* value = matrix.valuePtr();
  std::fill(value, value + matrix.nonZeros(), 0.0);
  gradient.setZero(matrix.rows());
  for (const Triangle& t : triangles) {
    const Eigen::Matrix<double, 3, 2> F = gradient_of_map(t, x);
    const Matrix2d G = green_strain(F);
    const Eigen::Matrix<double, 3, 9> J = strain_derivative(t, F);
    const Vector9 g =
        t.area * J.transpose() * Eigen::Vector3d(G(0, 0), G(1, 1), std::numbers::sqrt2 * G(0, 1));
    Matrix9 H = t.area * J.transpose() * J;
    const Eigen::Matrix3d stiffness = t.area * t.shape * positive_part(G) * t.shape.transpose();
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        H.block<3, 3>(3 * a, 3 * b).diagonal().array() += stiffness(a, b);
      }
    }
    for (int k = 0; k < 9; ++k) {
      if (unknown(t, k) >= 0) gradient[unknown(t, k)] += g[k];
    }
    for (std::size_t k = 0; k < 81; ++k) {
      if (t.place[k] >= 0) value[t.place[k]] += H.data()[k];
    }
  }
}

/// Half the gradient of the squared rate of strain: dG' A dG v on the free vertices.
Eigen::VectorXd IsometryProjector::Impl::straining(const Eigen::MatrixX3d& x,
                                                   const Eigen::MatrixX3d& v) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(matrix.rows());
  for (const Triangle& t : triangles) {
    const Eigen::Matrix<double, 3, 9> J = strain_derivative(t, gradient_of_map(t, x));
    Vector9 velocity;
    for (int k = 0; k < 3; ++k) {
      velocity.segment<3>(3 * k) = v.row(t.vertices[k]);
    }
    const Vector9 g = t.area * J.transpose() * (J * velocity);
    for (int k = 0; k < 9; ++k) {
      if (unknown(t, k) >= 0) result[unknown(t, k)] += g[k];
    }
  }
  return result;
}

bool IsometryProjector::Impl::factorise(double mu) {
  for (std::size_t v = 0; v < free_index.size(); ++v) {
    if (free_index[v] < 0) continue;
    for (int k = 0; k < 3; ++k) {
      matrix.valuePtr()[diagonal[3 * free_index[v] + k]] += mu * mass[v];
    }
  }
  solver.factorize(matrix);
  return solver.succeeded();
}

void IsometryProjector::Impl::move(Eigen::MatrixX3d& x, const Eigen::VectorXd& step) const {
  for (std::size_t v = 0; v < free_index.size(); ++v) {
    if (free_index[v] < 0) continue;
    x.row(v) += step.segment<3>(3 * free_index[v]).transpose();
  }
}

/// One damped step; false when it made nothing better (the damping has then grown).
bool IsometryProjector::Impl::iterate(ShellState& state, double& mu, double& merit_now,
                                      double& largest) {
  Eigen::VectorXd gradient;
  assemble(state.x, gradient);
  if (!factorise(mu)) {
    mu *= kDampingUp;
    return false;
  }
  Eigen::VectorXd step = -solver.solve(gradient);
  const double longest = step.size() > 0 ? step.cwiseAbs().maxCoeff() : 0;
  if (longest > kLongestMove * mean_length) step *= kLongestMove * mean_length / longest;
  Eigen::MatrixX3d x = state.x;
  move(x, step);
  double largest_there = 0;
  const double merit_there = merit(x, largest_there);
  if (!(merit_there < merit_now)) {
    mu *= kDampingUp;
    return false;
  }
  state.x = std::move(x);
  merit_now = merit_there;
  largest = largest_there;
  mu = std::max(mu * kDampingDown, kLeastDamping / (mean_length * mean_length));
  return true;
}

/// Takes out of the velocities what strains the triangles.
void IsometryProjector::Impl::calm(ShellState& state, double mu) {
  Eigen::VectorXd gradient;
  assemble(state.x, gradient);
  if (!factorise(mu)) return;
  move(state.v, -solver.solve(straining(state.x, state.v)));
}

IsometryProjector::IsometryProjector(const ShellMesh& mesh, const std::vector<bool>& held)
    : impl_(std::make_unique<Impl>()) {
  impl_->held = held;
  impl_->build(mesh);
}

IsometryProjector::~IsometryProjector() = default;
IsometryProjector::IsometryProjector(IsometryProjector&&) noexcept = default;
IsometryProjector& IsometryProjector::operator=(IsometryProjector&&) noexcept = default;

const std::vector<bool>& IsometryProjector::held() const { return impl_->held; }

ProjectionReport IsometryProjector::project(ShellState& state, const ProjectionOptions& options) {
  ProjectionReport report;
  double merit = impl_->merit(state.x, report.strain_before);
  report.strain_after = report.strain_before;
  if (impl_->matrix.rows() == 0) return report;
  const double start = kDamping / (impl_->mean_length * impl_->mean_length);
  double mu = start;
  while (report.iterations < options.iterations && report.strain_after > options.strain) {
    ++report.iterations;
    impl_->iterate(state, mu, merit, report.strain_after);
  }
  if (report.iterations > 0) impl_->calm(state, start);
  return report;
}

}  // namespace geoprior::paper
