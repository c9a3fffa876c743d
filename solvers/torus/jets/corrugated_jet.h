#pragma once

#include <numbers>

#include "models/torus/directions.h"
#include "models/torus/input.h"
#include "solvers/torus/jets/bessel.h"
#include "solvers/torus/jets/jet.h"

namespace geoprior::torus {

template <int Order>
using JetVector = std::array<Jet<Order>, 3>;

template <int Order>
Jet<Order> dot(const JetVector<Order>& a, const JetVector<Order>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <int Order>
JetVector<Order> cross(const JetVector<Order>& a, const JetVector<Order>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A metric E dx^2 + 2 F dx dy + G dy^2.
template <int Order>
struct JetMetric {
  Jet<Order> E, F, G;

  /// Its value on two vectors.
  [[nodiscard]] Jet<Order> operator()(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    return a.x() * b.x() * E + (a.x() * b.y() + a.y() * b.x()) * F + a.y() * b.y() * G;
  }
};

/// That of a surface with these derivatives.
template <int Order>
JetMetric<Order> pulled_back(const JetVector<Order>& x, const JetVector<Order>& y) {
  return {dot(x, x), dot(x, y), dot(y, y)};
}

/// sin and cos of 2 pi s.
struct Wave {
  Lane sine, cosine;
};
Wave wave(const Lane& s);

/// sin and cos of 2 pi n s for n = 0 … Count - 1, by Chebyshev's recurrence.
template <int Count>
struct Harmonics {
  std::array<Lane, Count> sine, cosine;

  explicit Harmonics(const Wave& first) {
    sine[0] = Lane::Zero();
    cosine[0] = Lane::Ones();
    sine[1] = first.sine;
    cosine[1] = first.cosine;
    for (int n = 2; n < Count; ++n) {
      sine[n] = 2 * first.cosine * sine[n - 1] - sine[n - 2];
      cosine[n] = 2 * first.cosine * cosine[n - 1] - cosine[n - 2];
    }
  }
};

/// Integrals of a corrugation's loop, freed of their mean, as functions of its place: s = N pi(x)
/// counts periods, a is the amplitude (Jacobi and Anger):
///   cosine  int_0^s cos(a cos 2 pi u) - J_0(a) du = sum (-1)^k J_2k(a) sin(2k 2 pi s) / (2k pi)
///   sine    int_0^s sin(a cos 2 pi u) du = sum (-1)^k J_2k+1(a) sin((2k+1) 2 pi s) / ((2k+1) pi)
template <int Order>
struct LoopIntegrals {
  Jet<Order> cosine, sine;
};

/// @param bessel     about the amplitude at the centre
/// @param s          at the centre; its fraction counts
/// @param gradient   of s
template <int Order>
LoopIntegrals<Order> loop_integrals(const BesselSeries<Order>& bessel, const Jet<Order>& amplitude,
                                    const Lane& s, const Eigen::Vector2d& gradient) {
  constexpr int kHarmonics = harmonics_of(Order);
  const Harmonics<kHarmonics + 1> waves(wave(s));
  // parts[f][a][b] stands before (amplitude - its value)^a (s - its value)^b.
  std::array<std::array<Series<Order>, Order + 1>, 2> parts;
  for (auto& part : parts)
    for (auto& series : part) series.fill(Lane::Zero());
  for (int n = 1; n <= kHarmonics; ++n) {
    const double omega = 2 * std::numbers::pi * n;
    auto& part = parts[n % 2];
    double scale = (n / 2 % 2 == 0 ? 2 : -2) / omega;
    for (int b = 0; b <= Order; ++b) {
      const Lane term =
          (b % 2 == 0 ? waves.sine[n] : waves.cosine[n]) * (b % 4 < 2 ? scale : -scale);
      for (int a = 0; a + b <= Order; ++a) part[a][b] += bessel[n][a] * term;
      scale *= omega / (b + 1);
    }
  }
  const LinearPowers<Order> place(gradient);
  Jet<Order> rest = amplitude;
  rest.c[0] = Lane::Zero();
  std::array<Jet<Order>, 2> out;
  for (int f = 0; f < 2; ++f) {
    out[f] = place.compose(parts[f][Order]);
    for (int a = Order - 1; a >= 0; --a) out[f] = out[f] * rest + place.compose(parts[f][a]);
  }
  return {out[0], out[1]};
}

/// share Id + (1 - share) base.
template <int Order>
JetMetric<Order> toward_square(const JetMetric<Order>& base, double share) {
  JetMetric<Order> target{(1 - share) * base.E, (1 - share) * base.F, (1 - share) * base.G};
  target.E.c[0] += share;
  target.G.c[0] += share;
  return target;
}

/// What a corrugation adds to a surface, and the coefficient that it adds to the metric.
template <int Order>
struct CorrugationJet {
  JetVector<Order> shift;
  Jet<Order> rho;
};

/// One corrugation (Theillière's process): with U, V of its direction, zeta = -<f_U, f_V> /
/// |f_V|^2, W = U + zeta V, r^2 = |f_W|^2 + rho / |V|^2, J_0(a) = |f_W| / r, t = f_W / |f_W| and
/// the normal n,
///   F = f + r / N (K_c(a, N pi) t + K_s(a, N pi) n)
/// has, up to O(1/N), the metric of f and rho pi^2 / |pi|^2. Points where rho is not positive have
/// no such loop: their numbers mean nothing.
///
/// @param x, y    derivatives of the surface before
/// @param target  metric that the stage is to reach
/// @param s       N pi at the centre
template <int Order>
CorrugationJet<Order> corrugate(const JetVector<Order>& x, const JetVector<Order>& y,
                                const JetMetric<Order>& target, const Corrugation& corrugation,
                                const Lane& s) {
  const WaveDirection& d = kDirections[corrugation.direction];
  const JetMetric<Order> now = pulled_back(x, y);
  const Jet<Order> vv = now(d.along, d.along), uv = now(d.across, d.along);
  const Jet<Order> inverse_vv = inverse(vv);
  const Jet<Order> zeta = -1. * (uv * inverse_vv);
  JetVector<Order> V, W;
  for (int k = 0; k < 3; ++k) {
    V[k] = d.along.x() * x[k] + d.along.y() * y[k];
    W[k] = d.across.x() * x[k] + d.across.y() * y[k] + zeta * V[k];
  }
  const Jet<Order> ww = now(d.across, d.across) + zeta * uv;
  const Jet<Order> rho =
      coefficient(corrugation.direction, target.E - now.E, target.F - now.F, target.G - now.G);
  const Jet<Order> rr = ww + (1 / d.square()) * rho;
  const Jet<Order> q = sqrt(ww * inverse(rr));
  const Lane amplitude = inverse_bessel(q.value());
  const BesselSeries<Order> bessel = bessel_series<Order>(amplitude);
  const auto loops = loop_integrals(bessel, compose(inverted<Order>(bessel[0], amplitude), q), s,
                                    corrugation.number * d.covector);
  const Jet<Order> tangential = loops.cosine * inverse(q);
  const Jet<Order> normal = loops.sine * sqrt(rr * inverse_vv * inverse(ww));
  const JetVector<Order> n = cross(V, W);
  CorrugationJet<Order> out{{}, rho};
  for (int k = 0; k < 3; ++k)
    out.shift[k] = 1. / corrugation.number * (W[k] * tangential + n[k] * normal);
  return out;
}

}  // namespace geoprior::torus
