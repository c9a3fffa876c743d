#include "models/paper/sheet/value_noise.h"

namespace geoprior::paper {

double lattice_value(std::int64_t i, std::int64_t j, std::uint64_t seed) {
  std::uint64_t h = static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15U ^
                    static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4FU ^ seed;
  for (const std::uint64_t factor : {0xFF51AFD7ED558CCDU, 0xC4CEB9FE1A85EC53U}) {
    h = (h ^ (h >> 33)) * factor;
  }
  return static_cast<double>((h ^ (h >> 33)) >> 11) * 0x1p-53;
}

double value_noise(const Eigen::Vector2d& p, std::uint64_t seed) {
  const Eigen::Vector2d low = p.array().floor();
  const Eigen::Vector2d t = p - low;
  const auto fade = [](double s) { return s * s * s * (s * (6 * s - 15) + 10); };
  const auto i = static_cast<std::int64_t>(low.x()), j = static_cast<std::int64_t>(low.y());
  const double a = fade(t.x()), b = fade(t.y());
  return (1 - b) * ((1 - a) * lattice_value(i, j, seed) + a * lattice_value(i + 1, j, seed)) +
         b * ((1 - a) * lattice_value(i, j + 1, seed) + a * lattice_value(i + 1, j + 1, seed));
}

}  // namespace geoprior::paper
