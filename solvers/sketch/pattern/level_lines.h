#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "models/sketch/surface/path.h"

namespace geoprior::sketch {

/// Lines along which a value at the vertices, linear in the triangles, is 0. Closed ones repeat
/// their first point at the end; the others end at the vertex of the border that is nearest to
/// where they leave the surface.
///
/// @param shortest  lines below this length are left out (m)
std::vector<SurfacePath> level_lines(const TriMesh& mesh, const Eigen::VectorXd& value,
                                     double shortest);

/// A value at the vertices, smoothed by the heat equation, one implicit step,
///
///   (M + t L) u = M u0,
///
/// M the areas about vertices and L the cotangent matrix; borders let nothing through, so that
/// level lines meet them at right angles. Level lines of a smoothed 0 and 1 are fair curves.
///
/// @param width  root of t: lines are fair at this scale (m)
Eigen::VectorXd smoothed_over(const TriMesh& mesh, const Eigen::VectorXd& value, double width);

/// The same cut as fair lines, where it parts the surface in two.
/// @return  empty when it does not
std::vector<SurfacePath> faired_cut(const TriMesh& mesh, const std::vector<SurfacePath>& cut,
                                    double width);

}  // namespace geoprior::sketch
