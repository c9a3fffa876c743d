#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

namespace geoprior::sketch {

/// Single coordinates of vertices that are given. A vertex on a silhouette has two of them, another
/// view may give the third.
struct CoordinatePins {
  explicit CoordinatePins(int vertex_count)
      : pinned{std::vector<char>(vertex_count), std::vector<char>(vertex_count),
               std::vector<char>(vertex_count)},
        value(Eigen::MatrixX3d::Zero(vertex_count, 3)) {}

  void set(int vertex, int coordinate, double x) {
    pinned[coordinate][vertex] = 1;
    value(vertex, coordinate) = x;
  }

  std::array<std::vector<char>, 3> pinned;  ///< of x, y and z: not 0 where it is given
  Eigen::MatrixX3d value;                   ///< m
};

/// Deformation transfer (thesis, equation 2.2; Sumner and Popovic 2004): the surface whose
/// triangles are turned by given rotations as nearly as possible, with pins met exactly.
///
/// The fourth vertex p4 of the thesis occurs in its own triangle only and can be eliminated: what
/// is left is min sum_t a_t |grad X - R_t (I - n n')|^2, a_t the triangle's area, whose matrix is
/// that of the cotangent Laplacian; the thesis' sum without a_t depends on the tessellation.
/// Cotangents are clamped to [-2, 20]: a needle would decide over its neighbours. Pinned rows are
/// eliminated, so that strokes are hard constraints; the three coordinates have matrices of their
/// own.
///
/// The pattern of the matrix is analysed once; every solve assembles and factorises anew.
class PinnedTransfer {
 public:
  PinnedTransfer(const Eigen::MatrixX3i& F, int vertex_count);
  ~PinnedTransfer();
  PinnedTransfer(PinnedTransfer&&) noexcept;
  PinnedTransfer& operator=(PinnedTransfer&&) noexcept;

  /// @param X          n x 3, whose triangles are turned
  /// @param rotations  one a triangle
  /// @return           n x 3; a coordinate that is pinned nowhere keeps its mean
  /// @throws Error     when the system is not positive definite: triangles without area
  [[nodiscard]] Eigen::MatrixX3d solve(const Eigen::MatrixX3d& X,
                                       const std::vector<Eigen::Matrix3d>& rotations,
                                       const CoordinatePins& pins);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace geoprior::sketch
