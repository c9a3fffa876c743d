#pragma once

#include "core/random.h"
#include "models/torus/input.h"

namespace geoprior::torus {

/// Three corrugations of such numbers, as Borrelli et al. 2012 have them.
inline TorusInput published_input(std::array<int, 3> numbers = {12, 80, 500}) {
  TorusInput input;
  input.corrugations = {{0, numbers[0], first_share(input.radii), true},
                        {1, numbers[1], 0.8, true},
                        {2, numbers[2], 0.8, false}};
  return input;
}

inline Eigen::MatrixX2d drawn_places(int count, std::uint64_t seed = 1) {
  RandomStream random(seed, "places");
  Eigen::MatrixX2d at(count, 2);
  for (Eigen::Index i = 0; i < at.rows(); ++i) at.row(i) << random.uniform(), random.uniform();
  return at;
}

}  // namespace geoprior::torus
