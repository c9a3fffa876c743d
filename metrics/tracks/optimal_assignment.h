#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// Columns of largest total value for the rows, each column at most once (Hungarian method with
/// potentials, O(n^3)). All rows are assigned when there are enough columns, else all columns are.
/// @param value  rows x columns, finite
/// @return       column of every row, or -1
std::vector<int> optimal_assignment(const Eigen::MatrixXd& value);

}  // namespace geoprior
