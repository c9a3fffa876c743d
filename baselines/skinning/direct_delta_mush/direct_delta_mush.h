#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "baselines/skinning/direct_delta_mush/matrices.h"
#include "core/inputs/rig.h"

namespace geoprior::skinning {

/// Direct delta mush: delta mush without smoothing at run time. The skin around a vertex, weighted
/// by the smoothing kernel B, is carried by the joints; the vertex follows the rigid motion that
/// fits this best. With the matrices of `direct_delta_mush_matrices`, M_j the transform of joint j
/// and M_j p = R_j p + t_j:
///
///   [S q] = sum_j [R_j  M_j p_i] Omega_ij         S: 3 x 3, q: where p_i goes
///   R = rotation nearest to S                     polar factor, determinant 1
///   v' = q + R (v - p_i)
///
/// This is variant 0 of the paper, which writes it with the matrices before their shift by p_i.
///
/// Smoothing hides the collapse and the creases of linear blending and keeps rest detail, as delta
/// mush does; influences are spread by the smoothing as well, so that rigid weights serve. It knows
/// nothing of volume or contact. The kernel counts rings of the mesh, not metres: finer meshes need
/// more iterations or a larger lambda.
///
/// A transform that is not rigid moves p_i as it stands; the detail v - p_i is only turned.
///
/// The formula, one vertex and one influence at a time; `DirectDeltaMush` computes the same four
/// vertices at a time.
///
/// @param matrices  of this rig
/// @throws Error  unless `pose` has m transforms, all finite, and there are matrices for n vertices
/// Source: Le and Lewis 2019. Ours: the determinant's sign (the paper's factor U V' may reflect).
Eigen::MatrixX3d direct_delta_mush(const RiggedMesh& rig, const DirectDeltaMushMatrices& matrices,
                                   const Pose& pose);

/// `direct_delta_mush` for many poses of one rig. Matrices are stored as floats relative to p_i;
/// the last row of a vertex's strongest one is what the others leave of (0, 0, 0, 1) in double, so
/// that rigid motions of the whole body are exact to rounding in double.
class DirectDeltaMush {
 public:
  /// @param rig  welded mesh of n vertices, skeleton of m joints, weights n x m (validated; throws
  /// Error)
  explicit DirectDeltaMush(const RiggedMesh& rig, const DirectDeltaMushOptions& options = {});

  /// Writes the posed positions (n x 3, metres); resizes `posed` when needed, allocates nothing
  /// otherwise (beyond 256 joints: one table of their transforms).
  /// @throws Error  unless `pose` has m transforms, all finite
  void deform(const Pose& pose, Eigen::MatrixX3d& posed) const;

  /// Matrices a vertex, on average.
  [[nodiscard]] double influences_per_vertex() const;

 private:
  /// Omega by rows.
  struct alignas(64) PackedMatrix {
    std::array<float, 16> row;
  };

  int vertex_count_ = 0;
  int joint_count_ = 0;
  std::vector<double> smoothed_;  ///< p, four vertices at a time: 4 x, 4 y, 4 z
  std::vector<double> detail_;    ///< v - p, likewise
  std::vector<std::uint32_t> offset_;
  std::vector<std::uint16_t> joints_;
  std::vector<PackedMatrix> matrices_;
};

}  // namespace geoprior::skinning
