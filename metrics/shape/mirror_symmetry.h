#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior {

/// Distance of a surface from its mirror image (m).
struct MirrorSymmetry {
  double hausdorff = 0;  ///< the same both ways, since the image's image is the surface
  double rms = 0;        ///< over the area of the surface
};

/// Compares point sets, by nearest points: it sees neither how the two halves are triangulated nor
/// which point is whose partner, and a surface may slide along itself unnoticed (a surface of
/// revolution is symmetric about every plane through its axis). The plane is the caller's: one that
/// is off by d adds about 2 d.
///
/// @param point,normal  of the plane; the normal not 0
/// @param spacing       of the samples (m), as in `hausdorff_distance` of
/// metrics/shape/surface_distance.h
/// @throws Error        on a normal without length; as `hausdorff_distance`
MirrorSymmetry mirror_symmetry(const TriMesh& mesh, const Eigen::Vector3d& point,
                               const Eigen::Vector3d& normal, double spacing);

}  // namespace geoprior
