#include "experiments/skinning/measures.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>

#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "metrics/contact/pose_return.h"
#include "metrics/contact/self_contact.h"
#include "metrics/developability/bend_side.h"
#include "metrics/volume/volume.h"

namespace geoprior::skinning {
namespace {

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

ContentKey key_of(const TriMesh& mesh, const Eigen::MatrixX3d& posed) {
  ContentKey key;
  key.add_matrix(mesh.V);
  key.add_matrix(mesh.F);
  key.add_matrix(posed);
  return key;
}

void add_pose(ContentKey& key, const Pose& pose) {
  for (const Eigen::Affine3d& T : pose) key.add_matrix(T.matrix());
}

void add_region(ContentKey& key, const JointRegion& region) {
  for (const int t : region.triangles) key.add(static_cast<std::uint64_t>(t));
  for (const JointRegion::Hinge& h : region.hinges) {
    key.add(static_cast<std::uint64_t>(h.joint));
    key.add_matrix(h.bend_axis);
    key.add(std::bit_cast<std::uint64_t>(h.radius));
  }
  key.add(std::bit_cast<std::uint64_t>(region.extent));
}

/// Of what follows from the rig alone.
ContentKey key_of(const RiggedMesh& rig) {
  ContentKey key = key_of(rig.mesh, rig.mesh.V);
  key.add_matrix(Eigen::Map<const Eigen::VectorXd>(rig.weights.valuePtr(), rig.weights.nonZeros()));
  key.add_matrix(
      Eigen::Map<const Eigen::VectorXi>(rig.weights.innerIndexPtr(), rig.weights.nonZeros()));
  for (const Joint& joint : rig.skeleton.joints) {
    key.add(static_cast<std::uint64_t>(joint.parent));
    key.add_matrix(joint.head);
    if (joint.tail) key.add_matrix(*joint.tail);
  }
  return key;
}

bool is_closed(Shared& shared, const TriMesh& mesh) {
  ContentKey key;
  key.add_matrix(mesh.F);
  return shared.closed.get(key, [&] { return boundary_edges(mesh.F).empty(); });
}

/// The file's own skin: a cap meets it at an edge that nobody sees, and bends as its border does.
TriMesh without_caps(const SkinningScene& scene) {
  return {scene.rig.mesh.V, scene.rig.mesh.F.topRows(scene.skin_triangles())};
}

/// About the region's joints, or of the whole body (null); posed, at rest, and the difference.
std::optional<OverlapPair> overlap_pair(Shared& shared, const Measured& m,
                                        const JointRegion* region) {
  if (!is_closed(shared, m.mesh())) return std::nullopt;
  const auto study = [&](const Eigen::MatrixX3d& V, const Pose& pose) {
    ContentKey key = key_of(m.mesh(), V);
    if (region) add_pose(key, pose);
    if (region) add_region(key, *region);
    return shared.overlap.get(key, [&] {
      if (region) return region_overlap_study(V, m.mesh().F, *region, pose);
      return body_overlap_study(V, m.mesh().F, body_column_spacing(m.mesh().V));
    });
  };
  const OverlapStudy rest = study(m.mesh().V, rest_pose(m.scene.rig.skeleton.size()));
  const OverlapStudy posed = study(m.posed, m.pose);
  return OverlapPair{overlap_above_rest(posed, rest), posed.volume, rest.volume};
}

std::optional<OverlapStudy> excess(Shared& shared, const Measured& m, const JointRegion* region) {
  const std::optional<OverlapPair> pair = overlap_pair(shared, m, region);
  return pair ? std::optional(pair->above) : std::nullopt;
}

/// All pairs of triangles that intersect; remembered, because the rest pose and dual quaternions'
/// are asked for again.
std::shared_ptr<const TrianglePairList> pairs_of(Shared& shared, const TriMesh& mesh,
                                                 const Eigen::MatrixX3d& V) {
  return shared.pairs.get(key_of(mesh, V), [&] {
    return std::make_shared<const TrianglePairList>(intersecting_triangles(V, mesh.F));
  });
}

/// Dual quaternions' overlaps are bounded by, or cross in, these triangles.
std::vector<int> overlapping_triangles(Shared& shared, const TriMesh& mesh,
                                       const Eigen::MatrixX3d& V) {
  std::vector<int> triangles;
  if (is_closed(shared, mesh))
    triangles = triangles_about_overlap(V, mesh.F, body_column_spacing(mesh.V));
  for (const auto& [a, b] : *pairs_of(shared, mesh, V)) {
    triangles.push_back(a);
    triangles.push_back(b);
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

std::shared_ptr<const BoneRings> rings_of(Shared& shared, const RiggedMesh& rig) {
  return shared.rings.get(key_of(rig), [&] { return std::make_shared<const BoneRings>(rig); });
}

std::shared_ptr<const PlainPose> plain_pose(Shared& shared, const Measured& m) {
  ContentKey key = key_of(m.scene.rig);
  add_pose(key, m.pose);
  return shared.plain.get(key, [&] {
    auto plain = std::make_shared<PlainPose>();
    DualQuaternionBlend(m.scene.rig).deform(m.pose, plain->posed);
    plain->unasked =
        unasked_vertices(*rings_of(shared, m.scene.rig), m.mesh().F, plain->posed, m.pose,
                         overlapping_triangles(shared, m.mesh(), plain->posed));
    return plain;
  });
}

/// Vertices of all regions that `of_region` chooses; ascending.
template <class OfRegion>
std::vector<int> vertices_of_regions(const SkinningScene& scene, const OfRegion& of_region) {
  std::vector<int> vertices;
  for (const JointRegion& region : scene.regions) {
    const std::vector<int> own = of_region(region);
    vertices.insert(vertices.end(), own.begin(), own.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

double rest_union_volume(Shared& shared, const Measured& m) {
  return shared.union_volume.get(key_of(m.mesh(), m.mesh().V), [&] {
    return union_volume(m.mesh().V, m.mesh().F, body_column_spacing(m.mesh().V));
  });
}

/// Over the sum of the rest volumes of all regions, each closed by fans; absent where that is none.
Value over_regions(double change, const Measured& m) {
  double sum = 0;
  for (const JointRegion& region : m.scene.regions)
    sum += region_volume(m.mesh().V, m.mesh().F, region);
  return sum > 0 ? Value(change / sum) : std::nullopt;
}

}  // namespace

Measured measured(const SkinningScene& scene, const Frame& frame) {
  return {scene, surface_of(scene, frame), scene.pose_at(frame.parameter)};
}

Value volume_change(Shared& shared, const Measured& m) {
  if (!m.region()) return std::nullopt;
  if (is_closed(shared, m.mesh())) {
    const double change =
        signed_volume(m.posed, m.mesh().F) - signed_volume(m.mesh().V, m.mesh().F);
    return over_regions(change, m);
  }
  return relative_change(region_volume(m.mesh().V, m.mesh().F, *m.region()),
                         region_volume(m.posed, m.mesh().F, *m.region()));
}

Value volume_change_global(Shared& shared, const Measured& m) {
  if (!is_closed(shared, m.mesh())) return std::nullopt;
  return relative_change(signed_volume(m.mesh().V, m.mesh().F), signed_volume(m.posed, m.mesh().F));
}

Value volume_change_union(Shared& shared, const Measured& m) {
  if (!m.region()) return std::nullopt;
  const Value body = volume_change_union_body(shared, m);
  if (!body) return std::nullopt;
  return over_regions(*body * rest_union_volume(shared, m), m);
}

Value volume_change_union_body(Shared& shared, const Measured& m) {
  const std::optional<OverlapStudy> above = excess(shared, m, nullptr);
  if (!above) return std::nullopt;
  return union_volume_change(m.mesh().V, m.posed, m.mesh().F, *above, rest_union_volume(shared, m));
}

std::optional<OverlapPair> overlap_excess(Shared& shared, const Measured& m) {
  return overlap_pair(shared, m, m.region());
}

std::optional<OverlapPair> overlap_excess_body(Shared& shared, const Measured& m) {
  return overlap_pair(shared, m, nullptr);
}

std::optional<RegionOverlaps> overlap_of_regions(Shared& shared, const Measured& m) {
  const std::optional<OverlapStudy> body = excess(shared, m, nullptr);
  if (m.scene.regions.empty() || !body) return std::nullopt;
  RegionOverlaps overlaps;
  OverlapStudy outside = *body;
  for (const JointRegion& region : m.scene.regions) {
    const std::optional<OverlapStudy> study = excess(shared, m, &region);
    outside.volume -= study->volume;
    outside.noise_floor += study->noise_floor;
    overlaps.largest = std::max(overlaps.largest, study->above_floor());
    overlaps.sum += study->above_floor();
    overlaps.cut_area = std::max(overlaps.cut_area, study->cut_area);
  }
  overlaps.outside = outside.above_floor();
  return overlaps;
}

std::optional<OverlapRatios> overlap_excess_ratios(Shared& shared, const Measured& m,
                                                   const Measured& reference) {
  const auto ratio = [&](const JointRegion* region) -> Value {
    const std::optional<OverlapStudy> own = excess(shared, m, region);
    const std::optional<OverlapStudy> other = excess(shared, reference, region);
    if (!own || !other) return std::nullopt;
    return own->ratio_to(*other);
  };
  const Value body = ratio(nullptr);
  if (!body) return std::nullopt;
  return OverlapRatios{ratio(m.region()).value(), *body};
}

Pairs pairs(Shared& shared, const Measured& m) {
  const auto posed = pairs_of(shared, m.mesh(), m.posed);
  const auto rest = pairs_of(shared, m.mesh(), m.mesh().V);
  const auto in_region = [&](const TrianglePairList& all) {
    return m.region() ? pairs_in_region(all, *m.region()) : static_cast<int>(all.size());
  };
  return {in_region(*posed), in_region(*rest), static_cast<int>(posed->size()),
          static_cast<int>(rest->size())};
}

std::optional<RoughnessMeasures> roughness(Shared& shared, const Measured& m) {
  const TriMesh skin = without_caps(m.scene);
  const auto surface = shared.roughness.get(
      key_of(skin, skin.V), [&] { return std::make_shared<const Roughness>(skin); });
  const Eigen::VectorXd folds = surface->folds(m.posed);
  const Eigen::VectorXd lumps = surface->lumps(m.posed);
  const std::vector<int> all = vertices_of_regions(
      m.scene, [&](const JointRegion& region) { return region_vertices(region, m.mesh().F); });
  const std::vector<int> outer = vertices_of_regions(m.scene, [&](const JointRegion& region) {
    return outer_vertices(region, m.mesh().F, m.mesh().V, m.pose);
  });
  const auto whole = summarize(*surface, folds, lumps, all);
  if (!whole) return std::nullopt;
  RoughnessMeasures measures{*whole, std::nullopt};
  if (!outer.empty()) measures.outer = summarize(*surface, folds, lumps, outer);
  return measures;
}

std::optional<Harm> harm_of(Shared& shared, const Measured& m) {
  const auto plain = plain_pose(shared, m);
  return harm(*rings_of(shared, m.scene.rig), plain->unasked, m.posed, plain->posed);
}

std::optional<SectionSummary> section_summary(const Measured& m) {
  if (!m.region()) return std::nullopt;
  return summarize(cross_sections(*m.region(), m.mesh().F, m.mesh().V, m.posed, m.pose));
}

std::optional<DistortionSummary> region_distortion(const Measured& m) {
  if (!m.region()) return std::nullopt;
  std::vector<int> triangles = m.region()->triangles;
  std::erase_if(triangles, [&](int t) { return t >= m.scene.skin_triangles(); });
  return distortion(m.mesh().V, m.posed, m.mesh().F, triangles);
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

Pops pops(Shared& shared, const SkinningScene& scene, const FrameSequence& frames) {
  std::vector<Eigen::MatrixX3d> positions;
  std::vector<Pose> poses;
  const std::vector<double> parameters = frames.parameters();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::shared_ptr<const Frame> frame = frames.frame(i);
    const Measured m = measured(scene, *frame);
    positions.push_back(in_bone_frame(scene.rig.weights, m.pose, m.posed));
    poses.push_back(m.pose);
  }
  Pops pops;
  pops.pose_return = pose_return(positions, poses, rings_of(shared, scene.rig)->radii());
  if (scene.parameter_unit_label == "deg") pops.motion = motion_smoothness(positions, parameters);
  if (frames.size() < 3 || !equally_spaced(parameters) || scene.regions.empty()) return pops;
  pops.second_difference = second_difference_max(
      positions, parameters, region_vertices(scene.regions.front(), scene.rig.mesh.F));
  return pops;
}

}  // namespace geoprior::skinning
