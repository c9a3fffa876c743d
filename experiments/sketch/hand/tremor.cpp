#include "experiments/sketch/hand/tremor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/random.h"
#include "models/sketch/drawing/polyline.h"

namespace geoprior::sketch {
namespace {

/// One coordinate's displacement along a stroke, in standard deviations.
class Tremble {
 public:
  Tremble(RandomStream& random, const TremorOptions& options) {
    for (Wave& wave : waves_) {
      wave.frequency = (1 + options.band * random.normal()) / options.wavelength;
      wave.sine = random.normal();
      wave.cosine = random.normal();
    }
  }
  /// @param along  over the diagonal
  [[nodiscard]] double at(double along) const {
    double sum = 0;
    for (const Wave& wave : waves_) {
      const double phase = 2 * std::numbers::pi * wave.frequency * along;
      sum += wave.sine * std::sin(phase) + wave.cosine * std::cos(phase);
    }
    return sum / std::sqrt(static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    double frequency = 0, sine = 0, cosine = 0;
  };
  std::array<Wave, 64> waves_;
};

}  // namespace

void describe(OptionVisitor& v, TremorOptions& o) {
  v.value("sigma", o.sigma,
          {.doc = "standard deviation of each coordinate, over the diagonal of the view",
           .min = 0,
           .max = 0.1});
  v.value("wavelength", o.wavelength,
          {.doc = "mean wavelength along the stroke, over the diagonal of the view",
           .min = 1e-3,
           .max = 1});
  v.value(
      "band", o.band,
      {.doc = "standard deviation of the tremor's frequency, over its mean", .min = 0, .max = 0.4});
  v.value("gap", o.gap,
          {.doc = "gap that is left in a closed stroke, over the diagonal of the view",
           .min = 0,
           .max = 0.1});
  v.value("seed", o.seed, {.doc = "seed of the tremor, beside the experiment's", .min = 0});
}

Stroke with_tremor(const Stroke& stroke, double diagonal, const TremorOptions& options,
                   std::uint64_t seed) {
  constexpr double kPointsPerWave = 15;
  RandomStream random(seed, "tremor " + stroke.id);
  const Tremble right(random, options), up(random, options);
  std::vector<Eigen::Vector2d> chain = stroke.points;
  if (stroke.closed) chain.push_back(chain.front());
  const double whole = length(chain) - (stroke.closed ? options.gap * diagonal : 0);
  const int count = std::max(
      2, static_cast<int>(std::ceil(whole / (diagonal * options.wavelength / kPointsPerWave))));
  Stroke drawn = stroke;
  drawn.closed = false;
  drawn.points.clear();
  for (int i = 0; i <= count; ++i) {
    const double along = whole * i / count;
    const Eigen::Vector2d moved(right.at(along / diagonal), up.at(along / diagonal));
    drawn.points.emplace_back(point_along(chain, along) + options.sigma * diagonal * moved);
  }
  return drawn;
}

}  // namespace geoprior::sketch
