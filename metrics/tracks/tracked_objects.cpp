#include "metrics/tracks/tracked_objects.h"

#include <map>

namespace geoprior {

std::vector<TrackedObject> tracked_objects(const TriMesh& surface,
                                           const Eigen::Ref<const Eigen::VectorXd>& track,
                                           const Eigen::Ref<const Eigen::VectorXd>& kind) {
  struct Sum {
    TrackedObject object;
    double area = 0;
  };
  std::map<int, Sum> sums;
  const Eigen::VectorXd areas = triangle_areas(surface.V, surface.F);
  for (Eigen::Index t = 0; t < surface.F.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const int v = surface.F(t, c);
      const int id = static_cast<int>(track[v]);
      if (id == 0) continue;
      const Eigen::Vector3d x = surface.V.row(v);
      const auto [at, is_new] = sums.try_emplace(id);
      TrackedObject& object = at->second.object;
      if (is_new) object.box_min = object.box_max = x;
      object.id = id;
      object.kind = static_cast<int>(kind[v]);
      object.box_min = object.box_min.cwiseMin(x);
      object.box_max = object.box_max.cwiseMax(x);
      object.centre += areas[t] * x;
      at->second.area += areas[t];
    }
  }
  std::vector<TrackedObject> objects;
  for (auto& [id, sum] : sums) {
    if (sum.area > 0) sum.object.centre /= sum.area;
    objects.push_back(sum.object);
  }
  return objects;
}

}  // namespace geoprior
