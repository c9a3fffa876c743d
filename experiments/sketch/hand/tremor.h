#pragma once

#include <cstdint>

#include "core/options.h"
#include "models/sketch/drawing/stroke.h"

namespace geoprior::sketch {

/// How a hand trembles: physiological tremor is a narrow band of frequencies (8 to 12 Hz), which
/// the speed of drawing makes one of wavelengths.
struct TremorOptions {
  double sigma = 0.01;       ///< of each coordinate, over the diagonal of the view
  double wavelength = 0.03;  ///< of the band's middle, over the diagonal
  double band = 0.2;         ///< standard deviation of the frequency over its mean
  double gap = 0;            ///< left open in a closed stroke, over the diagonal
  int seed = 1;
};
void describe(OptionVisitor& v, TremorOptions& options);

/// The stroke as that hand draws it: points a fifteenth of a wavelength apart, each coordinate
/// moved by a stationary Gaussian process along the stroke, a sum of waves whose frequencies are
/// drawn from the band.
/// @param diagonal  of the view (m)
/// @param seed      of the stroke
Stroke with_tremor(const Stroke& stroke, double diagonal, const TremorOptions& options,
                   std::uint64_t seed);

}  // namespace geoprior::sketch
