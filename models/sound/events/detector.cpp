#include "models/sound/events/detector.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace geoprior::sound {

using Eigen::Vector3d;

namespace {

/// Share of a resonator's border that is no free border, from which on it cracs: the thesis gives
/// none; at half neither kind of border is the longer one.
constexpr double kCrumpledShare = 0.5;

}  // namespace

void describe(OptionVisitor& v, DetectionOptions& o) {
  v.value("spacing", o.spacing,
          {.doc = "spacing of the grid of the pattern on which curvature is looked at",
           .unit = "m",
           .min = 1e-6});
  v.value("radius", o.radius,
          {.doc = "radius over which curvature is smoothed: a Gaussian's standard deviation",
           .unit = "m",
           .min = 0});
  v.value("least_energy", o.least_energy,
          {.doc = "least energy of a flap or crac: half a square centimetre of office paper bent "
                  "to a radius of 10 cm holds 1e-6 J",
           .unit = "J",
           .min = 0});
  v.value("tears", o.tears, {.doc = "whether steps of tears are heard"});
  describe_group(v, "flips", o.flips, {.doc = "sudden changes of the sign of curvature"});
  describe_group(v, "resonator", o.resonator,
                 {.doc = "what bounds the part of the sheet that swings"});
}

SoundDetector::SoundDetector(const Sheet& sheet, const DetectionOptions& options)
    : sheet_(sheet),
      options_(options),
      sampler_(sound_grid(sheet.pattern, options.spacing), options.radius),
      flips_(sampler_.grid(), options.flips),
      slides_(sheet, sampler_.grid()) {}

bool SoundDetector::is_held(const Eigen::Vector2d& place) const {
  return std::any_of(sheet_.handles.begin(), sheet_.handles.end(), [&](const Handle& handle) {
    return handle.motion && handle.is_active(field_.time) &&
           handle.distance(place) <= options_.spacing;
  });
}

Resonator SoundDetector::resonator(const std::vector<int>& seeds) {
  if (parts_.empty()) parts_ = cut_at_creases(grid(), field_, options_.resonator);
  return find_resonator(grid(), field_, parts_, seeds,
                        [&](const Eigen::Vector2d& place) { return is_held(place); });
}

ResonatorShape SoundDetector::shape(const SoundEvent& event) const {
  return resonator_shape(grid(), field_, event,
                         [&](const Eigen::Vector2d& place) { return is_held(place); });
}

SoundEvent SoundDetector::snap(const FlipCluster& cluster) {
  std::vector<int> seeds;
  for (const CellFlip& flip : cluster.flips) {
    if (field_.inside[flip.cell]) seeds.push_back(flip.cell);
  }
  SoundEvent event;
  event.time = cluster.time();
  event.duration = cluster.flips.back().time - event.time;
  event.flipped_area = cluster.area(grid());
  const double held = sheet_.material.bending_stiffness() / 2 * grid().cell_area();
  for (const CellFlip& flip : cluster.flips) {
    event.duration = std::max(event.duration, flip.duration);
    event.position += field_.place.row(flip.cell).transpose();
    event.energy += held * flip.before * flip.before;
    // The curvature before has the other sign than the one after.
    event.flips.push_back({flip.cell, flip.after + std::copysign(flip.before, flip.after)});
  }
  std::sort(event.flips.begin(), event.flips.end(),
            [](const FlippedCell& a, const FlippedCell& b) { return a.cell < b.cell; });
  event.position /= static_cast<double>(cluster.flips.size());
  if (seeds.empty()) return event;
  Resonator found = resonator(seeds);
  event.kind = found.blocked_share > kCrumpledShare ? SoundKind::crac : SoundKind::flap;
  event.ruling_length = found.ruling_length;
  event.free_border = found.free_border;
  event.area = found.area;
  event.curvature = found.curvature;
  event.blocked_share = found.blocked_share;
  event.cells = std::move(found.cells);
  return event;
}

void SoundDetector::add_snaps(const std::vector<FlipCluster>& clusters,
                              std::vector<SoundEvent>& events) {
  for (const FlipCluster& cluster : clusters) {
    SoundEvent event = snap(cluster);
    if (event.energy >= options_.least_energy) events.push_back(std::move(event));
  }
}

/// Every place that a tip has come to since the last frame is an event.
void SoundDetector::add_tears(const SheetSnapshot& frame, std::vector<SoundEvent>& events) {
  const double until = torn_until_.value_or(frame.time);
  for (std::size_t i = 1; i < frame.torn.size(); ++i) {
    const TornPlace &from = frame.torn[i - 1], &to = frame.torn[i];
    if (from.tear != to.tear || to.time <= until || to.time > frame.time) continue;
    const Eigen::Vector2d step = to.pattern - from.pattern;
    if (!(step.norm() > 0)) continue;
    SoundEvent event;
    event.kind = SoundKind::tear;
    event.time = to.time;
    event.position = to.position;
    event.energy = sheet_.toughness.at(to.pattern, step.normalized()) * sheet_.material.thickness *
                   step.norm();
    event.flipped_area = sheet_.material.thickness * step.norm();
    const int cell = grid().at(to.pattern);
    if (field_.inside[cell]) {
      Resonator found = resonator({cell});
      event.ruling_length = found.ruling_length;
      event.free_border = found.free_border;
      event.area = found.area;
      event.curvature = found.curvature;
      event.blocked_share = found.blocked_share;
      event.cells = std::move(found.cells);
    }
    events.push_back(std::move(event));
  }
  torn_until_ = frame.time;
}

std::vector<SoundEvent> SoundDetector::push(const SheetSnapshot& frame, RunContext& context) {
  std::vector<FlipCluster> clusters;
  std::vector<SoundEvent> events;
  {
    const Phase phase(context, "detect");
    field_ = sampler_.sample(frame);
    parts_.clear();
    clusters = flips_.push(field_);
    events = slides_.push(field_);
  }
  const Phase phase(context, "resonators");
  add_snaps(clusters, events);
  if (options_.tears) add_tears(frame, events);
  std::stable_sort(events.begin(), events.end(),
                   [](const SoundEvent& a, const SoundEvent& b) { return a.time < b.time; });
  return events;
}

std::vector<SoundEvent> SoundDetector::finish(RunContext& context) {
  const Phase phase(context, "resonators");
  std::vector<SoundEvent> events = slides_.finish();
  add_snaps(flips_.finish(), events);
  std::stable_sort(events.begin(), events.end(),
                   [](const SoundEvent& a, const SoundEvent& b) { return a.time < b.time; });
  return events;
}

void SoundDetector::save(StateWriter& out) const {
  flips_.save(out);
  slides_.save(out);
  out.number(torn_until_.value_or(0));
  out.matrix(field_.velocity);
}

void SoundDetector::load(StateReader& in, const SheetSnapshot& last) {
  flips_.load(in);
  slides_.load(in);
  torn_until_ = in.number<double>();
  field_ = sampler_.sample(last);
  in.matrix(field_.velocity);
  sampler_.set_last(field_);
}

}  // namespace geoprior::sound
