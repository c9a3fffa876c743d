#include "solvers/paper/isometry_projection.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "solvers/paper/mesh_edges.h"

namespace geoprior {
namespace {

using Eigen::Vector3d;
using Matrix = Eigen::SparseMatrix<double>;

/// Damping mu at the start, over the squared mean edge length, and how it changes.
constexpr double kDamping = 1e-6;
constexpr double kLeastDamping = 1e-10;
constexpr double kDampingUp = 30;
constexpr double kDampingDown = 0.1;
/// Longest move of a vertex in one iteration, in mean edge lengths: beyond it the linearisation
/// says nothing.
constexpr double kLongestMove = 0.3;

struct EdgeTerm {
  int i, j;       ///< vertices
  double length;  ///< in the pattern (m)
  double area;    ///< a third of the triangles beside it (m^2)
  /// Places in the matrix of the blocks ii, jj, ij, column by column; -1 above the diagonal.
  std::array<int, 9> ii, jj, ij;
};

}  // namespace

struct IsometryProjector::Impl {
  std::vector<bool> held;
  std::vector<int> free_index;  ///< of each vertex; -1: held
  std::vector<EdgeTerm> terms;
  Eigen::VectorXd mass;  ///< of each vertex, as area (m^2)
  double mean_length = 1;
  Matrix matrix;
  std::vector<int> diagonal;  ///< places of the diagonal
  Eigen::SimplicialLDLT<Matrix> solver;

  void build(const ShellMesh& mesh);
  void build_matrix();
  double merit(const Eigen::MatrixX3d& x, double& largest) const;
  void assemble(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient);
  Eigen::VectorXd stretching(const Eigen::MatrixX3d& x, const Eigen::MatrixX3d& v) const;
  bool factorise(double mu);
  bool iterate(ShellState& state, double& mu, double& merit_now, double& largest);
  void move(Eigen::MatrixX3d& x, const Eigen::VectorXd& step) const;
  void calm(ShellState& state, double mu);
};

void IsometryProjector::Impl::build(const ShellMesh& mesh) {
  const MeshEdges edges(mesh.triangles);
  mass = Eigen::VectorXd::Zero(mesh.vertex_count());
  std::vector<double> area(static_cast<std::size_t>(mesh.triangle_count()));
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    const Eigen::RowVector2d e =
        mesh.pattern.row(mesh.triangles(f, 1)) - mesh.pattern.row(mesh.triangles(f, 0));
    const Eigen::RowVector2d g =
        mesh.pattern.row(mesh.triangles(f, 2)) - mesh.pattern.row(mesh.triangles(f, 0));
    area[static_cast<std::size_t>(f)] = (e.x() * g.y() - e.y() * g.x()) / 2;
    for (int k = 0; k < 3; ++k) mass[mesh.triangles(f, k)] += area[static_cast<std::size_t>(f)] / 3;
  }
  double sum = 0;
  for (const MeshEdges::Edge& e : edges.all()) {
    EdgeTerm term{};
    term.i = e.a;
    term.j = e.b;
    term.length = (mesh.pattern.row(e.b) - mesh.pattern.row(e.a)).norm();
    for (const int f : {e.left, e.right}) {
      if (f >= 0) term.area += area[static_cast<std::size_t>(f)] / 3;
    }
    sum += term.length;
    terms.push_back(term);
  }
  mean_length = sum / static_cast<double>(terms.size());
  free_index.assign(held.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (!held[i]) free_index[i] = next++;
  }
  build_matrix();
}

void IsometryProjector::Impl::build_matrix() {
  const auto index = [&](int v) { return free_index[static_cast<std::size_t>(v)]; };
  std::vector<Eigen::Triplet<double>> entries;
  const auto block = [&](int p, int q) {
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        const int row = 3 * std::max(p, q) + r, col = 3 * std::min(p, q) + c;
        if (row >= col) entries.emplace_back(row, col, 1.0);
      }
    }
  };
  int count = 0;
  for (const int i : free_index) {
    if (i < 0) continue;
    block(i, i);
    ++count;
  }
  for (const EdgeTerm& t : terms) {
    if (index(t.i) >= 0 && index(t.j) >= 0) block(index(t.i), index(t.j));
  }
  matrix.resize(3 * count, 3 * count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const auto place = [&](int row, int col) {
    const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[col];
    const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[col + 1];
    return static_cast<int>(std::lower_bound(begin, end, row) - matrix.innerIndexPtr());
  };
  const auto places = [&](int p, int q, std::array<int, 9>& out) {
    out.fill(-1);
    if (p < 0 || q < 0) return;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        const int row = 3 * std::max(p, q) + r, col = 3 * std::min(p, q) + c;
        if (row >= col) out[static_cast<std::size_t>(3 * c + r)] = place(row, col);
      }
    }
  };
  for (EdgeTerm& t : terms) {
    places(index(t.i), index(t.i), t.ii);
    places(index(t.j), index(t.j), t.jj);
    places(index(t.i), index(t.j), t.ij);
  }
  diagonal.clear();
  for (int k = 0; k < 3 * count; ++k) diagonal.push_back(place(k, k));
  if (count > 0) solver.analyzePattern(matrix);
}

