#pragma once

#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/mesh.h"
#include "core/parallel.h"
#include "solvers/skinning/field/demand.h"
#include "solvers/skinning/field/simd.h"
#include "solvers/skinning/projection/skin_state.h"
#include "solvers/skinning/smooth/coarse_space.h"

namespace geoprior::skinning {

/// Displacements u of the skin that follow what is asked smoothly:
///
///   min  sum_i A_i ( kappa r_i^4 |(M^-1 L u)_i|^2 + mu |u_i|^2 + w_i (d_i . u_i - a_i)^2 )
///
/// L is the cotangent stiffness of the rest surface, M = diag(A_i) its vertex areas, r_i the local
/// radius, kappa = (cutoff / 7.85)^4: of a demand w = 1 whose wavelength is 0.8 `cutoff` local
/// radii half the amplitude is followed.
///
/// A coarse level (coarse_space.h), then conjugate gradients, preconditioned by the 3 x 3 diagonal,
/// from the u of before, over the blocks of the skin (skin_state.h) that were opened; u is zero
/// elsewhere. Sums go over blocks in their order, so the result has the same bits for any number of
/// threads. Allocates nothing once warm.
class SmoothSystem {
 public:
  /// @param radius  local radius of each slot (m)
  SmoothSystem(const TriMesh& mesh, const SkinState& state, const std::vector<float>& radius);

  struct Options {
    double cutoff = 1;  ///< in local radii
    double anchor = 0;  ///< mu
    int iterations = 20;
  };

  /// Closes all blocks: u becomes zero there.
  void close(std::vector<Float4>& u);
  /// Opens the blocks where something is asked and those around them, as far as a displacement
  /// decays.
  void open(const std::vector<Demand>& demands, const Options& options);

  /// Opens blocks besides, and no others.
  void open(const std::vector<int>& blocks);
  [[nodiscard]] const std::vector<int>& open_blocks() const { return blocks_; }

  /// @param u      in: the start, zero in closed blocks; out: the solution
  /// @return iterations done
  int solve(const std::vector<Demand>& demands, const Options& options, std::vector<Float4>& u);

  /// Calls body(begin, end) for the slots of every open block, in parallel.
  template <class Body>
  void each_open(const Body& body) const {
    each_slot([&](std::size_t, std::size_t begin, std::size_t end) { body(begin, end); });
  }

 private:
  // What is made once, in this order.
  /// area_ and bend_.
  void weigh_vertices(const TriMesh& mesh, const SkinState& state,
                      const std::vector<float>& radius);
  /// L over slots, row by row: offset_, neighbour_, conductance_, diagonal_.
  void list_stiffness(const TriMesh& mesh, const SkinState& state);
  void sum_bend_diagonal();
  /// What is near to each block, its box and its largest radius.
  void bound_blocks(const SkinState& state, const std::vector<float>& radius);
  /// L over slots as a matrix, for the coarse space.
  [[nodiscard]] Eigen::SparseMatrix<double> laplace() const;
  void allocate();

  /// Blocks in which something is asked.
  void list_asked(const std::vector<Demand>& demands);
  /// Marks the blocks around those within `reach` of their radii.
  void reach_around_asked(float reach);
  /// residual_ of u, the preconditioner, and the right side in search_.
  void start_residual(const std::vector<Demand>& demands, const std::vector<Float4>& u, float kappa,
                      float diagonal);
  /// Adds to u what the coarse space finds.
  void correct_coarsely(const std::vector<Demand>& demands, std::vector<Float4>& u, float kappa,
                        float diagonal);
  void bend(const std::vector<Float4>& x, float kappa);
  /// image_ = system times x. @return its product with x
  double apply(const std::vector<Demand>& demands, const std::vector<Float4>& x, float kappa,
               float diagonal);
  /// direction_ = preconditioner times residual. @return its product with the residual
  double precondition(const std::vector<Demand>& demands, const std::vector<Float4>& residual);
  [[nodiscard]] double sum() const;
  template <class Body>
  void each_slot(const Body& body) const {
    parallel_blocks(blocks_.size(), kBlocksOfTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t block = blocks_[i];
        body(block, block * SkinState::kBlock, std::min(size_, (block + 1) * SkinState::kBlock));
      }
    });
  }
  static constexpr std::size_t kBlocksOfTask = 16;

  std::size_t size_;
  std::vector<int> offset_, neighbour_;
  std::vector<float> conductance_, diagonal_;  // of L
  std::vector<float> area_, bend_;             // over the mean area; r^4 / (A mean A)
  std::vector<float> bend_diagonal_;           // of L bend L
  std::vector<std::vector<int>> near_blocks_;
  std::vector<Float4Bounds> bounds_;  // of blocks at rest
  std::vector<float> radius_;         // largest of a block
  std::optional<CoarseSpace> coarse_;
  std::vector<int> blocks_;
  std::vector<int> slots_;  // where something is asked
  std::vector<std::uint8_t> chosen_, reached_;
  std::vector<int> asked_, front_, seen_;
  std::vector<double> partial_;  // one a block
  std::vector<Float4> residual_, search_, bent_, image_, direction_;
  std::vector<float> inverse_, share_;  // of the preconditioner
};

}  // namespace geoprior::skinning
