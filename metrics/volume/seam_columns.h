#pragma once

#include <vector>

#include "core/mesh.h"
#include "metrics/volume/liquid_columns.h"

namespace geoprior {

/// Columns that the border of a marked part of a surface passes: the column's square holds a marked
/// vertex, and that of one of its four neighbours holds vertices of which none is marked.
///
/// A square without any vertex belongs to neither side: on a surface coarser than the grid the seam
/// has holes. Columns on the rim of the grid are never seam.
/// @param surface  whose triangles' vertices count
/// @param marked   a flag a vertex
/// @return         a flag a column
std::vector<char> seam_columns(const ColumnGrid& grid, const TriMesh& surface,
                               const std::vector<char>& marked);

/// The values where the flag is set, NaN elsewhere.
Eigen::VectorXd values_where(const Eigen::VectorXd& values, const std::vector<char>& flags);

}  // namespace geoprior
