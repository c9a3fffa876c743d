#pragma once

#include "core/options.h"
#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// Things of several views whose area is known.
enum class SolidShape {
  lampshade,  ///< a cone's frustum, open at both ends
  skirt,      ///< elliptic sections, flared along a curve, open at waist and hem
  sleeve,     ///< a cone's frustum that is tilted, open at shoulder and cuff
  cuff,       ///< an elliptic cylinder, open at both ends
  mitten,     ///< elliptic sections that close in a round tip, and a round thumb; open at the cuff
  bag,        ///< a box, open at the top
};

struct KnownSolidOptions {
  SolidShape shape = SolidShape::lampshade;
  bool third_view = true;
};
void describe(OptionVisitor& v, KnownSolidOptions& options);

/// Its drawing as a careful user makes it, with a border at every rim in each view that shows it at
/// the edge, and what is drawn.
struct KnownSolid {
  Drawing drawing;
  double area = 0;  ///< of the open surface (m^2)
};

/// Front, side, and with `third_view` the view from above.
///
/// Areas: of frusta and the bag in closed form; of stacks of ellipses by quadrature of their
/// parametrisation, to a relative 1e-5; of the mitten the same of both parts, each without what is
/// inside of the other, to 1e-4.
KnownSolid known_solid(const KnownSolidOptions& options);

}  // namespace geoprior::sketch
