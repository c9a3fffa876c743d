#pragma once

#include <optional>
#include <vector>

#include "metrics/volume/liquid_columns.h"

namespace geoprior {

/// Amplitude of the first standing wave along x: (2/n) sum over the gauges of h cos(pi (x - x0) /
/// L), L the grid's length; NaN gauges are left out (m).
double slosh_amplitude(const Columns& columns, const ColumnGrid& grid);

/// Angular frequency of a signal from its zero crossings about its mean, each placed by linear
/// interpolation: pi times the number of half swings over the time between the first and the last
/// (rad/s); 0 with fewer than two.
double crossing_frequency(const std::vector<double>& times, const std::vector<double>& values);

/// Linear theory: sqrt(g k tanh(k H)) with k = pi / L (rad/s).
double slosh_frequency(double length, double depth, double gravity);

/// |w / w0 - 1| of the first standing wave that the gauges saw over time, w0 that of linear theory
/// at the first instant's mean depth. Absent where the water does not swing twice.
/// @param columns  of every time, the depths of a closed surface
/// @param length   of the tank along x (m)
std::optional<double> slosh_frequency_error(const std::vector<double>& times,
                                            const std::vector<Columns>& columns,
                                            const ColumnGrid& grid, double length, double gravity);

}  // namespace geoprior
