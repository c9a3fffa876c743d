#pragma once

#include <numbers>

#include "solvers/torus/jets/corrugated_jet.h"

namespace geoprior::torus {

/// Taylor coefficients of cos 2 pi x about x, a quarter of a period later sin: f^(k) / k! with
/// f^(k) = (2 pi)^k cos(2 pi x + k pi / 2).
template <int Order>
Series<Order> wave_series(const Lane& x, bool sine) {
  const Wave at = wave(x);
  const Lane value = sine ? at.sine : at.cosine;
  const Lane slope = sine ? at.cosine : -at.sine;
  Series<Order> out;
  double scale = 1;
  for (int k = 0; k <= Order; ++k) {
    out[k] = (k % 2 == 0 ? value : slope) * (k % 4 < 2 ? scale : -scale);
    scale *= 2 * std::numbers::pi / (k + 1);
  }
  return out;
}

/// The torus of revolution (models/torus/revolution.h).
template <int Order>
JetVector<Order> revolution_jet(const Radii& radii, const Lane& x, const Lane& y) {
  const LinearPowers<Order> along_x({1, 0}), along_y({0, 1});
  Jet<Order> ring = radii.tube * along_x.compose(wave_series<Order>(x, false));
  ring.c[0] += radii.ring;
  constexpr double kScale = 0.5 / std::numbers::pi;
  return {kScale * (ring * along_y.compose(wave_series<Order>(y, false))),
          kScale * (ring * along_y.compose(wave_series<Order>(y, true))),
          kScale * radii.tube * along_x.compose(wave_series<Order>(x, true))};
}

}  // namespace geoprior::torus
