#include "models/paper/sound_resonator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Whether a crease passes through a cell.
bool is_crease(const SoundGrid& grid, const SheetField& field, int cell,
               const ResonatorOptions& options) {
  const double k = std::abs(field.curvature[cell]);
  if (k >= options.fold) return true;
  if (k < options.block) return false;
  const Vector2d ruling = field.ruling.row(cell);
  const Vector2d across = options.beside * Vector2d(-ruling.y(), ruling.x());
  double sum = 0;
  int count = 0;
  for (const Vector2d& p :
       {Vector2d(grid.centre(cell) + across), Vector2d(grid.centre(cell) - across)}) {
    const Vector2d from = (p - grid.corner) / grid.spacing;
    if (from.minCoeff() < 0 || from.x() >= grid.columns || from.y() >= grid.rows) continue;
    const int other = grid.at(p);
    if (!field.inside[static_cast<std::size_t>(other)]) continue;
    sum += std::abs(field.curvature[other]);
    ++count;
  }
  return count == 0 || k * count >= options.contrast * sum;
}

/// Cells from the seeds on, ascending; `in` gets 1 for them.
std::vector<int> flood(const SoundGrid& grid, const SheetField& field,
                       const std::vector<int>& seeds, const ResonatorOptions& options,
                       std::vector<char>& in) {
  std::vector<int> cells;
  const auto take = [&](int c) {
    in[static_cast<std::size_t>(c)] = 1;
    cells.push_back(c);
  };
  for (const int c : seeds) {
    if (c < 0 || c >= grid.count() || !field.inside[static_cast<std::size_t>(c)]) {
      throw Error("cell " + std::to_string(c) + " lies outside the sheet", "seeds of a resonator");
    }
    if (!in[static_cast<std::size_t>(c)]) take(c);
  }
  for (std::size_t next = 0; next < cells.size(); ++next) {
    const int c = cells[next];
    const std::array<int, 4> beside = grid.neighbours(c);
    for (int side = 0; side < 4; ++side) {
      const int other = beside[static_cast<std::size_t>(side)];
      if (other < 0 || in[static_cast<std::size_t>(other)]) continue;
      if (!field.holds(grid, c, side) || is_crease(grid, field, other, options)) continue;
      take(other);
    }
  }
  std::sort(cells.begin(), cells.end());
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
    if (!in[static_cast<std::size_t>(grid.at(p))]) return way;
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

void describe(OptionVisitor& v, ResonatorOptions& o) {
  v.value(
      "block", o.block,
      {.doc = "least curvature of a crease, which blocks vibrations", .unit = "1/m", .min = 1e-6});
  v.value("contrast", o.contrast,
          {.doc = "of a crease's curvature to that of the sheet beside it; 0: none is needed",
           .min = 0,
           .max = 1000});
  v.value("fold", o.fold,
          {.doc = "curvature that blocks whatever lies beside it", .unit = "1/m", .min = 1e-6});
  v.value("beside", o.beside,
          {.doc = "where that is looked at, across the ruling", .unit = "m", .min = 0, .max = 1});
  v.value("crumpled_share", o.crumpled_share,
          {.doc = "share of a resonator's border that is creases, from which on "
                  "it cracs",
           .min = 0,
           .max = 1});
}

Resonator find_resonator(const SoundGrid& grid, const SheetField& field,
                         const std::vector<int>& seeds, const IsHeld& is_held,
                         const ResonatorOptions& options) {
  if (seeds.empty()) throw Error("has no seeds", "resonator");
  std::vector<char> in(static_cast<std::size_t>(grid.count()), 0);
  Resonator found;
  found.cells = flood(grid, field, seeds, options, in);
  found.area = static_cast<double>(found.cells.size()) * grid.cell_area();
  found.ruling_length = ruling_length(grid, field, in, found.cells);
  double blocked = 0, held = 0;
  for (const int c : found.cells) {
    found.curvature += std::abs(field.curvature[c]) / static_cast<double>(found.cells.size());
    const std::array<int, 4> beside = grid.neighbours(c);
    for (int side = 0; side < 4; ++side) {
      const int other = beside[static_cast<std::size_t>(side)];
      if (other < 0 || in[static_cast<std::size_t>(other)]) continue;
      if (field.holds(grid, c, side)) blocked += std::numbers::pi / 4 * grid.spacing;
    }
  }
  for (const BorderStretch& stretch : field.border) {
    if (!in[static_cast<std::size_t>(stretch.cell)]) continue;
    (is_held(stretch.place) ? held : found.free_border) += stretch.length;
  }
  const double border = blocked + held + found.free_border;
  found.blocked_share = border > 0 ? blocked / border : 0;
  return found;
}

}  // namespace geoprior::paper
