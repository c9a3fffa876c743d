#include "metrics/volume.h"

#include <Eigen/Geometry>

#include "core/error.h"

namespace geoprior {

double region_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                     const JointRegion& region) {
  if (region.triangles.empty()) return 0;
  // About a point of the region: the sum keeps its digits far from the origin.
  const Eigen::RowVector3d origin = V.row(F(region.triangles.front(), 0));
  const auto six_volumes = [&](const Eigen::RowVector3d& a, const Eigen::RowVector3d& b,
                               const Eigen::RowVector3d& c) {
    return (a - origin).dot((b - origin).cross(c - origin));
  };
  double sum = 0;
  for (const int t : region.triangles) {
    sum += six_volumes(V.row(F(t, 0)), V.row(F(t, 1)), V.row(F(t, 2)));
  }
  for (const std::vector<int>& loop : region.border_loops) {
    Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
    for (const int v : loop) centre += V.row(v);
    centre /= static_cast<double>(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
      // The region has the edge from -> to, so its fan has it the other way round.
      const int from = loop[i];
      const int to = loop[(i + 1) % loop.size()];
      sum += six_volumes(V.row(to), V.row(from), centre);
    }
  }
  return sum / 6;
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

double relative_change(double before, double after) {
  if (before == 0 && after == 0) return 0;
  if (before == 0) throw Error("relative change of a quantity that was 0", "", "a non-zero value");
  return (after - before) / before;
}

}  // namespace geoprior
