#include "metrics/volume/volume.h"

#include <Eigen/Geometry>

#include "core/error.h"

namespace geoprior {
namespace {

/// Vertices are those of the mesh, then the centroid of each border loop.
TriMesh region_surface(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                       const JointRegion& region) {
  std::size_t fan_triangles = 0;
  for (const std::vector<int>& loop : region.border_loops) fan_triangles += loop.size();
  TriMesh closed;
  closed.V.resize(V.rows() + region.border_loops.size(), 3);
  closed.V.topRows(V.rows()) = V;
  closed.F.resize(region.triangles.size() + fan_triangles, 3);
  Eigen::Index t = 0;
  for (const int of_mesh : region.triangles) closed.F.row(t++) = F.row(of_mesh);
  int centre = static_cast<int>(V.rows());
  for (const std::vector<int>& loop : region.border_loops) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      sum += V.row(loop[i]);
      // The region has the edge from loop[i] on, so its fan has it the other way round.
      closed.F.row(t++) << loop[(i + 1) % loop.size()], loop[i], centre;
    }
    closed.V.row(centre++) = sum / static_cast<double>(loop.size());
  }
  return closed;
}

}  // namespace

double region_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                     const JointRegion& region) {
  const TriMesh closed = region_surface(V, F, region);
  return signed_volume(closed.V, closed.F);
}

Eigen::Vector3d volume_centroid(const TriMesh& mesh) {
  if (mesh.vertex_count() == 0) throw Error("no volume", "volume_centroid", "a closed mesh");
  // About a point of the mesh for round-off. A tetrahedron (0, a, b, c) has its centroid at (a + b
  // + c) / 4.
  const Eigen::RowVector3d origin = mesh.V.row(0);
  double volume6 = 0;
  Eigen::RowVector3d moment24 = Eigen::RowVector3d::Zero();
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0)) - origin;
    const Eigen::RowVector3d b = mesh.V.row(mesh.F(t, 1)) - origin;
    const Eigen::RowVector3d c = mesh.V.row(mesh.F(t, 2)) - origin;
    const double v = a.dot(b.cross(c));
    volume6 += v;
    moment24 += v * (a + b + c);
  }
  if (volume6 == 0) throw Error("no volume", "volume_centroid", "a closed mesh");
  return (origin + moment24 / (4 * volume6)).transpose();
}

std::optional<double> relative_change(double before, double after) {
  if (before == 0 && after == 0) return 0;
  if (before == 0) return std::nullopt;
  return (after - before) / before;
}

}  // namespace geoprior
