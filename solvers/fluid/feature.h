#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/options.h"
#include "solvers/fluid/tracking/tracking.h"

namespace geoprior::fluid {

/// One frame of a differential feature: vector displacements of an N x N map over the base surface,
/// in the axes of the feature's moving frame, x fastest; texel (i, j) is at
/// ((i + 1/2)/N - 1/2, (j + 1/2)/N - 1/2) * extent.
struct MapFrame {
  Eigen::MatrixX3f displacement;  ///< N*N rows (m)
  Eigen::VectorXf alpha;          ///< N*N, 1 inside the region, 0 outside, smooth between
};

/// A space-time feature lifted out of its animation: nothing else is needed to paste it.
struct Feature {
  int id = 0;
  std::string name;  ///< "source/3"
  RegionKind kind = RegionKind::differential;
  double cell = 0;            ///< h of the source (m)
  std::vector<double> times;  ///< s, strictly increasing (gaps of the track are filled)
  /// Moving frame: origin at the feature's smoothed centre on the base, z = smoothed base normal,
  /// x = along its path or its longest axis.
  std::vector<Eigen::Isometry3d> placement;
  // differential
  int resolution = 0;  ///< N
  double extent = 0;   ///< edge of the map (m), one for all frames
  std::vector<MapFrame> maps;
  // isolated: closed meshes in the moving frame (axes of the world, origin at the centre)
  std::vector<TriMesh> meshes;
  std::vector<double> area, volume;  ///< of the frames (m^2, m^3)

  [[nodiscard]] int frame_count() const { return static_cast<int>(times.size()); }
  [[nodiscard]] std::size_t bytes() const;
};

struct MapOptions {
  double texel = 0.5;
  int max_resolution = 256;
  int min_resolution = 32;
  bool vector_map = true;
  /// The bed goes on with the surface's slope at its end: three cells would leave a quarter of a
  /// small splash there.
  double border = 6;
  double margin = 1.2;
  int smoothing_window = 7;
};
void describe(OptionVisitor& v, MapOptions& options);

}  // namespace geoprior::fluid
