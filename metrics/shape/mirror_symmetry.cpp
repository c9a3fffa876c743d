#include "metrics/shape/mirror_symmetry.h"

#include "core/error.h"
#include "metrics/shape/surface_distance.h"

namespace geoprior {
namespace {

TriMesh mirror_image(const TriMesh& mesh, const Eigen::Vector3d& point,
                     const Eigen::Vector3d& normal) {
  TriMesh image = mesh;
  const Eigen::Vector3d n = normal.normalized();
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const Eigen::Vector3d p = mesh.V.row(v).transpose();
    image.V.row(v) = (p - 2 * n.dot(p - point) * n).transpose();
  }
  image.F.col(1).swap(image.F.col(2));
  return image;
}

}  // namespace

MirrorSymmetry mirror_symmetry(const TriMesh& mesh, const Eigen::Vector3d& point,
                               const Eigen::Vector3d& normal, double spacing) {
  if (!(normal.squaredNorm() > 0)) throw Error("plane has no normal", "mirror symmetry", "not 0");
  const TriMesh image = mirror_image(mesh, point, normal);
  return {largest_distance(mesh, image, spacing), surface_deviation(mesh, image, spacing).rms};
}

}  // namespace geoprior
