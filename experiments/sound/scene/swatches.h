#pragma once

#include <memory>
#include <vector>

#include "core/options.h"
#include "models/sound/animation.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

/// Rectangles of paper that snap one after the other: resonators of known lengths, for banks to be
/// judged by. Each pair of a length along the rulings and a width across is cut three times: free,
/// clamped along one ruling, and free but strongly bent, as over a cylinder.
struct SwatchOptions {
  std::vector<double> rulings{0.015, 0.03, 0.06, 0.12};  ///< l_r
  std::vector<double> widths{0.015, 0.03, 0.06, 0.12};
  double flat = 8;
  double bent = 18;
  double snap = 0.01;
  double interval = 0.25;
};
void describe(OptionVisitor& v, SwatchOptions& options);

/// The swatches on one table: `sheet` gets the rectangle of the pattern that all lie in, and the
/// hands that clamp. A swatch is a cylinder of which the curvature goes from k to -k, linear in
/// time, once.
/// @throws Error  without lengths or widths, or for one that is not positive
std::shared_ptr<const SheetAnimation> make_swatches(const SwatchOptions& options, Sheet& sheet);

}  // namespace geoprior::sound
