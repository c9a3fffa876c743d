#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <span>
#include <vector>

#include "solvers/skinning/field/demand.h"
#include "solvers/skinning/field/simd.h"
#include "solvers/skinning/projection/skin_state.h"

namespace geoprior::skinning {

/// Smooth displacements of the skin that few nodes describe: u_i = sum_n P_in c_n.
///
/// Nodes stand some half a local radius apart on the rest surface. P are moving least squares in
/// the tangent plane, with weights (1 - (d / R)^2)^3 of the distance at rest: functions that are
/// linear there are reproduced. A node reaches along the surface, not across a gap. A displacement
/// that bending makes smooth is found here in a tenth of the unknowns; what is left is of short
/// waves (SmoothSystem).
class CoarseSpace {
 public:
  struct Entry {
    int at;
    float weight;
  };
  /// The one rings of the skin, in slots.
  struct Rings {
    const std::vector<int>& offset;
    const std::vector<int>& neighbour;
  };
  /// @param radius   local radius of each slot (m)
  /// @param normals  of the vertices at rest
  /// @param laplace  L over slots
  /// @param bend     weights of (L u)^2, one a slot
  /// @param area     weights of u^2, one a slot
  CoarseSpace(const SkinState& state, const Rings& rings, const std::vector<float>& radius,
              const Eigen::MatrixX3d& normals, const Eigen::SparseMatrix<double>& laplace,
              const std::vector<float>& bend, const std::vector<float>& area);

  /// Chooses the nodes whose bumps lie in the chosen blocks.
  void open(const std::vector<std::uint8_t>& chosen);

  /// The displacement of chosen nodes that answers a residual of the system best.
  /// @param slots  where something is asked
  /// @param area   weights of the demands, one a slot
  /// @param u      out: over the slots of `blocks`
  void solve(const std::vector<Demand>& demands, const std::vector<int>& slots,
             const std::vector<float>& area, const std::vector<Float4>& residual, float kappa,
             float diagonal, const std::vector<int>& blocks, std::vector<Float4>& u);

  [[nodiscard]] std::size_t node_count() const { return blocks_of_.size(); }

 private:
  struct Pair {
    int node;
    float bend, mass;
  };
  void place_nodes(const SkinState& state, const Rings& rings, const std::vector<float>& radius,
                   const Eigen::MatrixX3d& normals);
  void apply(const std::vector<Demand>& demands, const std::vector<int>& slots,
             const std::vector<float>& area, float kappa, float diagonal);
  [[nodiscard]] std::span<const Entry> row(std::size_t slot) const {
    return {row_.data() + row_offset_[slot], row_.data() + row_offset_[slot + 1]};
  }

  std::size_t size_;
  std::vector<std::size_t> row_offset_, column_offset_, pair_offset_;
  std::vector<Entry> row_;     // of P: nodes of a slot
  std::vector<Entry> column_;  // slots of a node
  std::vector<Pair> pair_;     // of P^T (L bend L) P and P^T area P: nodes of a node
  std::vector<std::vector<int>> blocks_of_;
  std::vector<int> nodes_;  // open ones
  std::vector<std::uint8_t> is_open_;
  // One a node; zero where it is closed.
  std::vector<Float4> value_, residual_, search_, image_;
  std::vector<float> inverse_;
};

}  // namespace geoprior::skinning
