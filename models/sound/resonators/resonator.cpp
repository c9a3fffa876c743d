#include "models/sound/resonators/resonator.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "core/error.h"

namespace geoprior::sound {
namespace {

using Eigen::Vector2d;

/// Of the seeds that do not lie on creases: the part that holds most of them, and those that hold a
/// fifth at least.
std::set<int> parts_of(const std::vector<int>& parts, const std::vector<int>& seeds) {
  constexpr double kShare = 0.2;  // of the seeds
  std::map<int, int> count;
  int all = 0;
  for (const int c : seeds) {
    const int part = parts[c];
    if (part < 0) continue;
    ++count[part];
    ++all;
  }
  if (count.empty()) return {};
  const auto most = std::max_element(
      count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::set<int> taken{most->first};
  for (const auto& [part, cells] : count) {
    if (cells >= kShare * all) taken.insert(part);
  }
  return taken;
}

/// Cells of the parts about the seeds, ascending; `in` gets 1 for them.
std::vector<int> cells_about(const SoundGrid& grid, const SheetField& field,
                             const std::vector<int>& parts, const std::vector<int>& seeds,
                             std::vector<char>& in) {
  for (const int c : seeds) {
    if (c < 0 || c >= grid.count() || !field.inside[c]) {
      throw Error("cell " + std::to_string(c) + " lies outside the sheet", "seeds of a resonator");
    }
  }
  std::set<int> taken = parts_of(parts, seeds);
  if (taken.empty()) {
    std::vector<int> beside;
    for (const int c : seeds) {
      for (int side = 0; side < 4; ++side) {
        if (field.holds(grid, c, side)) beside.push_back(grid.neighbours(c)[side]);
      }
    }
    taken = parts_of(parts, beside);
  }
  for (const int c : seeds) {
    if (parts[c] < 0) in[c] = 1;
  }
  std::vector<int> cells;
  for (int c = 0; c < grid.count(); ++c) {
    if (taken.contains(parts[c])) in[c] = 1;
    if (in[c]) cells.push_back(c);
  }
  return cells;
}

/// From the centre of a cell in a direction to the last place in the resonator (m).
double way_inside(const SoundGrid& grid, const std::vector<char>& in, int cell,
                  const Vector2d& direction) {
  const double step = grid.spacing / 2;
  const Vector2d centre = grid.centre(cell),
                 last = grid.corner + grid.spacing * Vector2d(grid.columns, grid.rows);
  double way = 0;
  while (true) {
    const Vector2d p = centre + (way + step) * direction;
    if ((p - grid.corner).minCoeff() < 0 || (last - p).minCoeff() < 0) return way;
    if (!in[grid.at(p)]) return way;
    way += step;
  }
}

double ruling_length(const SoundGrid& grid, const SheetField& field, const std::vector<char>& in,
                     const std::vector<int>& cells) {
  constexpr std::size_t kMostTraced = 256;
  const std::size_t stride = (cells.size() + kMostTraced - 1) / kMostTraced;
  constexpr double kFlat = 1e-3;  // 1/m
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < cells.size(); i += stride) {
    const int c = cells[i];
    const double k = std::abs(field.curvature[c]);
    const Vector2d along = field.ruling.row(c);
    sum += k * (way_inside(grid, in, c, along) + way_inside(grid, in, c, -along));
    weight += k;
  }
  const auto n = static_cast<double>((cells.size() + stride - 1) / stride);
  if (weight > kFlat * n) return std::max(sum / weight, grid.spacing);
  return std::sqrt(static_cast<double>(cells.size()) * grid.cell_area());
}

}  // namespace

Resonator find_resonator(const SoundGrid& grid, const SheetField& field,
                         const std::vector<int>& parts, const std::vector<int>& seeds,
                         const IsHeld& is_held) {
  if (seeds.empty()) throw Error("has no seeds", "resonator");
  std::vector<char> in(grid.count(), 0);
  Resonator found;
  found.cells = cells_about(grid, field, parts, seeds, in);
  found.area = static_cast<double>(found.cells.size()) * grid.cell_area();
  found.ruling_length = ruling_length(grid, field, in, found.cells);
  double blocked = 0, held = 0, between = 0, creased = 0;
  int smooth = 0;
  for (const int c : found.cells) {
    const bool crease = parts[c] < 0;
    (crease ? creased : between) += std::abs(field.curvature[c]);
    smooth += crease ? 0 : 1;
    const std::array<int, 4> beside = grid.neighbours(c);
    for (int side = 0; side < 4; ++side) {
      const int other = beside[side];
      if (other < 0 || in[other]) continue;
      if (field.holds(grid, c, side)) blocked += std::numbers::pi / 4 * grid.spacing;
    }
  }
  found.curvature =
      smooth > 0 ? between / smooth : creased / static_cast<double>(found.cells.size());
  for (const BorderStretch& stretch : field.border) {
    if (!in[stretch.cell]) continue;
    (is_held(stretch.place) ? held : found.free_border) += stretch.length;
  }
  const double border = blocked + held + found.free_border;
  found.blocked_share = border > 0 ? blocked / border : 0;
  return found;
}

}  // namespace geoprior::sound
