#include "baselines/fluid/tank.h"

#include <cmath>

namespace geoprior {

int Tank::frame_count() const {
  // A duration that is a multiple of the interval but for round-off still has its last frame.
  return 1 + static_cast<int>(std::floor(duration / frame_interval + 1e-9));
}

double Tank::frame_time(int frame) const { return frame * frame_interval; }

}  // namespace geoprior
