#include "metrics/volume/slosh.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace geoprior {

double slosh_amplitude(const Columns& columns, const ColumnGrid& grid) {
  double sum = 0;
  int count = 0;
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const double height = columns.top[grid.index(i, j)];
      if (!std::isfinite(height)) continue;
      sum += height * std::cos(std::numbers::pi * (i + 0.5) / grid.nx);
      ++count;
    }
  }
  return count > 0 ? 2 * sum / count : 0;
}

double crossing_frequency(const std::vector<double>& times, const std::vector<double>& values) {
  if (values.empty()) return 0;
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  double first = 0, last = 0;
  int crossings = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double a = values[i - 1] - mean, b = values[i] - mean;
    if ((a < 0) == (b < 0)) continue;
    last = times[i - 1] + (times[i] - times[i - 1]) * a / (a - b);
    if (crossings++ == 0) first = last;
  }
  return crossings > 1 ? std::numbers::pi * (crossings - 1) / (last - first) : 0;
}

double slosh_frequency(double length, double depth, double gravity) {
  const double k = std::numbers::pi / length;
  return std::sqrt(gravity * k * std::tanh(k * depth));
}

std::optional<double> slosh_frequency_error(const std::vector<double>& times,
                                            const std::vector<Columns>& columns,
                                            const ColumnGrid& grid, double length, double gravity) {
  if (columns.empty() || columns.front().depth.size() == 0) return {};
  std::vector<double> swing;
  for (const Columns& at : columns) swing.push_back(slosh_amplitude(at, grid));
  const double measured = crossing_frequency(times, swing);
  const double expected = slosh_frequency(length, columns.front().depth.mean(), gravity);
  if (measured == 0 || expected == 0) return {};
  return std::abs(measured / expected - 1);
}

}  // namespace geoprior
