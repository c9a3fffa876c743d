#include "experiments/skinning/measures.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>

#include "core/error.h"
#include "core/topology.h"
#include "metrics/self_contact.h"
#include "metrics/smoothness.h"
#include "metrics/volume.h"

namespace geoprior::skinning {
namespace {

constexpr double kGlobalSpacings = 768;  // columns along the diagonal of a whole body
constexpr double kGlobalDepth = 48;      // detection depth of a whole body, in column spacings
constexpr double kIdentityPose = 1e-12;  // entry of a transform that still is the rest pose

const Eigen::MatrixX3d& surface_of(const SkinningScene& scene, const Frame& frame) {
  const Eigen::MatrixX3d& points = frame.require_part("surface").points;
  if (points.rows() != scene.rig.mesh.V.rows()) {
    throw Error(std::to_string(points.rows()) + " vertices in part 'surface'",
                "frame at " + std::to_string(frame.parameter),
                std::to_string(scene.rig.mesh.V.rows()) + ", as in the scene");
  }
  return points;
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

bool is_closed(Shared& shared, const TriMesh& mesh) {
  ContentKey key;
  key.add_matrix(mesh.F);
  return shared.closed.get(key, [&] { return boundary_edges(mesh.F).empty(); });
}

OverlapStudy compute_overlap(const Measured& m, const Eigen::MatrixX3d& V, const Pose& pose) {
  if (const JointRegion* region = m.region()) {
    const double spacing = region_column_spacing(*region);
    return overlap_study(V, m.mesh().F, joint_box(*region, pose), spacing,
                         smallest_radius(*region));
  }
  Eigen::AlignedBox3d box;
  for (Eigen::Index v = 0; v < V.rows(); ++v) box.extend(V.row(v).transpose());
  const double spacing = bounding_box_diagonal(m.mesh().V) / kGlobalSpacings;
  return overlap_study(V, m.mesh().F, box, spacing, kGlobalDepth * spacing);
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
    local.row(v) = (back[dominant] * x).transpose();
  }
  return local;
}

}  // namespace

Measured measured(const SkinningScene& scene, const Frame& frame) {
  return {scene, surface_of(scene, frame), scene.pose_at(frame.parameter)};
}

Value volume_change(const Measured& m) {
  if (!m.region()) return std::nullopt;
  return relative_change(region_volume(m.mesh().V, m.mesh().F, *m.region()),
                         region_volume(m.posed, m.mesh().F, *m.region()));
}

Value volume_change_global(Shared& shared, const Measured& m) {
  if (!is_closed(shared, m.mesh())) return std::nullopt;
  return relative_change(signed_volume(m.mesh().V, m.mesh().F), signed_volume(m.posed, m.mesh().F));
}

std::optional<OverlapStudy> overlap_excess(Shared& shared, const Measured& m) {
  const Pose at_rest = rest_pose(m.scene.rig.skeleton.size());
  const auto study = [&](const Eigen::MatrixX3d& V, const Pose& pose) {
    return shared.overlap.get(key_of(m, V, pose), [&] { return compute_overlap(m, V, pose); });
  };
  if (!is_closed(shared, m.mesh())) return std::nullopt;
  const OverlapStudy rest = study(m.mesh().V, at_rest);
  OverlapStudy excess = study(m.posed, m.pose);
  excess.volume -= rest.volume;
  excess.noise_floor += rest.noise_floor;  // errors of a difference add up at worst
  return excess;
}

double clipped(const OverlapStudy& study) {
  return study.volume > study.noise_floor ? study.volume : 0.0;
}

Value overlap_excess_ratio(Shared& shared, const Measured& m, const Measured& reference) {
  const std::optional<OverlapStudy> own = overlap_excess(shared, m);
  const std::optional<OverlapStudy> other = overlap_excess(shared, reference);
  if (!own || !other) return std::nullopt;
  const double floor = std::max(own->noise_floor, other->noise_floor);
  if (own->volume <= floor) return 0.0;
  return own->volume / std::max(other->volume, floor);
}

double pairs_excess(Shared& shared, const Measured& m) {
  const auto count = [&](const Eigen::MatrixX3d& V) {
    return m.region() ? intersecting_pairs(V, m.mesh().F, *m.region())
                      : intersecting_pairs(V, m.mesh().F);
  };
  const int at_rest =
      shared.pairs_at_rest.get(key_of(m, m.mesh().V, {}), [&] { return count(m.mesh().V); });
  return count(m.posed) - at_rest;
}

std::optional<SectionSummary> section_summary(const Measured& m) {
  if (!m.region()) return std::nullopt;
  return summarize(cross_sections(*m.region(), m.mesh().F, m.mesh().V, m.posed, m.pose));
}

std::optional<DistortionSummary> region_distortion(const Measured& m) {
  if (!m.region()) return std::nullopt;
  return distortion(m.mesh().V, m.posed, m.mesh().F, m.region()->triangles);
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
  return ring_radius_ratio(m.mesh().V, hinge.head, m.posed, m.pose[hinge.joint] * hinge.head, ring);
}

VertexDistance reference_distance(const Measured& m, const Measured& reference) {
  const std::vector<int> vertices =
      m.region() ? region_vertices(*m.region(), m.mesh().F) : std::vector<int>{};
  return vertex_distance(m.posed, reference.posed, vertices);
}

Value second_difference(const SkinningScene& scene, const FrameSequence& frames) {
  std::vector<Eigen::MatrixX3d> positions;
  const std::vector<double> parameters = frames.parameters();
  if (frames.size() < 3 || !equally_spaced(parameters) || scene.regions.empty())
    return std::nullopt;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    positions.push_back(in_bone_frame(measured(scene, *frames.frame(i))));
  }
  return second_difference_max(positions, parameters,
                               region_vertices(scene.regions.front(), scene.rig.mesh.F));
}

}  // namespace geoprior::skinning
