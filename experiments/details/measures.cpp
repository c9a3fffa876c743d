#include "experiments/details/measures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "experiments/details/scene/drawing.h"
#include "metrics/contact/drawn_pop.h"

namespace geoprior::details {
namespace {

template <class T>
std::vector<T> column(const Part& part, const char* name) {
  const Eigen::MatrixXd& values = part.require_array(name, NamedArray::On::points, 1).values;
  std::vector<T> out(values.rows());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<T>(values(static_cast<Eigen::Index>(i), 0));
  return out;
}

/// The details of a frame with what `largest_pop` reads, whose spans point into it.
struct FrameDetails {
  std::vector<std::int64_t> birth;
  std::vector<double> weight, target;
  std::vector<int> face;
  Eigen::MatrixX3d barycentric;

  explicit FrameDetails(const Part& part)
      : birth(column<std::int64_t>(part, "birth")),
        weight(column<double>(part, "weight")),
        target(column<double>(part, "target_weight")),
        face(column<int>(part, "face")),
        barycentric(part.require_array("barycentric", NamedArray::On::points, 3).values) {}

  [[nodiscard]] DetailsOfFrame state() const { return {birth, weight}; }
  [[nodiscard]] AnchoredDetails anchored() const { return {state(), face, barycentric}; }

  /// Details that are new, or that began to fade, since `before`.
  [[nodiscard]] int events_since(const FrameDetails& before) const {
    std::set<std::int64_t> there(before.birth.begin(), before.birth.end()), fading;
    for (std::size_t i = 0; i < before.birth.size(); ++i)
      if (before.target[i] == 0) fading.insert(before.birth[i]);
    int events = 0;
    for (std::size_t i = 0; i < birth.size(); ++i) {
      const bool is_new = !there.contains(birth[i]);
      const bool fades = target[i] == 0 && !fading.contains(birth[i]);
      if (is_new || fades) ++events;
    }
    return events;
  }
};

/// Height of a detail of weight 1 (m); 0 when nothing says it.
double height_of(const DetailsScene& scene) {
  if (scene.chosen_height) return *scene.chosen_height;
  return spacing_of(scene.rest().require_part("detail_mesh"), 0).mean / 2;
}

/// One frame of a motion.
struct FrameState {
  std::shared_ptr<const Part> surface;
  FrameDetails details;
  int still = 0;  ///< frames that the surface has not moved for
};

std::vector<SurfacePoint> places_of(const std::vector<Detail>& details) {
  std::vector<SurfacePoint> places;
  for (const Detail& d : details) places.push_back(d.at);
  return places;
}

std::vector<SurfacePoint> visible_places(const Part& part) {
  const FrameDetails details(part);
  std::vector<SurfacePoint> places;
  for (std::size_t i = 0; i < details.face.size(); ++i) {
    if (!(details.weight[i] > 0.5)) continue;
    const auto b = details.barycentric.row(static_cast<Eigen::Index>(i));
    places.push_back({details.face[i], b.transpose()});
  }
  return places;
}

PairCurve curve_of(PairMemo& memo, const DetailsScene& scene, const Part& surface,
                   const std::vector<SurfacePoint>& places, double unit) {
  ContentKey key;
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

/// A rectangle in a plane of constant z with edges along x and y.
bool fills_rectangle(const Part& surface) {
  const Eigen::RowVector3d size =
      surface.points.colwise().maxCoeff() - surface.points.colwise().minCoeff();
  if (size.z() > 1e-9 * size.norm()) return false;
  const double area = triangle_areas(surface.points, surface.triangles).sum();
  return std::abs(area - size.x() * size.y()) <= 1e-6 * area;
}

RadialSpectrum spectrum_of(const Part& plane, const std::vector<SurfacePoint>& places,
                           double unit) {
  Eigen::MatrixX2d points(static_cast<Eigen::Index>(places.size()), 2);
  for (std::size_t i = 0; i < places.size(); ++i) {
    points.row(static_cast<Eigen::Index>(i)) =
        position_of(places[i], plane.points, plane.triangles).head<2>();
  }
  const Eigen::Vector2d low = plane.points.leftCols<2>().colwise().minCoeff();
  const Eigen::Vector2d high = plane.points.leftCols<2>().colwise().maxCoeff();
  // A detail on the border may be off by round-off.
  points = points.cwiseMax(low.transpose().replicate(points.rows(), 1))
               .cwiseMin(high.transpose().replicate(points.rows(), 1));
  return radial_spectrum(points, low, high, unit);
}

/// The ring of a pattern that keeps its distance is near 1 cycle a spacing; beyond, few agree.
double elongation_of(const RadialSpectrum& spectrum) {
  constexpr double kBeyondRing = 1.2;
  const Eigen::VectorXd weight =
      (spectrum.frequency.array() < kBeyondRing)
          .select(spectrum.count.cast<double>(), Eigen::VectorXd::Zero(spectrum.count.size()));
  return spectrum.elongation.dot(weight) / weight.sum();
}

ContentKey key_of(const Frame& rest) {
  ContentKey key;
  key.add_matrix(rest.require_part("surface").points);
  key.add_matrix(rest.require_part("detail_mesh").points);
  return key;
}

SpectrumAtRest spectrum_at_rest(SpectrumMemo& memo, const DetailsScene& scene, double unit) {
  return memo.get(key_of(scene.rest()), [&] {
    const Part& plane = scene.rest().require_part("surface");
    SpectrumAtRest rest;
    rest.spectrum = spectrum_of(plane, places_of(scene.input.details), unit);
    for (const auto& resample : scene.resamples) {
      const double distance =
          radial_spectrum_distance(spectrum_of(plane, places_of(resample), unit), rest.spectrum);
      rest.noise = rest.noise.value_or(0) + distance / static_cast<double>(scene.resamples.size());
    }
    return rest;
  });
}

PairAtRest pairs_at_rest(PairMemo& memo, const DetailsScene& scene) {
  const Part& surface = scene.rest().require_part("surface");
  const Part& mesh = scene.rest().require_part("detail_mesh");
  return memo.at_rest.get(key_of(scene.rest()), [&] {
    PairAtRest rest;
    rest.unit = spacing_of(mesh, 0).mean;
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

DetailSpacing spacing_of(const Part& mesh, double reference) {
  const std::vector<char> ghosts = column<char>(mesh, "ghost");
  return detail_spacing(mesh.points, mesh.triangles, ghosts, reference);
}

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
  const std::vector<int> faces = column<int>(scene.rest().require_part("details"), "face");
  const std::vector<double> weights = column<double>(frame.require_part("details"), "weight");
  const Eigen::VectorXd then = areas(scene.rest()), now = areas(frame);
  const auto count = static_cast<int>(weights.size());
  const auto visible =
      std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0.5; });
  return {density_ratio(count, faces, then, now),
          density_ratio(static_cast<int>(visible), faces, then, now),
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
  m.distance = distance(visible_places(frame.require_part("details")));
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
  if (!fills_rectangle(surface) || !fills_rectangle(scene.rest().require_part("surface")))
    return {};
  const double unit = spacing_of(scene.rest().require_part("detail_mesh"), 0).mean;
  if (!(unit > 0)) return {};
  const SpectrumAtRest rest = spectrum_at_rest(memo, scene, unit);
  const RadialSpectrum now = spectrum_of(surface, visible_places(details), unit);
  SpectrumMeasures m;
  m.distance = radial_spectrum_distance(now, rest.spectrum);
  m.noise = rest.noise;
  m.elongation = elongation_of(now);
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
      m.at_rest = m.at_rest.value_or(0) + now.details.events_since(before.details);
    before = std::move(now);
  }
  m.events = detail_events(changes);
  m.turns = turns(counts, std::max(1.0, 0.01 * counts.front()));
  return m;
}

Value drawn_popping(const DetailsScene& scene, const FrameSequence& frames) {
  if (!scene.drawing) return {};
  const double edge = spacing_of(scene.rest().require_part("detail_mesh"), 0).mean;
  const double size = drawn_size(scene.drawing->look, edge);
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
