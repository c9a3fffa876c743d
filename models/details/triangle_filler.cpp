#include "models/details/triangle_filler.h"

#include <Eigen/LU>

namespace geoprior::details {
namespace {

constexpr double kInside = 1e-5;

}  // namespace

TriangleFiller::TriangleFiller(IntrinsicTriangulation& mesh, int triangle) : mesh_(mesh) {
  pieces_.push_back({{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()},
                     triangle,
                     -1});
}

Eigen::Vector3d TriangleFiller::local(const Piece& piece, const Eigen::Vector3d& barycentric) {
  Eigen::Matrix3d corners;
  corners << piece.corner[0], piece.corner[1], piece.corner[2];
  return corners.inverse() * barycentric;
}

int TriangleFiller::insert(const Eigen::Vector3d& barycentric) {
  std::size_t at = 0;
  Eigen::Vector3d inside = barycentric;
  while (pieces_[at].child >= 0) {
    const std::size_t first = pieces_[at].child;
    for (std::size_t c = first; c < first + 3; ++c) {
      const Eigen::Vector3d b = local(pieces_[c], barycentric);
      if (c > first && !(b.minCoeff() > inside.minCoeff())) continue;
      at = c;
      inside = b;
    }
  }
  inside = inside.cwiseMax(kInside);
  return split(at, inside / inside.sum());
}

int TriangleFiller::split(std::size_t at, const Eigen::Vector3d& inside) {
  const Piece parent = pieces_[at];
  const Eigen::Vector3d p =
      inside[0] * parent.corner[0] + inside[1] * parent.corner[1] + inside[2] * parent.corner[2];
  const int v = mesh_.insert(parent.triangle, inside, false);
  pieces_[at].child = static_cast<int>(pieces_.size());
  // Around the new vertex: the triangles whose first corners are the parent's, in turn.
  int h = mesh_.find_edge(mesh_.origin(3 * parent.triangle), v);
  for (std::size_t k = 0; k < 3; ++k) {
    const int triangle = mesh_.twin(h) / 3;  // v's side of the spoke from corner k
    pieces_.push_back({{parent.corner[k], parent.corner[(k + 1) % 3], p}, triangle, -1});
    h = mesh_.previous(mesh_.twin(h));
  }
  return v;
}

}  // namespace geoprior::details
