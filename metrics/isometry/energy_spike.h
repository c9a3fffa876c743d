#pragma once

#include <span>

namespace geoprior {

/// Most that an energy is over that of the greater of its two neighbours in time: 1 or less where
/// it rises or falls steadily, large where a single frame strains the sheet. 0 when no frame
/// counts.
///
/// A spike over two frames is none: the second has the first beside it.
///
/// @param energies     of frames in order (J)
/// @param least_share  of the largest of them, up to which a frame does not count
double energy_spike(std::span<const double> energies, double least_share);

}  // namespace geoprior
