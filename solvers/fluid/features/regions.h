#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "solvers/fluid/features/curvature.h"

namespace geoprior::fluid {

enum class RegionKind { isolated, differential };

/// A feature's support in one frame: a node of the tracking graph.
struct Region {
  int frame = 0;
  int label = 0;  ///< within the frame, 1 …
  RegionKind kind = RegionKind::differential;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< of area; of volume when isolated (m)
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< mean of the vertices', or 0 (m/s)
  bool has_velocity = false;
  double area = 0;                                       ///< m^2
  double volume = 0;                                     ///< m^3, isolated only
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of area (m^2)
  double mean_curvature = 0;                             ///< 1/m
  double crest_share = 0;                                ///< share of the area with H > 0
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero(), box_max = Eigen::Vector3d::Zero();
  /// Cubes of two cells' edge that hold its vertices, as sorted keys (`support_key`).
  std::vector<std::int64_t> support;
};

/// Key of the cube (i, j, k), each within ± 2^20; adding keys adds indices.
constexpr std::int64_t support_key(std::int64_t i, std::int64_t j, std::int64_t k) {
  return (i << 42) + (j << 21) + k;
}

/// Key of the cube (edge 2 h) that holds a point. @param cell  h (m)
std::int64_t support_cube(const Eigen::Vector3d& x, double cell);
/// Whether a region's support has the cube or one of the 26 around it.
bool touches_support(const std::vector<std::int64_t>& support, std::int64_t cube);

/// Regions 1 … `count` of labelled vertices: integrals over their mixed areas, box and support.
/// Frame, kind and volume are the caller's. @param velocity  one row per vertex (m/s), or none
std::vector<Region> region_attributes(const SurfaceGraph& graph, const SurfaceShape& shape,
                                      const std::vector<int>& label, int count,
                                      const Eigen::MatrixX3d& velocity, double cell);

}  // namespace geoprior::fluid
