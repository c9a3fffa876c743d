#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "models/paper/cholesky/block_matrix.h"
#include "models/paper/shell/elements.h"

namespace geoprior::paper {

/// Elastic energy, gradient and Hessian of a whole sheet: its elements, evaluated in parallel and
/// summed in an order that does not depend on the number of threads.
///
/// Elements are sorted by elimination order and cut into chunks; chunks are coloured so that those
/// of a colour share no vertex. Colours follow one another, the chunks of a colour run in parallel
/// and write where no other does.
class ShellSystem {
 public:
  /// @param position  of each vertex in the rows of `matrix`
  ShellSystem(const ShellElements& elements, std::vector<int> position, const BlockMatrix& matrix);

  [[nodiscard]] const std::vector<int>& position() const { return position_; }

  /// Sums over the elements. Vectors have three rows a vertex, in the order of the matrix.
  struct Sums {
    double membrane = 0;  ///< J
    double bending = 0;   ///< J
    Eigen::VectorXd gradient;
  };
  void energy(const ShellElements& elements, const ShellState& state, const Eigen::MatrixX3d& x,
              Sums& sums) const;
  void gradient(const ShellElements& elements, const ShellState& state, const Eigen::MatrixX3d& x,
                Sums& sums) const;
  /// Energy and gradient; adds `scale` times the Hessian, projected to positive semidefinite, to
  /// the matrix.
  void hessian(const ShellElements& elements, const ShellState& state, const Eigen::MatrixX3d& x,
               double scale, Sums& sums, BlockMatrix& matrix) const;

 private:
  /// Where the block of two local nodes goes: the stored one is (row, column) or its transpose.
  struct Target {
    int start, stride;
    std::uint8_t row, column;
  };
  struct Chunk {
    int begin, end;  ///< of order_
  };

  void run(const ShellElements& elements, const ShellState& state, const Eigen::MatrixX3d& x,
           ShellElements::Order order, double scale, Sums& sums, double* values) const;
  void sum_chunk(const Chunk& chunk, std::size_t index, const ShellElements& elements,
                 const ShellState& state, const Eigen::MatrixX3d& x, ShellElements::Order order,
                 double scale, Eigen::VectorXd& gradient, double* values) const;
  void sort_elements(const ShellElements& elements);
  void colour_chunks(const ShellElements& elements, int vertices);
  void find_targets(const ShellElements& elements, const BlockMatrix& matrix);

  std::vector<int> position_;
  std::vector<int> order_;      ///< elements
  std::vector<Chunk> chunks_;   ///< by colour
  std::vector<int> colours_;    ///< first chunk of each colour, and the end
  std::vector<int> target_of_;  ///< first target of each element of order_
  std::vector<Target> targets_;
  mutable std::vector<std::array<double, 2>> chunk_energy_;
};

}  // namespace geoprior::paper
