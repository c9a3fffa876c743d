#include "models/paper/toughness.h"

#include <cmath>
#include <numbers>

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// A number in [0, 1) of a lattice point: the finaliser of MurmurHash3 over its coordinates.
double lattice_value(std::int64_t i, std::int64_t j, std::uint64_t seed) {
  std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15U ^
                    static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4FU ^ seed;
  for (const std::uint64_t factor : {0xFF51AFD7ED558CCDU, 0xC4CEB9FE1A85EC53U}) {
    h = (h ^ (h >> 33)) * factor;
  }
  return static_cast<double>((h ^ (h >> 33)) >> 11) * 0x1p-53;
}

/// Interpolates the lattice with the quintic of Perlin (2002): value noise, twice differentiable.
double value_noise(const Vector2d& p, std::uint64_t seed) {
  const Vector2d low = p.array().floor();
  const Vector2d t = p - low;
  const auto fade = [](double s) { return s * s * s * (s * (6 * s - 15) + 10); };
  const auto i = static_cast<std::int64_t>(low.x()), j = static_cast<std::int64_t>(low.y());
  const double a = fade(t.x()), b = fade(t.y());
  return (1 - b) * ((1 - a) * lattice_value(i, j, seed) + a * lattice_value(i + 1, j, seed)) +
         b * ((1 - a) * lattice_value(i, j + 1, seed) + a * lattice_value(i + 1, j + 1, seed));
}

}  // namespace

double Toughness::texture(const Vector2d& p) const {
  if (noise == 0) return 1;
  return 1 - noise * value_noise(p / noise_length, seed);
}

double Toughness::at(const Vector2d& p, const Vector2d& d) const {
  double share = 1;
  if (grain_deg) {
    const double grain = *grain_deg * std::numbers::pi / 180;
    const double along = d.dot(Vector2d(std::cos(grain), std::sin(grain)));
    share = along * along + across * (1 - along * along);
  }
  return energy * share * texture(p);
}

}  // namespace geoprior::paper
