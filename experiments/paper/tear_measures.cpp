#include "experiments/paper/tear_measures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "metrics/tracks/of_values.h"
#include "models/paper/tear/lips.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Pattern points of the two hands that move a sheet; absent when there are not just two.
std::optional<std::pair<Vector2d, Vector2d>> two_hands(const Sheet& sheet) {
  std::vector<Vector2d> hands;
  for (const Handle& handle : sheet.handles) {
    if (!handle.motion || handle.motion->keys.size() < 2) continue;
    const std::vector<Vector2d> anchors = handle.anchors();
    Vector2d sum = Vector2d::Zero();
    for (const Vector2d& p : anchors) sum += p;
    hands.push_back(sum / static_cast<double>(anchors.size()));
  }
  if (hands.size() != 2) return std::nullopt;
  return std::pair(hands[0], hands[1]);
}

/// E_f times the torn section (J).
double energy_of(const Sheet& sheet, const std::vector<TearPath>& paths) {
  const auto toughness = [&](const Vector2d& at, const Vector2d& direction) {
    return sheet.toughness.at(at, direction);
  };
  return fracture_energy(paths, toughness, sheet.material.thickness);
}

}  // namespace

double TornSheet::length() const {
  double sum = 0;
  for (const TearPath& path : paths) sum += path_length(path);
  return sum;
}

std::optional<TornSheet> torn_sheet(const Frame& frame) {
  const Part* part = frame.find_part("tears");
  if (part == nullptr) return std::nullopt;
  using On = NamedArray::On;
  const Eigen::MatrixXd& pattern = part->require_array("pattern", On::points, 2, "tears").values;
  const Eigen::MatrixXd& time = part->require_array("time", On::points, 1, "tears").values;
  const Eigen::MatrixXd& lip = part->require_array("lip", On::points, 1, "tears").values;
  TornSheet sheet;
  for (const std::vector<int>& line : part->lines) {
    if (line.empty() || lip(line.front(), 0) != 0) continue;
    TearPath whole, grown;
    for (std::size_t i = 0; i < line.size(); ++i) {
      whole.emplace_back(pattern.row(line[i]));
      const bool next_grows = i + 1 < line.size() && time(line[i + 1], 0) > 0;
      if (time(line[i], 0) > 0 || next_grows) grown.push_back(whole.back());
    }
    sheet.outlines.push_back(std::move(whole));
    if (grown.size() > 1) sheet.paths.push_back(std::move(grown));
  }
  return sheet;
}

std::optional<TearMeasures> tear_measures(const SheetFrame& f) {
  const auto torn = torn_sheet(f.frame);
  if (!torn) return std::nullopt;
  TearMeasures m;
  m.length = torn->length();
  m.energy = energy_of(f.sheet, torn->paths);
  m.parts = part_count(f.triangles());
  const auto hands = two_hands(f.sheet);
  const TearPath* path = longest_path(torn->paths);
  if (path == nullptr) return m;
  m.bow = path_bow(*path);
  if (!hands) return m;
  m.drift = focal_drift(*path, hands->first, hands->second);
  m.deviation =
      chord_angle_deg(*path, bisector_direction(path->front(), hands->first, hands->second));
  return m;
}

Value energy_gap(FitMemo& fits, const SheetFrame& f) {
  const auto torn = torn_sheet(f.frame);
  if (!torn || torn->paths.empty()) return std::nullopt;
  const Value work = handle_work(f);
  if (!work || !(*work > 0)) return std::nullopt;
  const auto energy = energy_measures(fits, f);
  if (!energy) return std::nullopt;
  double left = *work - energy->membrane - energy->bending - energy->kinetic.value_or(0);
  for (const auto& [handle, force] : handle_forces(f)) {
    const auto& stiffness = f.sheet.handles[handle].stiffness;
    if (stiffness) left -= force.squaredNorm() / (2 * *stiffness);
  }
  return (left - energy_of(f.sheet, torn->paths)) / *work;
}

std::optional<TearingForces> tearing_forces(const PaperScene& scene, const FrameSequence& frames) {
  TearingForces out;
  std::vector<double> growing;
  double length = 0;
  Value last;  // of the frame before, as long as nothing has grown
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::shared_ptr<const Frame> frame = frames.frame(i);
    const SheetFrame f = sheet_frame(scene, *frame);
    const auto torn = torn_sheet(*frame);
    if (!torn) return std::nullopt;
    const double now = torn->length();
    const auto force = handle_force(f);
    if (now > length) {
      if (length == 0) out.onset = last;
      if (force) growing.push_back(force->mean);
    }
    length = now;
    const auto hands = two_hands(f.sheet);
    if (now > 0 || !force || !hands || torn->outlines.size() != 1) continue;
    last = force->max / onset_force(torn->outlines[0].back(), hands->first, hands->second,
                                    f.sheet.toughness.energy, f.sheet.material.thickness);
  }
  out.growing = percentile_of(std::move(growing), 50);
  return out;
}

std::optional<PathComparison> tear_beside_reference(const SheetFrame& f,
                                                    const SheetFrame& reference) {
  const auto here = torn_sheet(f.frame), there = torn_sheet(reference.frame);
  if (!here || !there) return std::nullopt;
  const TearPath *p = longest_path(here->paths), *q = longest_path(there->paths);
  if (p == nullptr || q == nullptr) return std::nullopt;
  return compare_paths(*p, *q);
}

}  // namespace geoprior::paper
