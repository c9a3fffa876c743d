#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "core/mesh.h"
#include "solvers/fluid/features/regions.h"
#include "solvers/fluid/lift/moving_frame.h"

namespace geoprior::fluid {

/// A region of one frame over its bed: the surface, the bed under it, distances from the region.
/// Single precision, relative to the sample's centre: many are kept at once.
struct LiftPatch {
  FrameSample sample;
  std::vector<Eigen::Vector3f> surface, bed;  ///< m, from the centre
  std::vector<float> distance;                ///< from the region along edges (m), 0 inside
  std::vector<std::array<int, 3>> triangles;
};

/// What a frame's segmentation says of its vertices.
struct FrameLabels {
  std::vector<int> label;    ///< 0 bed, 1 … region
  std::vector<char> masked;  ///< walls, solids; may be empty: none
};

/// Distance of every vertex from the vertices with a label, along edges and not through masked
/// vertices, up to `reach` (m); infinite beyond.
std::vector<double> distance_from_region(const TriMesh& mesh, const FrameLabels& labels,
                                         const std::vector<int>& wanted, double reach);

/// Patch of a differential region: its vertices, those within `border` (m), the ring around.
/// @throws Error  when the region has no bed (see `base_under`)
LiftPatch lift_patch(const SurfaceFrame& frame, const FrameLabels& labels, const Region& region,
                     double border);

/// Triangles of an isolated region, in coordinates of the world.
TriMesh isolated_mesh(const TriMesh& mesh, const FrameLabels& labels, int label);

}  // namespace geoprior::fluid
