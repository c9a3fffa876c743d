#include "experiments/details/measures.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>

#include "core/error.h"
#include "core/mesh.h"
#include "experiments/frame_arrays.h"

namespace geoprior {
namespace {

const NamedArray& required_array(const Part& part, const char* name) {
  const NamedArray* array = find_array(part, name);
  if (array == nullptr) throw Error(std::string("has no array '") + name + "'", "part of a frame");
  return *array;
}

template <class T>
std::vector<T> column(const Part& part, const char* name) {
  const Eigen::MatrixXd& values = required_array(part, name).values;
  std::vector<T> out(static_cast<std::size_t>(values.rows()));
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
        barycentric(required_array(part, "barycentric").values) {}

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

/// Height of a detail of weight 1 (m).
double height_of(const DetailsScene& scene) {
  if (scene.chosen_height) return *scene.chosen_height;
  return spacing_of(required_part(scene.rest(), "detail_mesh"), 0).mean / 2;
}

/// One frame of `motion_measures`.
struct FrameState {
  std::shared_ptr<const Part> surface;
  FrameDetails details;
  int still = 0;  ///< frames that the surface has not moved for
};

FrameState state_of(const FrameSequence& frames, std::size_t i) {
  const auto surface = frames.part(i, "surface");
  const auto details = frames.part(i, "details");
  if (!surface || !details) {
    throw Error("has no surface with details", "frame " + std::to_string(i),
                "parts \"surface\" and \"details\"");
  }
  return {surface, FrameDetails(*details), 0};
}

}  // namespace

const Part& required_part(const Frame& frame, const char* name) {
  const auto found = frame.parts.find(name);
  if (found != frame.parts.end()) return found->second;
  throw Error(std::string("has no part '") + name + "'",
              "frame at " + std::to_string(frame.parameter) + " s",
              "surface, details, detail_mesh, visible_mesh");
}

DetailSpacing spacing_of(const Part& mesh, double reference) {
  const std::vector<char> ghosts = column<char>(mesh, "ghost");
  return detail_spacing(mesh.points, mesh.triangles, ghosts, reference);
}

SpacingPair spacing_pair(DetailsMemo& memo, const DetailsScene& scene, const Frame& frame,
                         bool visible) {
  const char* name = visible ? "visible_mesh" : "detail_mesh";
  const auto measured = [&](const Frame& f, double reference) {
    const Part& mesh = required_part(f, name);
    ContentKey key;
    key.add_matrix(mesh.points);
    key.add_matrix(mesh.triangles);
    key.add(std::bit_cast<std::uint64_t>(reference));
    return memo.spacing.get(key, [&] { return spacing_of(mesh, reference); });
  };
  SpacingPair pair;
  pair.rest = measured(scene.rest(), 0);
  pair.now = measured(frame, pair.rest.mean);
  return pair;
}

double details_over_wanted(const DetailsScene& scene, const Frame& frame, bool visible) {
  const auto areas = [](const Frame& f) {
    const Part& surface = required_part(f, "surface");
    return triangle_areas(surface.points, surface.triangles);
  };
  const std::vector<double> weights = column<double>(required_part(frame, "details"), "weight");
  const auto count =
      std::count_if(weights.begin(), weights.end(), [&](double w) { return !visible || w > 0.5; });
  const std::vector<int> faces = column<int>(required_part(scene.rest(), "details"), "face");
  return density_ratio(static_cast<int>(count), faces, areas(scene.rest()), areas(frame));
}

Value worst_edge_change(const DetailsScene& scene, const FrameSequence& frames, bool visible) {
  const char* name = visible ? "visible_mesh" : "detail_mesh";
  std::vector<DetailSpacing> spacings{spacing_of(required_part(scene.rest(), name), 0)};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto mesh = frames.part(i, name);
    if (!mesh) return {};
    spacings.push_back(spacing_of(*mesh, 0));
  }
  if (!(spacings.front().mean > 0)) return {};
  return std::abs(worst_mean_change(spacings).change);
}

MotionMeasures motion_measures(const DetailsScene& scene, const FrameSequence& frames) {
  constexpr int kStillAfter = 10;
  MotionMeasures m;
  if (frames.size() == 0) return m;
  const double height = height_of(scene);
  std::vector<DetailChanges> changes;
  FrameState before = state_of(frames, 0);
  std::vector<double> counts{static_cast<double>(before.details.birth.size())};
  for (std::size_t i = 1; i < frames.size(); ++i) {
    FrameState now = state_of(frames, i);
    counts.push_back(static_cast<double>(now.details.birth.size()));
    changes.push_back(detail_changes(before.details.state(), now.details.state()));
    const double pop = largest_pop({now.surface->points, now.surface->triangles},
                                   before.details.anchored(), now.details.anchored(), height);
    m.popping = std::max(m.popping.value_or(0), pop / height);
    if (now.surface->points == before.surface->points) now.still = before.still + 1;
    if (now.still > kStillAfter)
      m.at_rest = m.at_rest.value_or(0) + now.details.events_since(before.details);
    before = std::move(now);
  }
  m.events = detail_events(changes);
  m.turns = turns(counts, std::max(1.0, 0.01 * counts.front()));
  return m;
}

}  // namespace geoprior
