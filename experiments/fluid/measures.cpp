#include "experiments/fluid/measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/mesh.h"
#include "metrics/contact/self_contact.h"
#include "metrics/tracks/tracked_objects.h"
#include "metrics/volume/dam_break.h"
#include "metrics/volume/enclosed_volume.h"
#include "metrics/volume/seam_columns.h"
#include "metrics/volume/shared_volume.h"
#include "metrics/volume/slosh.h"
#include "metrics/volume/volume.h"

namespace geoprior::fluid {
namespace {

TriMesh mesh_of(const Part& part) { return {part.points, part.triangles}; }

TriMesh mesh_of(const Frame& frame) { return mesh_of(surface_part(frame)); }

/// Absent without gauges or triangles.
std::optional<Columns> columns_of(const FluidScene& scene, const TriMesh& mesh) {
  if (!scene.gauges || mesh.triangle_count() == 0) return {};
  return columns(mesh, *scene.gauges);
}

/// One half space of water that starts tilted in a tank with nothing in it.
bool is_sloshing(const FluidScene& scene) {
  if (!scene.tank->solids.empty()) return false;
  const std::vector<LiquidVolume>& volumes = scene.tank->volumes;
  return volumes.size() == 1 && volumes.front().shape.kind == LiquidShape::Kind::half_space;
}

/// The values of points that a surface may have, one each; null when it has none of that name.
/// @throws Error  when there are more of a point
const Eigen::MatrixXd* values_of(const Part& surface, const char* name) {
  constexpr auto kPoints = NamedArray::On::points;
  if (surface.find_array(name, kPoints) == nullptr) return nullptr;
  return &surface.require_array(name, kPoints, 1, "part 'surface'").values;
}

/// A flag a vertex: whether a feature moved it; absent for surfaces that none was pasted into.
std::optional<std::vector<char>> moved_by_features(const Part& surface) {
  const Eigen::MatrixXd* feature = values_of(surface, "feature");
  if (feature == nullptr) return {};
  std::vector<char> moved(surface.points.rows());
  for (std::size_t v = 0; v < moved.size(); ++v) {
    moved[v] = (*feature)(v, 0) != 0 ? 1 : 0;
  }
  return moved;
}

/// What a frame of the sequence shows to the gauges.
struct GaugeFrame {
  Eigen::VectorXd heights, target;
  std::vector<char> seam;
};

GaugeFrame gauge_frame(const FluidScene& scene, const FrameSequence& frames, std::size_t i,
                       bool at_seam) {
  GaugeFrame gauge;
  const auto surface = frames.part(i, "surface");
  if (!surface) return gauge;
  if (!at_seam) {
    gauge.heights = columns(mesh_of(*surface), *scene.gauges).top;
    return gauge;
  }
  // Drops have no seam: they fly through the gauges of both.
  const auto bed_of = [](const TriMesh& mesh) { return TriMesh{mesh.V, largest_component(mesh)}; };
  const TriMesh bed = bed_of(mesh_of(*surface));
  gauge.heights = columns(bed, *scene.gauges).top;
  const std::optional<std::vector<char>> moved = moved_by_features(*surface);
  gauge.seam = moved ? seam_columns(*scene.gauges, bed, *moved)
                     : std::vector<char>(scene.gauges->count(), 0);
  const SurfaceSequence& target = *scene.sculpt.target;
  const int frame = target.nearest_frame(frames.parameter(i));
  gauge.target = columns(bed_of(target.frame(frame).mesh), *scene.gauges).top;
  return gauge;
}

TrackedFrames true_objects(const InjectedSequence& injected) {
  TrackedFrames frames(injected.frame_count());
  for (const InjectedTruth& truth : injected.truth()) {
    frames[truth.frame].push_back(
        {truth.id, truth.isolated ? 1 : 2, truth.centre, truth.box_min, truth.box_max});
  }
  return frames;
}

}  // namespace

const Part& surface_part(const Frame& frame) {
  return frame.require_part("surface", Part::Kind::triangles);
}

LiquidMeasures liquid_measures(const FluidScene& scene, const Frame& frame) {
  LiquidMeasures m;
  const TriMesh mesh = mesh_of(frame);
  m.closed = closedness(mesh);
  m.triangles = mesh.F.rows();
  if (mesh.triangle_count() == 0) return m;
  m.top = mesh.V.col(2).maxCoeff();
  m.volume = enclosed_volume(mesh, m.closed);
  const double density = scene.tank ? scene.tank->density : 1000;
  if (m.volume && *m.volume != 0) {
    m.potential_energy = -density * *m.volume * scene.gravity.dot(volume_centroid(mesh));
  }
  return m;
}

std::optional<PasteMeasures> paste_measures(const FluidScene&, const Frame& frame) {
  const Part& surface = surface_part(frame);
  const std::optional<std::vector<char>> moved = moved_by_features(surface);
  if (!moved) return {};
  return PasteMeasures{largest_seam_angle(mesh_of(surface), *moved),
                       intersecting_pairs(surface.points, surface.triangles)};
}

std::optional<SeamJumps> paste_jumps(const FluidScene&, const Frame& frame) {
  const Part& surface = surface_part(frame);
  const std::optional<std::vector<char>> moved = moved_by_features(surface);
  if (!moved) return {};
  const SeamJumps jumps = seam_jumps(mesh_of(surface), *moved);
  if (jumps.places == 0) return {};
  return jumps;
}

Value particle_overlap(const FluidScene& scene, const Frame& frame) {
  const Part* particles = frame.find_part("particles");
  if (particles == nullptr || !scene.tank) return {};
  const TriMesh mesh = mesh_of(frame);
  if (closedness(mesh).defects() != 0) return {};
  const Tank& tank = *scene.tank;
  const double radius = tank.cell / 2;
  const Eigen::AlignedBox3d room(tank.origin,
                                 tank.origin + tank.cell * tank.cells.cast<double>().matrix());
  const Eigen::Index count = particles->points.rows();
  return shared_volume({particles->points, Eigen::VectorXd::Constant(count, radius)}, mesh,
                       radius / 2, room)
      .intersection_over_union();
}

std::optional<DamMeasures> dam_measures(const FluidScene& scene, const Frame& frame) {
  const std::optional<double> a = scene.dam_width();
  if (!a) return {};
  const TriMesh mesh = mesh_of(frame);
  const std::optional<Columns> columns = columns_of(scene, mesh);
  if (!columns) return {};
  DamMeasures dam;
  const double rate = std::sqrt(scene.gravity.norm() / *a);
  dam.front_time = frame.parameter * std::numbers::sqrt2 * rate;
  dam.height_time = frame.parameter * rate;
  const double front = dam_front(mesh, *columns, *scene.gauges, scene.tank->cell / 2);
  dam.front = (front - scene.tank->origin.x()) / *a;
  dam.at_far_wall = front > scene.tank->origin.x() + (scene.tank->cells.x() - 1) * scene.tank->cell;
  dam.height = dam_height(*columns, *scene.gauges) / (2 * *a);
  return dam;
}

SurfaceDeviation surface_distance(const FluidScene& scene, const Frame& frame,
                                  const Frame& reference) {
  return mutual_deviation(mesh_of(frame), mesh_of(reference), std::max(scene.cell / 2, 1e-9));
}

std::optional<HeightMeasures> height_comparison(const FluidScene& scene, const Frame& frame,
                                                const Frame& reference) {
  const TriMesh theirs = mesh_of(reference);
  const std::optional<Columns> a = columns_of(scene, mesh_of(frame));
  const std::optional<Columns> b = columns_of(scene, theirs);
  if (!a || !b) return {};
  HeightMeasures m;
  m.columns = compare_columns(a->top, b->top);
  if (closedness(theirs).components == 1) m.landed_rms = m.columns.rms;
  return m;
}

Value volume_change(const FluidScene&, const Frame& frame, const Frame& reference) {
  const Value a = enclosed_volume(mesh_of(frame));
  const Value b = enclosed_volume(mesh_of(reference));
  if (!a || !b || *b == 0) return {};
  return *a / *b - 1;
}

std::optional<TankMeasures> tank_measures(const FluidScene& scene, const FrameSequence& frames) {
  if (!scene.tank || !scene.tank->sources.empty()) return {};
  bool sloshes = is_sloshing(scene);
  std::vector<Value> volumes;
  std::vector<Columns> gauges;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto surface = frames.part(i, "surface");
    if (!surface) return {};
    const TriMesh mesh = mesh_of(*surface);
    volumes.push_back(enclosed_volume(mesh));
    if (!sloshes) continue;
    const std::optional<Columns> at = columns_of(scene, mesh);
    sloshes = at.has_value();
    if (at) gauges.push_back(*at);
  }
  TankMeasures m;
  m.volume_drift = largest_drift(volumes);
  if (!sloshes) return m;
  const double length = scene.tank->cells.x() * scene.tank->cell;
  m.slosh_frequency_error = slosh_frequency_error(frames.parameters(), gauges, *scene.gauges,
                                                  length, scene.gravity.norm());
  return m;
}

