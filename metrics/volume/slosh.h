#pragma once

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

}  // namespace geoprior
