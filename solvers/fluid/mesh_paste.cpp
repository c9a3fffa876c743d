#include "solvers/fluid/mesh_paste.h"

#include <algorithm>

namespace geoprior {

TriMesh isolated_at(const Feature& feature, const EditedFrame& frame) {
  const auto& times = feature.times;
  const auto after = std::lower_bound(times.begin(), times.end(), frame.source_time);
  auto i = static_cast<std::size_t>(after - times.begin());
  if (i == times.size() ||
      (i > 0 && frame.source_time - times[i - 1] <= times[i] - frame.source_time)) {
    --i;
  }
  TriMesh mesh = feature.meshes[i];
  mesh.V = (mesh.V * frame.placement.linear().transpose()).rowwise() +
           frame.placement.translation().transpose();
  if (frame.placement.linear().determinant() < 0) mesh.F.col(1).swap(mesh.F.col(2));
  return mesh;
}

void insert_mesh(const TriMesh& mesh, const Eigen::Vector3d& velocity, SurfaceFrame& target) {
  const Eigen::Index n = target.mesh.V.rows(), m = target.mesh.F.rows();
  const bool moving = n > 0 && target.velocity.rows() == n;
  target.mesh.V.conservativeResize(n + mesh.V.rows(), 3);
  target.mesh.V.bottomRows(mesh.V.rows()) = mesh.V;
  target.mesh.F.conservativeResize(m + mesh.F.rows(), 3);
  target.mesh.F.bottomRows(mesh.F.rows()) = mesh.F.array() + static_cast<int>(n);
  if (!moving) return;
  target.velocity.conservativeResize(n + mesh.V.rows(), 3);
  target.velocity.bottomRows(mesh.V.rows()).rowwise() = velocity.transpose();
}

}  // namespace geoprior
