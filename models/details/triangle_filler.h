#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "models/details/intrinsic_triangulation.h"

namespace geoprior::details {

/// Puts several vertices into one triangle, each into the piece that holds it, without flips: the
/// pieces tile the triangle, so that barycentric coordinates of the triangle locate them.
///
/// A point on the rim of its piece is moved inside by a hair (1e-5 of the piece): connectivity is
/// what is wanted here, lengths are measured anew.
class TriangleFiller {
 public:
  TriangleFiller(IntrinsicTriangulation& mesh, int triangle);
  /// @param barycentric  for the corners that the triangle had at the start
  /// @return  the vertex
  int insert(const Eigen::Vector3d& barycentric);

 private:
  struct Piece {
    std::array<Eigen::Vector3d, 3> corner;  ///< in coordinates of the whole triangle
    int triangle = 0;
    int child = -1;  ///< first of three
  };
  static Eigen::Vector3d local(const Piece& piece, const Eigen::Vector3d& barycentric);
  int split(std::size_t at, const Eigen::Vector3d& local);

  IntrinsicTriangulation& mesh_;
  std::vector<Piece> pieces_;
};

}  // namespace geoprior::details
