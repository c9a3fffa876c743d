#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/topology.h"
#include "experiments/skinning/scene.h"
#include "experiments/skinning/topic.h"
#include "metrics/cross_section.h"
#include "metrics/distance.h"
#include "metrics/distortion.h"
#include "metrics/mid_ring.h"
#include "metrics/overlap_volume.h"
#include "metrics/self_contact.h"
#include "metrics/smoothness.h"
#include "metrics/volume.h"

namespace geoprior {
namespace {

using Value = std::optional<double>;

constexpr double kGlobalSpacings = 768;    // columns along the diagonal of a whole body
constexpr double kGlobalDepth = 48;        // detection depth of a whole body, in column spacings
constexpr double kIdentityPose = 1e-12;    // entry of a transform that still is the rest pose
constexpr std::size_t kRemembered = 1024;  // values kept, a few numbers each

/// 128-bit hash of content: what a remembered value depends on, so that it cannot go stale.
struct ContentKey {
  std::uint64_t a = 0x243F6A8885A308D3ULL;
  std::uint64_t b = 0x13198A2E03707344ULL;
  bool operator==(const ContentKey&) const = default;

  void add(std::uint64_t word) {
    a = std::rotl(a ^ word, 29) * 0x9E3779B97F4A7C15ULL;
    b = std::rotl(b + word, 31) * 0xC2B2AE3D27D4EB4FULL ^ (b >> 33);
  }
  template <class Matrix>
  void add_matrix(const Matrix& m) {
    add(static_cast<std::uint64_t>(m.size()));
    for (Eigen::Index i = 0; i < m.size(); ++i) {
      if constexpr (std::is_same_v<typename Matrix::Scalar, double>) {
        add(std::bit_cast<std::uint64_t>(m.data()[i]));
      } else {
        add(static_cast<std::uint64_t>(m.data()[i]));
      }
    }
  }
};

/// Remembers the last values of one expensive quantity, several metrics of a frame share it. Two
/// threads that miss at once compute the same value twice, which is harmless.
template <class T>
class Memo {
 public:
  T get(const ContentKey& key, const std::function<T()>& compute) {
    {
      const std::lock_guard lock(mutex_);
      for (const auto& [known, value] : entries_) {
        if (known == key) return value;
      }
    }
    T value = compute();
    const std::lock_guard lock(mutex_);
    entries_.emplace_front(key, value);
    if (entries_.size() > kRemembered) entries_.pop_back();
    return value;
  }

 private:
  std::mutex mutex_;
  std::deque<std::pair<ContentKey, T>> entries_;
};

/// One frame of one scene, as every metric sees it.
struct Measured {
  const SkinningScene& scene;
  const Eigen::MatrixX3d& posed;
  const Pose& pose;