std::optional<SeaState> sea_state(const Frame& frame) {
  const Part* samples = frame.find_part("samples");
  const FrameTable* table = frame.find_table("sea");
  if (samples == nullptr || table == nullptr) return {};
  const auto values = [&](const char* name) -> const Eigen::MatrixXd& {
    return samples->require_array(name, NamedArray::On::points, 1, "part 'samples'").values;
  };
  const Eigen::Index nx = samples->grid_size[0], ny = samples->grid_size[1];
  if (samples->kind != Part::Kind::grid || samples->grid_size[2] != 1) {
    throw Error("is no flat grid", "part 'samples'", "points along x and y");
  }
  if (table->rows.rows() != 1 || table->rows.cols() != 4) {
    throw Error("has " + std::to_string(table->rows.rows()) + " rows of " +
                    std::to_string(table->rows.cols()) + " columns",
                "table 'sea'", "one row: depth, gravity, wind and variance");
  }
  const auto row = table->rows.row(0);
  SeaState sea;
  sea.patch = {static_cast<double>(nx) * samples->grid_spacing.x(),
               static_cast<double>(ny) * samples->grid_spacing.y(), row[1], row[0]};
  const double wind = row[2] * std::numbers::pi / 180;
  sea.wind = {std::cos(wind), std::sin(wind)};
  sea.expected_variance = row[3];
  sea.heights = values("height").reshaped(nx, ny);
  sea.rates = values("rate").reshaped(nx, ny);
  return sea;
}

