#include "models/paper/sheet/sheet.h"

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace geoprior::paper {
namespace {

constexpr int kWaves = 8;
/// Wavelengths in widths of the pattern: long enough that the waves strain the sheet by some 1e-5.
constexpr double kShortestWave = 0.4, kLongestWave = 1.6;

}  // namespace

Eigen::Vector3d Sheet::rest_place(const Eigen::Vector2d& p, std::uint64_t seed) const {
  double height = 0;
  if (imperfection > 0) {
    RandomStream random(seed, "paper imperfection");
    const double unit = width(pattern);
    double sum = 0;
    for (int k = 0; k < kWaves; ++k) {
      const double angle = std::numbers::pi * random.uniform();
      const double length =
          unit * kShortestWave * std::pow(kLongestWave / kShortestWave, random.uniform());
      const double phase = 2 * std::numbers::pi * random.uniform();
      const double amplitude = 0.5 + random.uniform();
      const double along = p.x() * std::cos(angle) + p.y() * std::sin(angle);
      height += amplitude * std::sin(2 * std::numbers::pi * along / length + phase);
      sum += amplitude;
    }
    height *= imperfection / sum;
  }
  return placement * Eigen::Vector3d(p.x(), p.y(), height);
}

int Sheet::frame_count() const {
  return static_cast<int>(std::lround(duration / frame_interval)) + 1;
}

double Sheet::frame_time(int frame) const {
  // 3 / 25 is 0.12, 3 * 0.04 need not be: frames are looked up by their time.
  const double rate = std::round(1 / frame_interval);
  if (std::abs(rate * frame_interval - 1) < 1e-12) return frame / rate;
  return frame * frame_interval;
}

}  // namespace geoprior::paper
