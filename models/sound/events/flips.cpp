#include "models/sound/events/flips.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/disjoint_sets.h"

namespace geoprior::sound {
namespace {

bool before(const CellFlip& a, const CellFlip& b) {
  return std::tie(a.time, a.cell) < std::tie(b.time, b.cell);
}

}  // namespace

void describe(OptionVisitor& v, FlipOptions& o) {
  v.value("threshold", o.threshold,
          {.doc = "curvature beyond which a cell has a sign, k_min", .unit = "1/m", .min = 1e-6});
  v.value("sudden", o.sudden,
          {.doc = "longest time in which a flip goes from k_min on one side to k_min on the other",
           .unit = "s",
           .min = 1e-6});
  v.value("refractory", o.refractory,
          {.doc = "time after a flip in which a cell makes no other", .unit = "s", .min = 0});
  v.value("together", o.together,
          {.doc = "time after the first flip in which flips of neighbours belong to its event",
           .unit = "s",
           .min = 0});
  v.value("least_area", o.least_area,
          {.doc = "least area of the cells of an event", .unit = "m^2", .min = 0});
  v.value("remeshing", o.remeshing,
          {.doc = "whether a cell whose mesh has changed between two frames may flip there, too"});
}

FlipDetector::FlipDetector(const SoundGrid& grid, const FlipOptions& options)
    : grid_(grid), options_(options), cells_(grid.count()), held_(cells_.size(), {0, 0, 0, 0}) {}

void FlipDetector::begin_anew(Cell& cell, const SheetField& field, double curvature) const {
  const bool bent = std::abs(curvature) >= options_.threshold;
  cell.curvature = curvature;
  cell.sign = bent ? (curvature > 0 ? 1 : -1) : 0;
  cell.peak = bent ? std::abs(curvature) : 0;
  cell.left = field.time;
}

std::vector<CellFlip> FlipDetector::flips_of(const SheetField& field) {
  const double dt = field.time - time_, k_min = options_.threshold;
  const double forgotten = std::exp(-dt / options_.sudden);
  std::vector<CellFlip> flips;
  for (int c = 0; c < grid_.count(); ++c) {
    Cell& cell = cells_[c];
    if (!field.inside[c]) continue;
    const double k0 = cell.curvature, k1 = field.curvature[c];
    if (field.remeshed[c] && !options_.remeshing) {
      begin_anew(cell, field, k1);
      continue;
    }
    cell.curvature = k1;
    // When it was k, if it was so between the two frames.
    const auto when = [&](double k) { return time_ + dt * (k - k0) / (k1 - k0); };
    cell.peak *= forgotten;
    if (cell.sign * k0 >= k_min && cell.sign * k1 < k_min) cell.left = when(cell.sign * k_min);
    if (cell.sign * k1 >= k_min) cell.peak = std::max(cell.peak, std::abs(k1));
    if (std::abs(k1) < k_min) continue;
    const int sign = k1 > 0 ? 1 : -1;
    if (sign == cell.sign) {
      cell.left = field.time;
      continue;
    }
    const double entered = started_ && sign * k0 < k_min ? when(sign * k_min) : field.time;
    const double duration = entered - cell.left;
    const double time = (entered + cell.left) / 2;
    if (cell.sign != 0 && duration <= options_.sudden &&
        time - cell.flipped >= options_.refractory) {
      // Forgotten only until it left its threshold: the rest depends on when the next frame is.
      const double peak = cell.peak * std::exp((field.time - cell.left) / options_.sudden);
      flips.push_back({c, time, duration, peak, k1});
      cell.flipped = time;
    }
    cell.sign = sign;
    cell.left = field.time;
    cell.peak = std::abs(k1);
  }
  return flips;
}

/// Flips in order of time join the event of a flip of their own cell or of a cell that it holds
/// together with, when that event began no more than `together` before. What begins before `until`
/// is taken out of the pending ones.
std::vector<FlipCluster> FlipDetector::take(double until) {
  std::sort(pending_.begin(), pending_.end(), before);
  DisjointSets events(static_cast<int>(pending_.size()));  // the earliest flip stands for each
  std::vector<int> last(cells_.size(), -1);                // flip of each cell
  for (int i = 0; i < events.size(); ++i) {
    const int cell = pending_[i].cell;
    const auto join = [&](int other) {
      if (other < 0) return;
      const double first = pending_[events.find(other)].time;
      const double mine = pending_[events.find(i)].time;
      const double now = pending_[i].time;
      if (now - std::min(first, mine) <= options_.together) events.join(i, other);
    };
    join(last[cell]);
    const std::array<int, 4> beside = grid_.neighbours(cell);
    for (std::size_t side = 0; side < 4; ++side) {
      if (beside[side] >= 0 && held_[cell][side] != 0) {
        join(last[beside[side]]);
      }
    }
    last[cell] = i;
  }
  std::map<int, FlipCluster> begun;  // by the number of the earliest flip: in order of time
  std::vector<CellFlip> later;
  for (int i = 0; i < events.size(); ++i) {
    const int event = events.find(i);
    const CellFlip& flip = pending_[i];
    if (pending_[event].time < until) {
      begun[event].flips.push_back(flip);
    } else {
      later.push_back(flip);
    }
  }
  pending_ = std::move(later);
  std::vector<FlipCluster> taken;
  for (auto& entry : begun) {
    if (entry.second.area(grid_) >= options_.least_area) taken.push_back(std::move(entry.second));
  }
  return taken;
}

std::vector<FlipCluster> FlipDetector::push(const SheetField& field) {
  const std::vector<CellFlip> flips = flips_of(field);
  pending_.insert(pending_.end(), flips.begin(), flips.end());
  for (const CellFlip& flip : pending_) {
    for (int side = 0; side < 4; ++side) {
      held_[flip.cell][side] = field.holds(grid_, flip.cell, side) ? 1 : 0;
    }
  }
  time_ = field.time;
  started_ = true;
  // A flip found in the next frame lies after this one, less half of its duration.
  return take(field.time - options_.together - options_.sudden / 2);
}

std::vector<FlipCluster> FlipDetector::finish() {
  return take(std::numeric_limits<double>::infinity());
}

void FlipDetector::save(StateWriter& out) const {
  for (const Cell& c : cells_) {
    for (const double x : {c.curvature, c.peak, c.left, c.flipped}) out.number(x);
    out.number(c.sign);
  }
  out.number(time_);
  out.number(started_);
  out.items(held_);
  out.number(pending_.size());
  for (const CellFlip& f : pending_) {
    out.number(f.cell);
    for (const double x : {f.time, f.duration, f.before, f.after}) out.number(x);
  }
}

void FlipDetector::load(StateReader& in) {
  for (Cell& c : cells_) {
    for (double* x : {&c.curvature, &c.peak, &c.left, &c.flipped}) *x = in.number<double>();
    c.sign = in.number<int>();
  }
  time_ = in.number<double>();
  started_ = in.number<bool>();
  in.items(held_);
  pending_.resize(in.count(sizeof(int) + 4 * sizeof(double)));
  for (CellFlip& f : pending_) {
    f.cell = in.number<int>();
    for (double* x : {&f.time, &f.duration, &f.before, &f.after}) *x = in.number<double>();
  }
}

}  // namespace geoprior::sound