std::optional<SeaMeasures> sea_measures(const FluidScene&, const Frame& frame) {
  const std::optional<SeaState> sea = sea_state(frame);
  if (!sea) return {};
  const Moments of_heights = moments(sea->heights.reshaped());
  SeaMeasures m;
  m.significant_height = 4 * std::sqrt(of_heights.variance);
  if (sea->expected_variance != 0) m.variance_ratio = of_heights.variance / sea->expected_variance;
  m.kurtosis = of_heights.kurtosis;
  m.downwind_share = share_running_along(fourier_modes(sea->heights), fourier_modes(sea->rates),
                                         sea->wind, sea->patch);
  return m;
}

Value sea_dispersion(const FluidScene&, const FrameSequence& frames) {
  Eigen::MatrixXcd modes[3];
  Value worst;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::optional<SeaState> sea = sea_state(*frames.frame(i));
    if (!sea) return {};
    modes[0] = std::move(modes[1]);
    modes[1] = std::move(modes[2]);
    modes[2] = fourier_modes(sea->heights);
    if (i > 0 && (modes[1].rows() != modes[2].rows() || modes[1].cols() != modes[2].cols())) {
      throw Error("has another number of points than the one of the frame before",
                  "part 'samples' at " + std::to_string(frames.parameter(i)) + " s");
    }
    if (i < 2) continue;
    const double interval = (frames.parameter(i) - frames.parameter(i - 2)) / 2;
    const DispersionError error =
        dispersion_error(modes[0], modes[1], modes[2], interval, sea->patch);
    if (error.modes > 0) worst = std::max(worst.value_or(0), error.max);
  }
  return worst;
}

SecondDifference second_difference(const FluidScene& scene, const FrameSequence& frames,
                                   bool at_seam) {
  SecondDifference result;
  if (!scene.gauges || frames.size() < 3 || (at_seam && !scene.sculpt.target)) return result;
  GaugeFrame before = gauge_frame(scene, frames, 0, at_seam);
  GaugeFrame now = gauge_frame(scene, frames, 1, at_seam);
  double pasted = 0, target = 0;
  for (std::size_t i = 2; i < frames.size(); ++i) {
    GaugeFrame after = gauge_frame(scene, frames, i, at_seam);
    if (before.heights.size() == 0 || now.heights.size() == 0 || after.heights.size() == 0) {
      return {};
    }
    const Eigen::VectorXd middle = at_seam ? values_where(now.heights, now.seam) : now.heights;
    pasted = std::max(pasted, largest_second_difference(before.heights, middle, after.heights));
    if (at_seam) {
      target =
          std::max(target, largest_second_difference(
                               before.target, values_where(now.target, now.seam), after.target));
    }
    before = std::move(now);
    now = std::move(after);
  }
  result.pasted = pasted;
  if (at_seam) result.target = target;
  return result;
}

std::optional<TrackingScores> scores_against_truth(const FluidScene& scene,
                                                   const FrameSequence& frames) {
  if (!scene.injected) return {};
  const TrackedFrames truth = true_objects(*scene.injected);
  TrackedFrames found;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto surface = frames.part(i, "surface");
    if (!surface) return {};
    const Eigen::MatrixXd* track = values_of(*surface, "track");
    const Eigen::MatrixXd* kind = values_of(*surface, "kind");
    if (track == nullptr || kind == nullptr) return {};
    found.push_back(tracked_objects(mesh_of(*surface), track->col(0), kind->col(0)));
  }
  if (found.size() != truth.size()) return {};
  TrackingScoreOptions options;
  options.similarity = TrackSimilarity::distance;
  // Half of the reach is a match.
  options.reach = 8 * scene.injected->cell() * scene.injected_resolution;
  return tracking_scores(truth, found, options);
}

}  // namespace geoprior::fluid