double IsometryProjector::Impl::merit(const Eigen::MatrixX3d& x, double& largest) const {
  double sum = 0;
  largest = 0;
  for (const EdgeTerm& t : terms) {
    const double r = (x.row(t.j) - x.row(t.i)).norm() / t.length - 1;
    sum += t.area * r * r;
    largest = std::max(largest, std::abs(r));
  }
  return sum;
}

/// Gauss-Newton matrix (without damping) and gradient of half the merit. Stretched edges add their
/// geometric stiffness: it is positive semidefinite and calms steps out of a nearly flat plane.
void IsometryProjector::Impl::assemble(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  double* value = matrix.valuePtr();
  std::fill(value, value + matrix.nonZeros(), 0.0);
  gradient.setZero(matrix.rows());
  for (const EdgeTerm& t : terms) {
    const Vector3d d = x.row(t.j) - x.row(t.i);
    const double length = d.norm();
    const Vector3d u = d / length;
    const double r = length / t.length - 1;
    Eigen::Matrix3d h = (t.area / (t.length * t.length)) * u * u.transpose();
    if (r > 0) {
      h += (t.area * r / (t.length * length)) * (Eigen::Matrix3d::Identity() - u * u.transpose());
    }
    const Vector3d g = (t.area * r / t.length) * u;
    const int i = free_index[static_cast<std::size_t>(t.i)];
    const int j = free_index[static_cast<std::size_t>(t.j)];
    if (i >= 0) gradient.segment<3>(3 * i) -= g;
    if (j >= 0) gradient.segment<3>(3 * j) += g;
    for (std::size_t k = 0; k < 9; ++k) {
      const double a = h.data()[k];
      if (t.ii[k] >= 0) value[t.ii[k]] += a;
      if (t.jj[k] >= 0) value[t.jj[k]] += a;
      if (t.ij[k] >= 0) value[t.ij[k]] -= a;
    }
  }
}

/// Half the gradient of the rate at which the edges stretch: J' A J v on the free vertices.
Eigen::VectorXd IsometryProjector::Impl::stretching(const Eigen::MatrixX3d& x,
                                                    const Eigen::MatrixX3d& v) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(matrix.rows());
  for (const EdgeTerm& t : terms) {
    const Vector3d u = (x.row(t.j) - x.row(t.i)).normalized();
    const double rate = (v.row(t.j) - v.row(t.i)).dot(u.transpose()) / t.length;
    const Vector3d g = (t.area * rate / t.length) * u;
    const int i = free_index[static_cast<std::size_t>(t.i)];
    const int j = free_index[static_cast<std::size_t>(t.j)];
    if (i >= 0) result.segment<3>(3 * i) -= g;
    if (j >= 0) result.segment<3>(3 * j) += g;
  }
  return result;
}

bool IsometryProjector::Impl::factorise(double mu) {
  for (std::size_t v = 0; v < free_index.size(); ++v) {
    if (free_index[v] < 0) continue;
    for (int k = 0; k < 3; ++k) {
      matrix.valuePtr()[diagonal[static_cast<std::size_t>(3 * free_index[v] + k)]] +=
          mu * mass[static_cast<Eigen::Index>(v)];
    }
  }
  solver.factorize(matrix);
  return solver.info() == Eigen::Success;
}

void IsometryProjector::Impl::move(Eigen::MatrixX3d& x, const Eigen::VectorXd& step) const {
  for (std::size_t v = 0; v < free_index.size(); ++v) {
    if (free_index[v] < 0) continue;
    x.row(static_cast<Eigen::Index>(v)) += step.segment<3>(3 * free_index[v]).transpose();
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

/// Takes out of the velocities what stretches the edges.
void IsometryProjector::Impl::calm(ShellState& state, double mu) {
  Eigen::VectorXd gradient;
  assemble(state.x, gradient);
  if (!factorise(mu)) return;
  move(state.v, -solver.solve(stretching(state.x, state.v)));
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
  double mu = kDamping / (impl_->mean_length * impl_->mean_length);
  while (report.iterations < options.iterations && report.strain_after > options.strain) {
    ++report.iterations;
    impl_->iterate(state, mu, merit, report.strain_after);
  }
  if (report.iterations > 0)
    impl_->calm(state, kDamping / (impl_->mean_length * impl_->mean_length));
  return report;
}

double largest_edge_strain(const ShellState& state) {
  double largest = 0;
  const MeshEdges edges(state.mesh.triangles);
  for (const MeshEdges::Edge& e : edges.all()) {
    const double rest = (state.mesh.pattern.row(e.b) - state.mesh.pattern.row(e.a)).norm();
    largest = std::max(largest, std::abs((state.x.row(e.b) - state.x.row(e.a)).norm() / rest - 1));
  }
  return largest;
}

}  // namespace geoprior
