#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "models/paper/cholesky/block_matrix.h"
#include "models/paper/cholesky/sparse_cholesky.h"
#include "models/paper/contact/contact.h"
#include "models/paper/shell/elements.h"
#include "models/paper/shell/stepper_options.h"
#include "models/paper/shell/system.h"

namespace geoprior::paper {

/// Triangles from which unknowns are ordered by nested dissection, not by degree: measured, the
/// order that was faster.
constexpr int kDissectionFrom = 3000;

/// Rows and columns of the systems that the steps of a sheet solve, and their factorisation.
///
/// Vectors in solver order have three rows a vertex, at its position in the elimination order.
class StepMatrix {
 public:
  StepMatrix(const ShellElements& elements, int vertices, const StepperOptions& options);

  [[nodiscard]] Eigen::Index row(int vertex) const { return 3 * position_[vertex]; }
  [[nodiscard]] int position(int vertex) const { return position_[vertex]; }
  /// Brings the rows of vertices into solver order.
  void gather(const Eigen::MatrixX3d& by_vertex, Eigen::VectorXd& by_position) const;
  /// sum w_i u_i over the vertices of a contact, u in solver order.
  [[nodiscard]] Eigen::Vector3d at(const ContactPoint& point, const Eigen::VectorXd& u) const;
  /// Adds w_i `vector` for the vertices of a contact.
  void add_vector(const ContactPoint& point, const Eigen::Vector3d& vector,
                  Eigen::VectorXd& sum) const;

  /// Adds w_i w_j `block` for the vertices of a contact to the matrix.
  void add_block(const ContactPoint& point, const Eigen::Matrix3d& block);
  void add_to_diagonal(int vertex, double value);

  /// Makes rows and columns of held positions those of the unit matrix, and keeps what they were.
  void take_out(std::span<const char> held) { matrix_.take_out(held, taken_); }
  /// y += A x of what was taken out.
  void multiply_taken(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  [[nodiscard]] bool factorise() { return cholesky_->factorise(matrix_); }
  /// @return  whether the solution, which replaces the right-hand side, is finite
  [[nodiscard]] bool solve(Eigen::VectorXd& b);

  [[nodiscard]] BlockMatrix& blocks() { return matrix_; }
  [[nodiscard]] const ShellSystem& elastic() const { return *elastic_; }
  [[nodiscard]] long factor_nonzeros() const { return cholesky_->nonzeros(); }

 private:
  std::vector<int> position_;
  BlockMatrix matrix_;
  std::unique_ptr<ShellSystem> elastic_;
  std::unique_ptr<SparseCholesky> cholesky_;
  std::vector<BlockMatrix::Taken> taken_;
};

}  // namespace geoprior::paper
