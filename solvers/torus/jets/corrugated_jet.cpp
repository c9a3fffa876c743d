#include "solvers/torus/jets/corrugated_jet.h"

namespace geoprior::torus {

Wave wave(const Lane& s) {
  // Taylor series of half the angle, at most pi/2: (pi/2)^23 / 23! = 1e-18.
  constexpr int kTerms = 11;
  const Lane half = std::numbers::pi * (s - s.round());
  const Lane square = half.square();
  Lane sine = Lane::Ones(), cosine = Lane::Ones();
  for (int k = kTerms; k >= 1; --k) {
    sine = 1 - square * sine * (1. / (2 * k * (2 * k + 1)));
    cosine = 1 - square * cosine * (1. / (2 * k * (2 * k - 1)));
  }
  sine *= half;
  return {2 * sine * cosine, 1 - 2 * sine.square()};
}

}  // namespace geoprior::torus
