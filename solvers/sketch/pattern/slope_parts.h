#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Divides a surface into parts of constant slope: on each the normal keeps an angle to an axis,
///
///   n . N = c,
///
/// which planes, cylinders and cones do and every surface that does is developable. Parts grow from
/// one triangle each in the order of (n . N - c)^2; axis and angle are fitted to what has grown, in
/// turns (Lloyd). A further part starts in the largest error of the division before.
///
/// @param most  parts, 2 or more
/// @return      for 2, 3, … `most` parts the part of every triangle, from 0
/// Source: Julius, Kraevoy and Sheffer 2005, D-charts: quasi-developable mesh segmentation
/// (proxies; neither their compactness nor their seed rule).
std::vector<std::vector<int>> slope_parts(const TriMesh& mesh, int most);

}  // namespace geoprior::sketch
