#include "models/sound/resonators/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "core/disjoint_sets.h"

namespace geoprior::sound {
namespace {

using Eigen::Vector2d;

/// Largest width of a gap that closes, over that of the narrower part beside it (a choice).
constexpr double kNeck = 0.5;

/// Whether a crease passes through a cell.
bool is_crease(const SoundGrid& grid, const SheetField& field, int cell,
               const CreaseOptions& options) {
  const double k = std::abs(field.curvature[cell]);
  if (k >= options.fold) return true;
  if (k < options.block) return false;
  const Vector2d ruling = field.ruling.row(cell);
  const Vector2d across = kBesideCrease * Vector2d(-ruling.y(), ruling.x());
  double sum = 0;
  int count = 0;
  for (const Vector2d& p :
       {Vector2d(grid.centre(cell) + across), Vector2d(grid.centre(cell) - across)}) {
    const Vector2d from = (p - grid.corner) / grid.spacing;
    if (from.minCoeff() < 0 || from.x() >= grid.columns || from.y() >= grid.rows) continue;
    const int other = grid.at(p);
    if (!field.inside[other]) continue;
    sum += std::abs(field.curvature[other]);
    ++count;
  }
  return count == 0 || k * count >= options.contrast * sum;
}

/// The neighbour of a cell on a side, or -1 where the sheet does not hold.
int next_to(const SoundGrid& grid, const SheetField& field, int cell, int side) {
  return field.holds(grid, cell, side) ? grid.neighbours(cell)[side] : -1;
}

/// Distance of each cell from the nearest crease, in cells along the sheet: steps to the four
/// neighbours are 1, to those beyond a corner sqrt(2). Infinite without creases.
std::vector<double> from_creases(const SoundGrid& grid, const SheetField& field,
                                 const CreaseOptions& options) {
  std::vector<double> distance(grid.count(), std::numeric_limits<double>::infinity());
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  const auto reach = [&](int cell, double way) {
    if (cell < 0 || way >= distance[cell]) return;
    distance[cell] = way;
    next.emplace(way, cell);
  };
  for (int c = 0; c < grid.count(); ++c) {
    if (field.inside[c] && is_crease(grid, field, c, options)) reach(c, 0);
  }
  while (!next.empty()) {
    const auto [way, cell] = next.top();
    next.pop();
    if (way > distance[cell]) continue;
    for (int side = 0; side < 4; ++side) {
      const int other = next_to(grid, field, cell, side);
      if (other < 0) continue;
      reach(other, way + 1);
      reach(next_to(grid, field, other, (side + 1) % 4), way + std::numbers::sqrt2);
    }
  }
  return distance;
}

}  // namespace

void describe(OptionVisitor& v, CreaseOptions& o) {
  v.value(
      "block", o.block,
      {.doc = "least curvature of a crease, which blocks vibrations", .unit = "1/m", .min = 1e-6});
  v.value(
      "contrast", o.contrast,
      {.doc =
           "least ratio of a crease's curvature to that of the sheet beside it; 0: none is needed",
       .min = 0,
       .max = 1000});
  v.value("fold", o.fold,
          {.doc = "curvature that blocks vibrations whatever lies beside it",
           .unit = "1/m",
           .min = 1e-6});
  v.value("gap", o.gap,
          {.doc = "width below which a gap between creases closes; 0: none does",
           .unit = "m",
           .min = 0,
           .max = 1});
}

std::vector<int> cut_at_creases(const SoundGrid& grid, const SheetField& field,
                                const CreaseOptions& options) {
  const std::vector<double> distance = from_creases(grid, field, options);
  const auto far = [&](int cell) { return distance[cell]; };
  // Widths are known to a cell: of 2 d - 1 cells and of 2 d the middle is d from the creases.
  const auto at_most = [&](double way) { return 2 * way * grid.spacing; };
  const auto at_least = [&](double way) { return (2 * way - 1) * grid.spacing; };
  std::vector<int> order;
  for (int c = 0; c < grid.count(); ++c) {
    if (field.inside[c] && far(c) > 0) order.push_back(c);
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return far(a) > far(b); });
  DisjointSets parts(grid.count());
  std::vector<double> widest(grid.count(), 0);  // of each set
  std::vector<char> flooded(grid.count(), 0);
  for (const int c : order) {
    flooded[c] = 1;
    widest[c] = at_least(far(c));
    // The part on the widest place beside it takes the cell; others join that one, or do not.
    std::array<int, 4> beside{};
    for (int side = 0; side < 4; ++side) {
      const int other = next_to(grid, field, c, side);
      beside[side] = other >= 0 && flooded[other] ? other : -1;
    }
    std::stable_sort(beside.begin(), beside.end(),
                     [&](int a, int b) { return (a < 0 ? -1 : far(a)) > (b < 0 ? -1 : far(b)); });
    bool taken = false;
    for (const int other : beside) {
      if (other < 0) continue;
      const int mine = parts.find(c), its = parts.find(other);
      if (mine == its) continue;
      const double here = at_most(far(c));
      const double narrower = std::min(widest[mine], widest[its]);
      const bool closes = here < options.gap && here < kNeck * narrower;
      if (taken && closes) continue;
      const double both = std::max(widest[mine], widest[its]);
      widest[parts.join(mine, its)] = both;
      taken = true;
    }
  }
  std::vector<int> part(grid.count(), -1);
  for (const int c : order) part[c] = parts.find(c);
  return part;
}

}  // namespace geoprior::sound
