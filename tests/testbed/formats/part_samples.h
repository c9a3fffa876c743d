#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "core/frame.h"

namespace geoprior::test {

Eigen::MatrixXd noise(Eigen::Index rows, Eigen::Index columns, std::string_view purpose);

/// One part of every kind, with arrays over points and cells, units, names of values, and a value
/// that is no number.
Part sample_triangles();
Part sample_lines();
Part sample_points();
Part sample_grid();
std::array<Part, 4> part_samples();

/// Bit by bit, not-a-numbers too.
void expect_equal(const Part& a, const Part& b);

}  // namespace geoprior::test
