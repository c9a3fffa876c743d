#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "solvers/fluid/feature.h"

namespace geoprior::fluid {

/// A surface patch with a place in a map and values that vary linearly over its triangles.
struct MapPatch {
  static constexpr int kChannels = 5;
  using Value = Eigen::Array<float, kChannels, 1>;
  std::vector<Eigen::Vector2d> uv;  ///< m, in the moving frame
  std::vector<Value> value;
  std::vector<std::array<int, 3>> triangles;
};

/// Values at the texel centres of an N x N map, x fastest.
struct MapRaster {
  int resolution = 0;
  double extent = 0;  ///< m
  std::vector<MapPatch::Value> value;
  std::vector<char> covered;  ///< 1 where a triangle lies
};

/// Which of two triangles over the same texel counts: the first one, or the one whose channel is
/// larger.
struct OverlapRule {
  int highest_channel = -1;  ///< -1: the first
};

/// Linear interpolation at texel centres. Triangles upside down (clockwise in the map) are left
/// out.
MapRaster rasterise(const MapPatch& patch, int resolution, double extent,
                    const OverlapRule& rule = {});

/// Fills texels that are not covered from those that are: averages over coarser and coarser texels
/// (pull), then down again (push). Source: Gortler et al. 1996 (The lumigraph), section 3.4.
void fill_uncovered(MapRaster& raster);

/// Marks (2) the texels not covered that are connected with the map's edge; holes stay 0.
void mark_outside(MapRaster& raster);

/// Heights over a map's plane where they are known.
struct HeightRaster {
  int resolution = 0;
  double extent = 0;  ///< m
  std::vector<float> height;
  std::vector<char> known;  ///< 1
};

/// Bilinear height at (u, v); nothing where a texel around it is not known.
std::optional<double> height_at(const HeightRaster& raster, const Eigen::Vector2d& uv);

}  // namespace geoprior::fluid
