#include "metrics/volume/dam_break.h"

#include <array>
#include <limits>

namespace geoprior {
namespace {

constexpr std::array<DamBreakPoint, 15> kFront{{{0.41, 1.11},
                                                {0.84, 1.22},
                                                {1.19, 1.44},
                                                {1.43, 1.67},
                                                {1.63, 1.89},
                                                {1.83, 2.11},
                                                {1.98, 2.33},
                                                {2.20, 2.56},
                                                {2.32, 2.78},
                                                {2.51, 3.00},
                                                {2.65, 3.22},
                                                {2.83, 3.44},
                                                {2.98, 3.67},
                                                {3.11, 3.89},
                                                {3.33, 4.11}}};
constexpr std::array<DamBreakPoint, 17> kHeight{{{0.56, 0.94},
                                                 {0.77, 0.89},
                                                 {0.93, 0.83},
                                                 {1.08, 0.78},
                                                 {1.28, 0.72},
                                                 {1.46, 0.67},
                                                 {1.66, 0.61},
                                                 {1.84, 0.56},
                                                 {2.00, 0.50},
                                                 {2.21, 0.44},
                                                 {2.45, 0.39},
                                                 {2.70, 0.33},
                                                 {3.06, 0.28},
                                                 {3.44, 0.22},
                                                 {4.20, 0.17},
                                                 {5.25, 0.11},
                                                 {7.40, 0.06}}};

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

double mean_depth(const Columns& columns, const ColumnGrid& grid, int i) {
  double sum = 0;
  for (int j = 0; j < grid.ny; ++j) sum += columns.depth[grid.index(i, j)];
  return sum / grid.ny;
}

/// Mean depth over the rows of the grid at any x, not only at the centres of its columns (m).
double mean_depth_at(const TriMesh& mesh, const ColumnGrid& grid, double x) {
  ColumnGrid row = grid;
  row.origin.x() = x - grid.spacing / 2;
  row.nx = 1;
  return mean_depth(columns(mesh, row), row, 0);
}

}  // namespace

std::span<const DamBreakPoint> measured_dam_front() { return kFront; }
std::span<const DamBreakPoint> measured_dam_height() { return kHeight; }

double interpolate(std::span<const DamBreakPoint> points, double time) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const DamBreakPoint &a = points[i - 1], &b = points[i];
    if (time < a.time || time > b.time) continue;
    return a.value + (b.value - a.value) * (time - a.time) / (b.time - a.time);
  }
  return kNoValue;
}

double dam_front(const TriMesh& mesh, const Columns& columns, const ColumnGrid& grid,
                 double threshold) {
  int last = grid.nx - 1;
  while (last >= 0 && !(mean_depth(columns, grid, last) > threshold)) --last;
  if (last < 0) return kNoValue;
  double deep = grid.probe(last, 0).x();
  // The next probe is shallow; behind the last one the grid ends.
  double shallow = deep + (last + 1 < grid.nx ? 1 : 0.5) * grid.spacing;
  while (shallow - deep > grid.spacing / 1000) {
    const double x = (deep + shallow) / 2;
    (mean_depth_at(mesh, grid, x) > threshold ? deep : shallow) = x;
  }
  return deep;
}

double dam_height(const Columns& columns, const ColumnGrid& grid) {
  return mean_depth(columns, grid, 0);
}

}  // namespace geoprior