  [[nodiscard]] const TriMesh& mesh() const { return scene.rig.mesh; }
  /// The region that metrics report; null for a motion without joints of its own (a clip).
  [[nodiscard]] const JointRegion* region() const {
    return scene.regions.empty() ? nullptr : &scene.regions.front();
  }
};

const Eigen::MatrixX3d& surface_of(const SkinningScene& scene, const Frame& frame) {
  const auto part = frame.parts.find("surface");
  const std::string where = std::string("frame at ").append(std::to_string(frame.parameter));
  if (part == frame.parts.end()) throw Error("no part 'surface'", where, "a skinned surface");
  const Eigen::MatrixX3d& points = part->second.points;
  if (points.rows() != scene.rig.mesh.V.rows()) {
    throw Error(std::to_string(points.rows()) + " vertices in part 'surface'", where,
                std::to_string(scene.rig.mesh.V.rows()) + ", as in the scene");
  }
  return points;
}

Measured measured(const Scene& scene, const Frame& frame) {
  const auto& skinning = dynamic_cast<const SkinningScene&>(scene);
  return {skinning, surface_of(skinning, frame), skinning.pose_at(frame.parameter)};
}

ContentKey key_of(const Measured& m, const Eigen::MatrixX3d& posed, const Pose& pose) {
  ContentKey key;
  key.add_matrix(m.mesh().V);
  key.add_matrix(m.mesh().F);
  key.add_matrix(posed);
  for (const Eigen::Affine3d& T : pose) key.add_matrix(T.matrix());
  if (const JointRegion* region = m.region()) {
    for (const int t : region->triangles) key.add(static_cast<std::uint64_t>(t));
    for (const JointRegion::Hinge& h : region->hinges) {
      key.add(static_cast<std::uint64_t>(h.joint));
      key.add_matrix(h.bend_axis);
      key.add(std::bit_cast<std::uint64_t>(h.radius));
    }
    key.add(std::bit_cast<std::uint64_t>(region->extent));
  }
  return key;
}

/// What the metrics of one table share: the quantities that several of them read.
struct Shared {
  Memo<bool> closed;
  Memo<OverlapStudy> overlap;
  Memo<int> pairs;
  Memo<SectionSummary> sections;
  Memo<DistortionSummary> distortion;
};

bool is_closed(Shared& shared, const Measured& m) {
  ContentKey key;
  key.add_matrix(m.mesh().F);
  return shared.closed.get(key, [&] { return boundary_edges(m.mesh().F).empty(); });
}

OverlapStudy compute_overlap(const Measured& m, const Eigen::MatrixX3d& V, const Pose& pose) {
  if (const JointRegion* region = m.region()) {
    const double spacing = region_column_spacing(*region);
    return overlap_study(V, m.mesh().F, joint_box(*region, pose), spacing,
                         region->hinges.front().radius);
  }
  Eigen::AlignedBox3d box;
  for (Eigen::Index v = 0; v < V.rows(); ++v) box.extend(V.row(v).transpose());
  const double spacing = bounding_box_diagonal(m.mesh().V) / kGlobalSpacings;
  return overlap_study(V, m.mesh().F, box, spacing, kGlobalDepth * spacing);
}

/// Overlap above rest, its noise floor beside it; absent for an open mesh.
std::optional<OverlapStudy> overlap_excess(Shared& shared, const Measured& m) {
  const Pose at_rest = rest_pose(m.scene.rig.skeleton.size());
  const auto study = [&](const Eigen::MatrixX3d& V, const Pose& pose) {
    return shared.overlap.get(key_of(m, V, pose), [&] { return compute_overlap(m, V, pose); });
  };
  if (!is_closed(shared, m)) return std::nullopt;
  const OverlapStudy rest = study(m.mesh().V, at_rest);
  OverlapStudy excess = study(m.posed, m.pose);
  excess.volume -= rest.volume;
  excess.noise_floor = std::max(excess.noise_floor, rest.noise_floor);
  return excess;
}

Value clipped(const std::optional<OverlapStudy>& study) {
  if (!study) return std::nullopt;
  return study->volume > study->noise_floor ? study->volume : 0.0;
}

/// At most 1 where the frame has no more overlap than the reference's or the floor: see its row in
/// the table.
Value overlap_excess_ratio(Shared& shared, const Measured& m, const Measured& reference) {
  const std::optional<OverlapStudy> own = overlap_excess(shared, m);
  const std::optional<OverlapStudy> other = overlap_excess(shared, reference);
  if (!own || !other) return std::nullopt;
  const double floor = std::max(own->noise_floor, other->noise_floor);
  if (own->volume <= floor) return 0.0;
  return own->volume / std::max(other->volume, floor);
}

Value pairs_excess(Shared& shared, const Measured& m) {
  const auto count = [&](const Eigen::MatrixX3d& V) {
    return shared.pairs.get(key_of(m, V, {}), [&] {
      return m.region() ? intersecting_pairs(V, m.mesh().F, *m.region())
                        : intersecting_pairs(V, m.mesh().F);
    });
  };
  return count(m.posed) - count(m.mesh().V);
}

std::optional<SectionSummary> sections_of(Shared& shared, const Measured& m) {
  if (!m.region()) return std::nullopt;
  return shared.sections.get(key_of(m, m.posed, m.pose), [&] {
    return summarize(cross_sections(*m.region(), m.mesh().F, m.mesh().V, m.posed, m.pose));
  });
}

std::optional<DistortionSummary> distortion_of(Shared& shared, const Measured& m) {
  if (!m.region()) return std::nullopt;
  return shared.distortion.get(key_of(m, m.posed, m.pose), [&] {
    return distortion(m.mesh().V, m.posed, m.mesh().F, m.region()->triangles);
  });
}

Value volume_change(const Measured& m) {
  if (!m.region()) return std::nullopt;
  return relative_change(region_volume(m.mesh().V, m.mesh().F, *m.region()),
                         region_volume(m.posed, m.mesh().F, *m.region()));
}

Value volume_change_global(Shared& shared, const Measured& m) {
  if (!is_closed(shared, m)) return std::nullopt;
  return relative_change(signed_volume(m.mesh().V, m.mesh().F), signed_volume(m.posed, m.mesh().F));
}

Value rest_identity(const Measured& m) {
  for (const Eigen::Affine3d& T : m.pose) {
    const auto difference = T.matrix() - Eigen::Matrix4d::Identity();
    if (difference.cwiseAbs().maxCoeff() > kIdentityPose) return std::nullopt;
  }
  return vertex_distance(m.mesh().V, m.posed).max / bounding_box_diagonal(m.mesh().V);
}

std::optional<RingRatio> mid_ring(const Measured& m) {
  if (!m.region() || m.region()->hinges.size() != 1) return std::nullopt;
  const JointRegion::Hinge& hinge = m.region()->hinges.front();
  const std::vector<int> ring =
      find_mid_ring(hinge, m.mesh().V, region_vertices(*m.region(), m.mesh().F));
  if (ring.empty()) return std::nullopt;
  return ring_radius_ratio(m.mesh().V, hinge.head, m.posed,
                           m.pose[static_cast<std::size_t>(hinge.joint)] * hinge.head, ring);
}

VertexDistance reference_distance(const Measured& m, const Measured& reference) {
  const std::vector<int> vertices =
      m.region() ? region_vertices(*m.region(), m.mesh().F) : std::vector<int>{};
  return vertex_distance(m.posed, reference.posed, vertices);
}

/// Posed vertices carried back to rest by the joint of largest weight each: rigid motion drops out.
Eigen::MatrixX3d in_bone_frame(const Measured& m) {
  const SkinWeights& weights = m.scene.rig.weights;
  std::vector<Eigen::Affine3d> back;
  back.reserve(m.pose.size());
  for (const Eigen::Affine3d& T : m.pose) back.push_back(T.inverse());
  Eigen::MatrixX3d local(m.posed.rows(), 3);
  for (int v = 0; v < static_cast<int>(local.rows()); ++v) {
    Eigen::Index dominant = 0;
    double largest = -1;
    for (SkinWeights::InnerIterator it(weights, v); it; ++it) {
      if (it.value() <= largest) continue;
      largest = it.value();
      dominant = it.col();
    }
    const Eigen::Vector3d x = m.posed.row(v).transpose();
    local.row(v) = (back[static_cast<std::size_t>(dominant)] * x).transpose();
  }
  return local;
}

Value second_difference(const Scene& scene, const std::vector<Frame>& frames) {
  std::vector<Eigen::MatrixX3d> positions;
  std::vector<double> parameters;
  for (const Frame& frame : frames) parameters.push_back(frame.parameter);
  const auto& skinning = dynamic_cast<const SkinningScene&>(scene);
  if (frames.size() < 3 || !equally_spaced(parameters) || skinning.regions.empty())
    return std::nullopt;
  for (const Frame& frame : frames) positions.push_back(in_bone_frame(measured(scene, frame)));
  return second_difference_max(positions, parameters,
                               region_vertices(skinning.regions.front(), skinning.rig.mesh.F));
}

MetricEntry entry(std::string name, std::string unit, std::string definition, Direction direction,
                  Tolerance tolerance, std::function<Value(const Measured&)> measure,
                  double target = 0) {
  MetricEntry e;
  e.name = std::move(name);
  e.unit = std::move(unit);
  e.definition = std::move(definition);
  e.direction = direction;
  e.tolerance = tolerance;
  e.target = target;
  e.of_frame = [measure = std::move(measure)](const Scene& scene, const Frame& frame,
                                              const Frame*) {
    return measure(measured(scene, frame));
  };
  return e;
}

MetricEntry reference_entry(std::string name, std::string unit, std::string definition,
                            Tolerance tolerance,
                            std::function<Value(const Measured&, const Measured&)> measure) {
  MetricEntry e = entry(std::move(name), std::move(unit), std::move(definition),
                        Direction::lower_is_better, tolerance, {});
  e.needs_reference = true;
  e.of_frame = [measure = std::move(measure)](const Scene& scene, const Frame& frame,
                                              const Frame* reference) -> Value {
    if (!reference) return std::nullopt;
    return measure(measured(scene, frame), measured(scene, *reference));
  };
  return e;
}

using SharedPtr = std::shared_ptr<Shared>;

void add_volume_metrics(std::vector<MetricEntry>& table, const SharedPtr& shared) {
  const Tolerance ratio{1e-9, 1e-6};
  table.push_back(entry("volume_change", "1",
                        "change of the volume of the joint's region, closed by fans from the "
                        "centroids of its border loops, over its rest volume",
                        Direction::closer_to_target, ratio, volume_change));
  table.push_back(entry("volume_change_size", "1", "absolute value of volume_change",
                        Direction::lower_is_better, ratio, [](const Measured& m) -> Value {
                          const Value change = volume_change(m);
                          return change ? Value(std::abs(*change)) : std::nullopt;
                        }));
  table.push_back(entry("volume_change_global", "1",
                        "change of the signed volume of the whole closed surface over its rest "
                        "volume",
                        Direction::closer_to_target, ratio,
                        [shared](const Measured& m) { return volume_change_global(*shared, m); }));
}

void add_contact_metrics(std::vector<MetricEntry>& table, const SharedPtr& shared) {
  const Tolerance volume{1e-12, 1e-6};
  table.push_back(entry("overlap_excess", "m^3",
                        "integral of max(0, winding number - 1) over the box about the region's "
                        "joints (whole body without a region) minus the same at rest; 0 where it "
                        "does not exceed overlap_noise_floor",
                        Direction::lower_is_better, volume, [shared](const Measured& m) {
                          return clipped(overlap_excess(*shared, m));
                        }));
  table.push_back(entry("overlap_excess_raw", "m^3", "overlap_excess before it is set to 0",
                        Direction::lower_is_better, volume, [shared](const Measured& m) -> Value {
                          const auto study = overlap_excess(*shared, m);
                          return study ? Value(study->volume) : std::nullopt;
                        }));
  table.push_back(entry("overlap_noise_floor", "m^3",
                        "largest difference of the overlap between column spacings h and h/2 and "
                        "between two column axes, at least the overlap that fits between columns",
                        Direction::none, volume, [shared](const Measured& m) -> Value {
                          const auto study = overlap_excess(*shared, m);
                          return study ? Value(study->noise_floor) : std::nullopt;
                        }));
  table.push_back(reference_entry(
      "overlap_excess_ratio", "1",
      "0 where overlap_excess_raw does not exceed the noise floor, else over that of the reference "
      "variant or the floor, whichever is larger",
      {1e-6, 1e-6}, [shared](const Measured& m, const Measured& reference) {
        return overlap_excess_ratio(*shared, m, reference);
      }));
  table.push_back(entry("intersecting_pairs", "1",
                        "pairs of triangles that intersect, at least one of them in the region "
                        "(anywhere without a region), minus the same at rest",
                        Direction::lower_is_better, {2, 0.01},
                        [shared](const Measured& m) { return pairs_excess(*shared, m); }));
}

void add_section_metrics(std::vector<MetricEntry>& table, const SharedPtr& shared) {
  const Tolerance ratio{1e-6, 1e-6};
  const auto add = [&](const char* name, const char* definition, Direction direction, double target,
                       std::optional<double> SectionSummary::*member) {
    table.push_back(entry(
        name, "1", definition, direction, ratio,
        [shared, member](const Measured& m) -> Value {
          const std::optional<SectionSummary> summary = sections_of(*shared, m);
          return summary ? (*summary).*member : std::nullopt;
        },
        target));
  };
  add("section_shrink",
      "smallest area ratio, against rest, of a half cross-section orthogonal to the bones within "
      "the region (whole sections when there is no bend axis)",
      Direction::higher_is_better, 0, &SectionSummary::shrink);
  add("section_bulge", "largest such area ratio", Direction::closer_to_target, 1,
      &SectionSummary::bulge);
  add("outer_bulge",
      "largest relative growth of the half cross-sections on the outer side of the bend",
      Direction::lower_is_better, 0, &SectionSummary::outer_bulge);
  add("elbow_collapse",
      "smallest ratio, against rest, of the distance of the outermost point of a cross-section "
      "from its centre",
      Direction::closer_to_target, 1, &SectionSummary::elbow_collapse);
}

void add_distortion_metrics(std::vector<MetricEntry>& table, const SharedPtr& shared) {
  const Tolerance ratio{1e-6, 1e-6};
  const auto add = [&](const char* name, const char* definition, Direction direction, double target,
                       double DistortionSummary::*member) {
    table.push_back(entry(
        name, "1", definition, direction, ratio,
        [shared, member](const Measured& m) -> Value {
          const std::optional<DistortionSummary> summary = distortion_of(*shared, m);
          return summary ? Value((*summary).*member) : std::nullopt;
        },
        target));
  };
  add("area_ratio_p05",
      "5th percentile, by rest area, of the triangles' area ratio against rest in the region",
      Direction::closer_to_target, 1, &DistortionSummary::area_ratio_p05);
  add("area_ratio_p95",
      "95th percentile, by rest area, of the triangles' area ratio against rest in the region",
      Direction::closer_to_target, 1, &DistortionSummary::area_ratio_p95);
  add("singular_value_max",
      "largest singular value of a triangle's deformation gradient against rest in the region",
      Direction::lower_is_better, 0, &DistortionSummary::singular_value_max);
  add("symmetric_dirichlet",
      "mean by rest area of |J|^2 + |J^-1|^2 over the region's triangles; 4 for an isometry",
      Direction::lower_is_better, 0, &DistortionSummary::symmetric_dirichlet);
}

void add_position_metrics(std::vector<MetricEntry>& table) {
  table.push_back(entry("rest_identity", "1",
                        "largest distance of a vertex from the input in the rest pose, over the "
                        "diagonal of the bounding box",
                        Direction::lower_is_better, {1e-9, 0}, rest_identity));
  const Tolerance ring{1e-9, 1e-6};
  table.push_back(entry(
      "mid_ring_min", "1",
      "smaller half axis of the tube's mid-ring (from its second moments about the joint), over "
      "the "
      "rest radius",
      Direction::closer_to_target, ring,
      [](const Measured& m) -> Value {
        const std::optional<RingRatio> ratio = mid_ring(m);
        return ratio ? Value(ratio->min) : std::nullopt;
      },
      1));
  table.push_back(entry(
      "mid_ring_max", "1",
      "larger half axis of the tube's mid-ring (from its second moments about the joint), over the "
      "rest radius",
      Direction::closer_to_target, ring,
      [](const Measured& m) -> Value {
        const std::optional<RingRatio> ratio = mid_ring(m);
        return ratio ? Value(ratio->max) : std::nullopt;
      },
      1));
  MetricEntry pops;
  pops.name = "second_difference_max";
  pops.unit = "m";
  pops.definition =
      "largest second difference of a vertex of the region over three successive frames of equal "
      "steps, in the frame of the joint of largest weight";
  pops.tolerance = {1e-9, 1e-6};
  pops.of_sequence = second_difference;
  table.push_back(std::move(pops));
}

void add_reference_metrics(std::vector<MetricEntry>& table) {
  table.push_back(reference_entry(
      "distance_to_reference_rms", "m",
      "root mean square distance of the region's vertices (all without a region) from those of the "
      "reference variant",
      {1e-9, 1e-6}, [](const Measured& m, const Measured& reference) -> Value {
        return reference_distance(m, reference).rms;
      }));
  table.push_back(reference_entry(
      "distance_to_reference_max", "m",
      "largest distance of a vertex of the region (any without a region) from that of the "
      "reference variant",
      {1e-9, 1e-6}, [](const Measured& m, const Measured& reference) -> Value {
        return reference_distance(m, reference).max;
      }));
}

}  // namespace

std::vector<MetricEntry> skinning_metrics() {
  const auto shared = std::make_shared<Shared>();
  std::vector<MetricEntry> table;
  add_volume_metrics(table, shared);
  add_contact_metrics(table, shared);
  add_section_metrics(table, shared);
  add_distortion_metrics(table, shared);
  add_position_metrics(table);
  add_reference_metrics(table);
  return table;
}

}  // namespace geoprior
