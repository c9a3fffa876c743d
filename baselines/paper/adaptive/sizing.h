#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "baselines/paper/adaptive/sizing_options.h"
#include "models/paper/contact/obstacle.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Sizing tensor at a vertex (1/m^2): an edge e of the pattern is as long as it should be when
/// e' M e = 1.
using SizeTensor = Eigen::Matrix2d;

/// Smallest tensor M >= a in the directions of a's and b's difference: max(a, b) as Narain, Pfaff
/// and O'Brien 2013 combine criteria; for tensors of common axes the larger of each eigenvalue.
SizeTensor tensor_max(const SizeTensor& a, const SizeTensor& b);

/// Eigenvalues limited to [1/size_max^2, 1/size_min^2] and the lesser to at least aspect_min^2 of
/// the greater.
SizeTensor limited(const SizeTensor& tensor, const SizingOptions& options);

/// Length of the edge from `a` to `b` in the mean of the tensors at its ends (1: as asked for).
inline double metric_length(const Eigen::Vector2d& edge, const SizeTensor& a, const SizeTensor& b) {
  return std::sqrt(0.5 * (edge.dot(a * edge) + edge.dot(b * edge)));
}

/// Sizing tensors of all vertices: the area-weighted mean over the triangles about each of the
/// greatest of
///   S'S / refine_angle^2        S: shape operator, sum of theta l t t' / 2A over a triangle's
///   edges dn'dn / refine_angle^2      gradient of the vertex normals dv'dv / refine_velocity^2
///   gradient of the velocity
///   (-G)+ / refine_compression^2   compressive part of the Green strain
///   dh'dh / h^2                 gradient of the distance h to each obstacle nearer than size_max
/// each triangle's limited before.
std::vector<SizeTensor> sizing_tensors(const ShellState& state,
                                       const std::vector<Obstacle>& obstacles,
                                       const SizingOptions& options);

}  // namespace geoprior::paper
