#include "metrics/isometry/energy_spike.h"

#include <algorithm>
#include <cstddef>

namespace geoprior {

double energy_spike(std::span<const double> energies, double least_share) {
  if (energies.empty()) return 0;
  const double least = least_share * *std::max_element(energies.begin(), energies.end());
  double most = 0;
  for (std::size_t i = 1; i + 1 < energies.size(); ++i) {
    const double beside = std::max(energies[i - 1], energies[i + 1]);
    if (energies[i] > least && beside > 0) most = std::max(most, energies[i] / beside);
  }
  return most;
}

}  // namespace geoprior
