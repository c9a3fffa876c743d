#pragma once

#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/maps/tools.h"

namespace geoprior::grammar {

/// x -> the sum of mean value coordinates of x in the cage at rest times the cage's vertices, moved
/// by `share`. Maps all of space, smoothly but on the cage itself, where it is continuous; what
/// lies outside is extrapolated. Source: Ju, Schaefer, Warren 2005, figure 4.
class CageMap final : public SpatialMap {
 public:
  /// @throws Error  a cage that is not closed, other counts, numbers that are not finite
  CageMap(const Cage& cage, double share);
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override;
  [[nodiscard]] double difference() const override { return step_; }

 private:
  TriMesh rest_;
  Eigen::MatrixX3d moved_;
  double step_;
};

}  // namespace geoprior::grammar
