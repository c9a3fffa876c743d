#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "experiments/details/drawing/drawn_details.h"
#include "models/details/surface_walk.h"

namespace geoprior::details {

/// Unit normals of the vertices of a surface, weighted by angle (Thürmer and Wüthrich 1998). In
/// parallel.
std::vector<Eigen::Vector3d> smooth_normals(const SurfaceTopology& surface,
                                            std::span<const Eigen::Vector3d> x);

/// Unit normals of the smooth surface at the anchors: `smooth_normals` interpolated.
std::vector<Eigen::Vector3d> normals_at(const SurfaceTopology& surface,
                                        std::span<const Eigen::Vector3d> x,
                                        std::span<const DrawnAnchor> anchors);

}  // namespace geoprior::details
