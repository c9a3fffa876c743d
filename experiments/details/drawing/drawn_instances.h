#pragma once

#include <Eigen/Core>
#include <span>

#include "core/options.h"
#include "experiments/details/drawing/drawn_details.h"
#include "models/details/surface_walk.h"

namespace geoprior::details {

enum class InstanceShape {
  plate,  ///< scale of a reptile: a shallow shell that rises along the tangent
  knob,   ///< half a ball
  given   ///< the mesh that is handed over
};

/// Meshes put onto the surface: z of the mesh becomes the normal of the smooth surface, x the
/// tangent direction, its unit of length weight x radius.
struct InstanceOptions {
  InstanceShape shape = InstanceShape::plate;
  double sink = 0.08;
};
void describe(OptionVisitor& v, InstanceOptions& options);

/// The closed mesh of a shape, of radius about 1 around the origin; empty for `given`.
TriMesh instance_mesh(InstanceShape shape);

/// @param instance  the mesh; any triangles
/// @param radius    its unit of length at weight 1 (m)
/// Those of weight below 1/1000 are not drawn.
DrawnDetails draw_instances(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                            std::span<const DrawnAnchor> anchors, const TriMesh& instance,
                            double radius, double sink);

}  // namespace geoprior::details
