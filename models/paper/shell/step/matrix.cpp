#include "models/paper/shell/step/matrix.h"

#include "models/paper/cholesky/cholmod.h"
#include "models/paper/cholesky/eigen.h"
#include "models/paper/cholesky/supernodal.h"

namespace geoprior::paper {
namespace {

NodeGraph element_graph(const ShellElements& elements, int vertices) {
  std::vector<int> offset(1, 0);
  std::vector<int> members;
  offset.reserve(elements.size() + 1);
  members.reserve(elements.size() * 6);
  for (int e = 0; e < elements.size(); ++e) {
    const auto nodes = elements.nodes(e);
    members.insert(members.end(), nodes.begin(), nodes.end());
    offset.push_back(static_cast<int>(members.size()));
  }
  return couple_groups(vertices, offset, members);
}

std::unique_ptr<SparseCholesky> make_cholesky(LinearSolver solver, const BlockMatrix& matrix) {
  if (solver == LinearSolver::eigen) return make_eigen_cholesky(matrix);
  if (solver == LinearSolver::cholmod) return make_cholmod_cholesky(matrix);
  return make_supernodal_cholesky(matrix);
}

}  // namespace

StepMatrix::StepMatrix(const ShellElements& elements, int vertices, const StepperOptions& options) {
  const bool large = elements.size() >= kDissectionFrom;
  const NodeGraph graph = element_graph(elements, vertices);
  position_ =
      elimination_order(graph, large ? Ordering::nested_dissection : Ordering::minimum_degree);
  using Triangle = BlockMatrix::Triangle;
  matrix_ = BlockMatrix(graph, position_,
                        options.solver == LinearSolver::eigen ? Triangle::upper : Triangle::lower);
  elastic_ = std::make_unique<ShellSystem>(elements, position_, matrix_);
  cholesky_ = make_cholesky(options.solver, matrix_);
}

void StepMatrix::gather(const Eigen::MatrixX3d& by_vertex, Eigen::VectorXd& by_position) const {
  by_position.resize(3 * by_vertex.rows());
  for (int i = 0; i < by_vertex.rows(); ++i) by_position.segment<3>(row(i)) = by_vertex.row(i);
}

Eigen::Vector3d StepMatrix::at(const ContactPoint& point, const Eigen::VectorXd& u) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < point.count; ++k) {
    sum += point.weight[k] * u.segment<3>(row(point.vertex[k]));
  }
  return sum;
}

void StepMatrix::add_vector(const ContactPoint& point, const Eigen::Vector3d& vector,
                            Eigen::VectorXd& sum) const {
  for (int k = 0; k < point.count; ++k) {
    sum.segment<3>(row(point.vertex[k])) += point.weight[k] * vector;
  }
}

void StepMatrix::add_block(const ContactPoint& point, const Eigen::Matrix3d& block) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(point.count); ++a) {
    for (std::size_t b = a; b < static_cast<std::size_t>(point.count); ++b) {
      const auto place = matrix_.place(position_[point.vertex[a]], position_[point.vertex[b]]);
      matrix_.add(place, point.weight[a] * point.weight[b] * block);
    }
  }
}

void StepMatrix::add_to_diagonal(int vertex, double value) {
  matrix_.add_to_diagonal(position_[vertex], value);
}

void StepMatrix::multiply_taken(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  paper::multiply_taken(taken_, x, y);
}

bool StepMatrix::solve(Eigen::VectorXd& b) {
  cholesky_->solve(b);
  return b.allFinite();
}

}  // namespace geoprior::paper
