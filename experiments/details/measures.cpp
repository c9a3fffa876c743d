#include "experiments/details/measures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "experiments/details/scene/drawing.h"
#include "experiments/details/scene/frame_parts.h"
#include "metrics/contact/drawn_pop.h"
#include "metrics/spacing/plane_spectrum.h"

namespace geoprior::details {
namespace {

/// Height of a detail of weight 1 (m); 0 when nothing says it.
double height_of(const DetailsScene& scene) {
  if (scene.chosen_height) return *scene.chosen_height;
  return scene.rest_edge() / 2;
}

/// One frame of a motion.
struct FrameState {
  std::shared_ptr<const Part> surface;
  FrameDetails details;
  int still = 0;  ///< frames that the surface has not moved for
};

ContentKey key_of(const Frame& rest) {
  ContentKey key;
  key.add_matrix(rest.require_part("surface").points);
  key.add_matrix(rest.require_part("detail_mesh").points);
  return key;
}

/// What the scene says of how pairs are measured: cases of one run may differ in it alone.
ContentKey key_of_pairs(const DetailsScene& scene) {
  ContentKey key = key_of(scene.rest());
  key.add(static_cast<std::uint64_t>(scene.pair_sources));
  for (const char inside : scene.region) key.add(static_cast<std::uint64_t>(inside));
  return key;
}

PairCurve curve_of(PairMemo& memo, const DetailsScene& scene, const Part& surface,
                   const std::vector<SurfacePoint>& places, double unit) {
  ContentKey key = key_of_pairs(scene);
  key.add_matrix(surface.points);
  key.add_matrix(surface.triangles);
  for (const SurfacePoint& p : places) {
    key.add(static_cast<std::uint64_t>(p.face));
    key.add_matrix(p.barycentric);
  }
  return memo.curves.get(key, [&] {
    PairCurveMask mask;
    mask.region = scene.region;
    PairCurveOptions options;
    options.reach = 3;
    options.bins = 30;
    options.sources = scene.pair_sources;
    return pair_curve({surface.points, surface.triangles}, places, unit, options, mask);
  });
}

SpectrumAtRest spectrum_at_rest(SpectrumMemo& memo, const DetailsScene& scene, double unit) {
  return memo.get(key_of(scene.rest()), [&] {
    const Part& plane = scene.rest().require_part("surface");
    SpectrumAtRest rest;
    const auto spectrum = [&](const std::vector<Detail>& details) {
      return plane_spectrum({plane.points, plane.triangles}, places_of(details), unit);
    };
    rest.spectrum = spectrum(scene.input.details);
    for (const auto& resample : scene.resamples) {
      const double distance = radial_spectrum_distance(spectrum(resample), rest.spectrum);
      rest.noise = rest.noise.value_or(0) + distance / static_cast<double>(scene.resamples.size());
    }
    return rest;
  });
}

PairAtRest pairs_at_rest(PairMemo& memo, const DetailsScene& scene) {
  const Part& surface = scene.rest().require_part("surface");
  return memo.at_rest.get(key_of_pairs(scene), [&] {
    PairAtRest rest;
    rest.unit = scene.rest_edge();
    if (!(rest.unit > 0)) return rest;
    const auto curve = [&](const std::vector<Detail>& details) {
      return curve_of(memo, scene, surface, places_of(details), rest.unit);
    };
    std::vector<PairCurve> process{curve(scene.input.details)};
    rest.curve = process.front();
    for (const auto& resample : scene.resamples) process.push_back(curve(resample));
    if (process.size() > 1) rest.noise = pair_curve_noise(process).mean;
    return rest;
  });
}

FrameState state_of(const FrameSequence& frames, std::size_t i) {
  const auto details = frames.require_part(i, "details");
  return {frames.require_part(i, "surface"), FrameDetails(*details), 0};
}

/// Base and drawing of one frame.
struct DrawnFrame {
  TriMesh base, drawn;
};

DrawnFrame drawn_frame(const DetailsScene& scene, const FrameSequence& frames, std::size_t i) {
  Frame frame;
  for (const char* name : {"surface", "details"}) frame.parts[name] = *frames.require_part(i, name);
  const Part drawn = drawn_surface(frame, scene);
  const Part& surface = frame.require_part("surface");
  return {{surface.points, surface.triangles}, {drawn.points, drawn.triangles}};
}

/// How far samples of a drawing may be apart: all its vertices are samples, among them the tips of
/// spikes and meshes, but the deepest point of a hole is none.
double pop_sample_spacing(DrawnKind kind, double size) {
  return kind == DrawnKind::hole ? size / 4 : size;
}

Value worst_edge_change(const DetailsScene& scene, const FrameSequence& frames, const char* mesh) {
  std::vector<DetailSpacing> spacings{spacing_of(scene.rest().require_part(mesh), 0)};
  for (std::size_t i = 0; i < frames.size(); ++i)
    spacings.push_back(spacing_of(*frames.require_part(i, mesh), 0));
  if (!(spacings.front().mean > 0)) return {};
  return std::abs(worst_mean_change(spacings).change);
}

}  // namespace

std::optional<SpacingPair> spacing_pair(const DetailsScene& scene, const Frame& frame,
                                        const char* mesh) {
  SpacingPair pair;
  pair.rest = spacing_of(scene.rest().require_part(mesh), 0);
  pair.now = spacing_of(frame.require_part(mesh), pair.rest.mean);
  if (!(pair.rest.mean > 0) || pair.now.edges == 0) return {};
  pair.change = spacing_change(pair.rest, pair.now);
  return pair;
}

DensityMeasures density_measures(const DetailsScene& scene, const Frame& frame) {
  const auto areas = [](const Frame& f) {
    const Part& surface = f.require_part("surface");
    return triangle_areas(surface.points, surface.triangles);
  };
  const FrameDetails original(scene.rest().require_part("details"));
  const FrameDetails details(frame.require_part("details"));
  const Eigen::VectorXd then = areas(scene.rest()), now = areas(frame);
  const auto count = static_cast<int>(details.weight.size());
  return {density_ratio(count, original.face, then, now),
          density_ratio(details.visible_count(), original.face, then, now),
          static_cast<double>(count) / static_cast<double>(scene.input.details.size())};
}

std::optional<PairMeasures> pair_measures(PairMemo& memo, const DetailsScene& scene,
                                          const Frame& frame) {
  if (!scene.measures_pairs(frame.parameter)) return {};
  const Part& now = frame.require_part("surface");
  const PairAtRest rest = pairs_at_rest(memo, scene);
  if (!(rest.unit > 0)) return {};
  const auto distance = [&](const std::vector<SurfacePoint>& places) {
    return pair_curve_distance(curve_of(memo, scene, now, places, rest.unit), rest.curve);
  };
  PairMeasures m;
  m.distance = distance(FrameDetails(frame.require_part("details")).visible_places());
  m.naive = distance(places_of(scene.input.details));
  m.noise = rest.noise;
  return m;
}

std::optional<SpectrumMeasures> spectrum_measures(SpectrumMemo& memo, const DetailsScene& scene,
                                                  const Frame& frame) {
  constexpr Eigen::Index kMostDetails = 5000;
  const Part& surface = frame.require_part("surface");
  const Part& details = frame.require_part("details");
  if (!scene.measures_pairs(frame.parameter) || details.points.rows() > kMostDetails) return {};
  const auto is_rectangle = [](const Part& part) {
    return fills_rectangle({part.points, part.triangles});
  };
  if (!is_rectangle(surface) || !is_rectangle(scene.rest().require_part("surface"))) return {};
  const double unit = scene.rest_edge();
  if (!(unit > 0)) return {};
  const SpectrumAtRest rest = spectrum_at_rest(memo, scene, unit);
  const RadialSpectrum now = plane_spectrum({surface.points, surface.triangles},
                                            FrameDetails(details).visible_places(), unit);
  SpectrumMeasures m;
  m.distance = radial_spectrum_distance(now, rest.spectrum);
  m.noise = rest.noise;
  // The ring of a pattern that keeps its distance is near 1 cycle a spacing; beyond, few agree.
  m.elongation = mean_elongation(now, 1.2);
  return m;
}

MotionMeasures motion_measures(const DetailsScene& scene, const FrameSequence& frames) {
  constexpr int kStillAfter = 10;
  MotionMeasures m;
  if (frames.size() == 0) return m;
  m.worst_edge_change = worst_edge_change(scene, frames, "detail_mesh");
  m.worst_visible_change = worst_edge_change(scene, frames, "visible_mesh");
  const double height = height_of(scene);
  std::vector<DetailChanges> changes;
  FrameState before = state_of(frames, 0);
  std::vector<double> counts{static_cast<double>(before.details.birth.size())};
  for (std::size_t i = 1; i < frames.size(); ++i) {
    FrameState now = state_of(frames, i);
    counts.push_back(static_cast<double>(now.details.birth.size()));
    changes.push_back(detail_changes(before.details.state(), now.details.state()));
    if (height > 0) {
      const double pop = largest_pop({now.surface->points, now.surface->triangles},
                                     before.details.anchored(), now.details.anchored(), height);
      m.popping = std::max(m.popping.value_or(0), pop / height);
    }
    if (now.surface->points == before.surface->points) now.still = before.still + 1;
    if (now.still > kStillAfter)
      m.at_rest = m.at_rest.value_or(0) +
                  details_that_begin(before.details.targets(), now.details.targets());
    before = std::move(now);
  }
  m.events = detail_events(changes);
  m.turns = turns(counts, std::max(1.0, 0.01 * counts.front()));
  return m;
}

Value drawn_popping(const DetailsScene& scene, const FrameSequence& frames) {
  if (!scene.drawing) return {};
  const double size = drawn_size(scene.drawing->look, scene.rest_edge());
  const double spacing = pop_sample_spacing(scene.drawing->look.kind, size);
  Value popping;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (!scene.measures_drawn_pop(frames.parameter(i))) continue;
    const DrawnFrame before = drawn_frame(scene, frames, i - 1),
                     now = drawn_frame(scene, frames, i);
    const DrawnPop pop = drawn_pop(before.base, before.drawn, now.base, now.drawn, spacing);
    const double step = frames.parameter(i) - frames.parameter(i - 1);
    popping = std::max(popping.value_or(0), pop.largest() / size / step);
  }
  return popping;
}

}  // namespace geoprior::details
