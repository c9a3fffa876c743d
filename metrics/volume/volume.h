#pragma once

#include <optional>

#include "core/mesh.h"
#include "metrics/contact/joint_region.h"

namespace geoprior {

/// Volume of a joint's region: of its triangles, and a fan from the centroid of each border loop to
/// the loop's edges (m^3).
///
/// Exact to round-off for the closed surface so made. Where the skin at the loops moves with one
/// bone the fans move rigidly, and a change of this volume is one of the skin between them; with
/// wide weights it also counts skin that slides over the border. Where a surface overlaps itself
/// the overlap counts twice (read it beside overlap_volume). The volume of a whole closed mesh is
/// `signed_volume` (core/mesh.h).
double region_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                     const JointRegion& region);

/// Integral of the position over the volume of a closed, outward oriented mesh, divided by the
/// volume (m): the centre of mass of a homogeneous body. With the density rho and gravity g its
/// potential energy is -rho V g.centroid.
/// @throws Error  when the mesh encloses no volume
Eigen::Vector3d volume_centroid(const TriMesh& mesh);

/// (after - before) / before; 0 when both are 0, absent when only `before` is.
std::optional<double> relative_change(double before, double after);

}  // namespace geoprior
