#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// How far triangles are from a wanted angle to the view, |angle(normal, view) - asked| (rad).
struct FoldAngle {
  double mean = 0;  ///< by area
  double max = 0;   ///< of a triangle
};

/// Thesis 2.1.2: a drawn fold asks for 60 degrees between the normal and the direction to the eye.
///
/// Angles run from 0 (facing the eye) to pi, so a triangle that turns its back at 120 degrees is 60
/// away from 60. The angle says nothing of the way in which the surface tilts, hence not whether
/// the fold opens to the drawn side or is a fold at all: a plane tilted by the asked angle has none
/// of this error. Triangles without area are left out.
///
/// @param triangles  rows of F that the fold crosses
/// @param to_eye     direction from the object to the eye, not 0
/// @param asked      rad, 0 to pi
/// @throws Error     when none of the triangles has an area, on a direction without length, or an
///                   angle out of range
FoldAngle fold_angle(const TriMesh& mesh, std::span<const int> triangles,
                     const Eigen::Vector3d& to_eye, double asked);

/// Triangles beside a fold that are seen from one side.
struct SeenFold {
  std::vector<int> triangles;                         ///< rows of F, at least one with an area
  Eigen::Vector3d to_eye = Eigen::Vector3d::UnitZ();  ///< of those that see it from there
  double asked = 0;                                   ///< rad
};
/// Of several sides together: mean by area, largest of all.
/// @throws Error  without sides; as `fold_angle`
FoldAngle fold_angles(const TriMesh& mesh, std::span<const SeenFold> sides);

}  // namespace geoprior
