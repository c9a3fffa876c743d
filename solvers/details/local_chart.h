#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/details/intrinsic_triangulation.h"

namespace geoprior::details {

/// A vertex laid out in the plane around a source.
struct ChartPoint {
  int vertex = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< source at 0 (m)
};

/// Lays out the surroundings of a vertex of M_d: a discrete logarithmic map.
///
/// The ring of the source spans angles scaled to 2 pi; every further vertex is unfolded over the
/// triangle that reaches it first, in order of distance. Exact where the surface is flat; on a
/// curved one the distance is that of an unfolded strip of triangles.
class LocalChart {
 public:
  /// Points within `radius` of `source`, the source first, then by distance.
  const std::vector<ChartPoint>& around(const IntrinsicTriangulation& mesh, int source,
                                        double radius);

 private:
  struct Reached {
    double distance;
    int vertex;
    Eigen::Vector2d at;
  };
  static bool later(const Reached& a, const Reached& b);
  void lay_out_ring(const IntrinsicTriangulation& mesh, int source, double radius);
  void reach(int vertex, const Eigen::Vector2d& at, double radius);
  void unfold_from(const IntrinsicTriangulation& mesh, int vertex, double radius);

  std::vector<ChartPoint> points_;
  std::vector<Reached> queue_;
  std::vector<int> stamp_;  ///< round in which a vertex was placed
  std::vector<Eigen::Vector2d> placed_;
  int round_ = 0;
};

}  // namespace geoprior::details
