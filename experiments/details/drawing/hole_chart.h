#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "experiments/details/drawing/drawn_details.h"
#include "experiments/details/drawing/surface_rays.h"
#include "models/details/surface_walk.h"

namespace geoprior::details {

/// A vertex of the surface laid out in the plane around an anchor.
struct ChartVertex {
  int vertex = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< anchor at 0 (m)
};

/// The surroundings of an anchor laid out in the plane: a piecewise linear map whose distance from
/// 0 is the geodesic distance.
struct HoleChart {
  std::vector<ChartVertex> vertices;
  std::vector<int> faces;  ///< with corners in the chart; all that the disc touches are among them
  double radius = 0;       ///< of the largest disc, up to that asked for, that lies in the chart
};

/// Makes charts: geodesic polar coordinates of the vertices, from one vertex to the next in order
/// of distance. Over each edge whose ends are known the anchor is put where it has their distances,
/// the corner beyond is unfolded, and its direction is shared out as the angle between theirs;
/// where the straight line does not cross the edge, the way leads along a side. The shortest way
/// counts. Exact where the surface is flat.
///
/// The disc ends at nine tenths of the way to a border, or to an edge that is 1.6 times as long in
/// the chart as on the surface: there the surface closes around a thin part or a sharp corner, and
/// a disc would overlap itself. Source: Melvær, Reimers 2012 (geodesic polar coordinates on
/// polygonal meshes).
class HoleCharter {
 public:
  HoleCharter(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x);
  HoleChart around(const DrawnAnchor& anchor, double radius);

 private:
  struct Front {
    double distance;
    int vertex;
  };
  static bool later(const Front& a, const Front& b);
  [[nodiscard]] bool placed(int vertex) const;
  void place(int vertex, const Eigen::Vector2d& at);
  void place_if_nearer(int vertex, const Eigen::Vector2d& at);
  void spread_from(int vertex, double radius);
  void collect_faces(double radius);
  void limit_by_edge(int face, std::size_t edge);

  const SurfaceTopology& surface_;
  std::span<const Eigen::Vector3d> x_;
  SurfaceRays rays_;
  HoleChart chart_;
  std::vector<Front> queue_;
  std::vector<int> vertex_round_, face_round_;
  std::vector<Eigen::Vector2d> at_;
  int round_ = 0;
};

/// Distance of the segment a-b from 0.
double distance_to_segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b);

}  // namespace geoprior::details
