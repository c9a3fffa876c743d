#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace geoprior {

/// One number of many, for measures: each is absent where there are no values.

/// What the given share of the values stays under: of n values in order that of the place
/// n percent / 100, counted from 0 and rounded down; 50 is the upper median.
/// @param percent  0 … 99
std::optional<double> percentile_of(std::vector<double> values, int percent);

std::optional<double> largest_of(const Eigen::Ref<const Eigen::VectorXd>& values);

}  // namespace geoprior
