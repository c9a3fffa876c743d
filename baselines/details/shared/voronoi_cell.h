#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "baselines/details/shared/density_moves.h"
#include "models/details/mesh.h"

namespace geoprior::details {

/// Cell of a detail in the Voronoi diagram on the surface, laid out in the plane around it.
struct VoronoiCell {
  double area = 0;   ///< m^2
  double reach = 0;  ///< distance of the farthest corner (m)
  /// Centroid of the cell under the weight density^2, with which cells at their centroids are
  /// spread with the density (Du, Faber, Gunzburger 1999: in the plane points have the density of
  /// the weight's square root). The detail is at 0 (m).
  Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
};

/// Lays out the triangles of M_d around a detail, their angles scaled to 2 pi (the tangent plane by
/// a discrete exponential map), and cuts the plane by the bisectors to the neighbours: exactly the
/// cell where the surface is flat. A border cuts where it is, not halfway to its ghosts; ghosts
/// elsewhere cut nothing.
class CellChart {
 public:
  /// Around a detail. Valid until M_d changes.
  void lay_out(const DetailMesh& details, int site);
  /// @param spacing  per site: 1 / sqrt(density) (m); the reach is cut at twice `kBareRadius` of it
  [[nodiscard]] VoronoiCell cell(const DetailMesh& details, const std::vector<double>& spacing);
  /// The point of M_d at a place of the chart; absent outside the triangles around the detail.
  [[nodiscard]] std::optional<MeshPoint> point_at(const Eigen::Vector2d& place) const;
  /// Smallest height of the triangles around (m).
  [[nodiscard]] double least_height() const { return least_height_; }

 private:
  struct Spoke {
    int half_edge;  ///< from the detail to the neighbour
    int neighbour;
    Eigen::Vector2d at;
  };
  /// A corner of the cell, and the neighbour whose bisector leaves it (-1: none).
  struct Corner {
    Eigen::Vector2d at;
    int across;
  };
  void cut(const Eigen::Vector2d& normal, double offset, int across);
  void cut_by_border(const DetailMesh& details, std::size_t k, bool run_before, bool run_after);
  void cut_by_neighbours(const DetailMesh& details);
  [[nodiscard]] VoronoiCell integrate(const std::vector<double>& spacing) const;

  int site_ = 0;
  double least_height_ = 0;
  std::vector<Spoke> ring_;
  std::vector<double> angle_;  ///< from a spoke to the next
  std::vector<Corner> corner_, kept_;
  std::vector<int> around_;
};

}  // namespace geoprior::details
