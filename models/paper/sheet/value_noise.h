#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace geoprior::paper {

/// A number in [0, 1) of a lattice point: the finaliser of MurmurHash3 over its coordinates.
double lattice_value(std::int64_t i, std::int64_t j, std::uint64_t seed);

/// Value noise in [0, 1): interpolates the lattice with the quintic of Perlin (2002), twice
/// differentiable. Along a row of the lattice (whole p.y) it is noise of one variable.
double value_noise(const Eigen::Vector2d& p, std::uint64_t seed);

}  // namespace geoprior::paper
