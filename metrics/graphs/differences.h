#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace geoprior {

/// Half the sum of the absolute differences of two histograms, each divided by its own sum: 0 for
/// equal shares, 1 where nothing is in common. Bins that one does not have are empty.
/// @throws Error  for a histogram without a positive sum, or a negative or non-finite bin
double histogram_distance(std::span<const double> a, std::span<const double> b);

/// Eigenvalues of the normalised Laplacian I - D^-1/2 A D^-1/2 of a graph, in increasing order:
/// between 0 and 2, a zero for each connected piece. Parallel edges add; loops are left out; a node
/// without edges has a zero.
/// @param edges  pairs of nodes 0 ... nodes - 1
/// @throws Error  naming an edge whose end is no node
Eigen::VectorXd laplacian_spectrum(int nodes, std::span<const std::array<int, 2>> edges);

/// Mean distance of two increasing lists as functions of the rank, from 0 to 1: that of the
/// spectra of graphs of different sizes. The area between the two quantile functions, exactly.
/// @throws Error  for an empty list
double spectral_distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

}  // namespace geoprior
