#include "solvers/skinning/field/sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "solvers/skinning/field/caps.h"

namespace geoprior::skinning {
namespace {

constexpr int kCandidatesPerSample = 40;

struct Candidate {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};

std::vector<int> bone_triangles(const TriMesh& mesh, const std::vector<int>& bone_of_vertex,
                                int bone) {
  std::vector<int> triangles;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
      inside = inside && bone_of_vertex[mesh.F(t, k)] == bone;
    }
    if (inside) triangles.push_back(static_cast<int>(t));
  }
  return triangles;
}

/// Uniform by area over the triangles; normals interpolated from the vertices.
std::vector<Candidate> spread(const TriMesh& mesh, const Eigen::MatrixX3d& normals,
                              const std::vector<int>& triangles, int count, RandomStream& random) {
  std::vector<double> cumulative;
  double total = 0;
  for (const int t : triangles) {
    const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::Vector3d ab = mesh.V.row(mesh.F(t, 1)).transpose() - a;
    const Eigen::Vector3d ac = mesh.V.row(mesh.F(t, 2)).transpose() - a;
    total += 0.5 * ab.cross(ac).norm();
    cumulative.push_back(total);
  }
  std::vector<Candidate> candidates;
  if (!(total > 0)) return candidates;
  for (int i = 0; i < count; ++i) {
    const auto hit =
        std::upper_bound(cumulative.begin(), cumulative.end(), random.uniform() * total);
    const auto index =
        std::min(static_cast<std::size_t>(hit - cumulative.begin()), triangles.size() - 1);
    const int t = triangles[index];
    double u = random.uniform(), w = random.uniform();
    if (u + w > 1) {
      u = 1 - u;
      w = 1 - w;
    }
    const auto mix = [&](const Eigen::MatrixX3d& rows) -> Eigen::Vector3d {
      return ((1 - u - w) * rows.row(mesh.F(t, 0)) + u * rows.row(mesh.F(t, 1)) +
              w * rows.row(mesh.F(t, 2)))
          .transpose();
    };
    const Eigen::Vector3d normal = mix(normals);
    if (normal.norm() > 1e-9) candidates.push_back({mix(mesh.V), normal.normalized()});
  }
  return candidates;
}

bool near_a_joint(const FieldBone& bone, const SamplingOptions& options, const Eigen::Vector3d& p) {
  const Eigen::Vector3d axis = bone.tail - bone.head;
  if (!(axis.squaredNorm() > 0)) return false;
  const double h = (p - bone.head).dot(axis) / axis.squaredNorm();
  return (bone.parent >= 0 && h < options.trim_head) ||
         (bone.has_children && h > 1 - options.trim_tail);
}

bool folds_back(const FieldBone& bone, const SamplingOptions& options, const Candidate& c) {
  const Eigen::Vector3d nearest =
      bone.head + segment_parameter(c.point, bone.head, bone.tail) * (bone.tail - bone.head);
  return (c.point - nearest).dot(c.normal) < options.fold * bone.radius;
}

std::vector<Candidate> usable(const std::vector<Candidate>& all, const FieldBone& bone,
                              const SamplingOptions& options) {
  std::vector<Candidate> unfolded, trimmed;
  for (const Candidate& c : all) {
    if (folds_back(bone, options, c)) continue;
    unfolded.push_back(c);
    if (!near_a_joint(bone, options, c.point)) trimmed.push_back(c);
  }
  if (3 * trimmed.size() >= all.size()) return trimmed;
  return unfolded.empty() ? all : unfolded;
}

/// Candidates, in order, that keep `distance` from all kept before.
std::vector<std::size_t> throw_darts(const std::vector<Candidate>& candidates, double distance,
                                     std::size_t limit) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < candidates.size() && kept.size() <= limit; ++i) {
    const bool is_free = std::all_of(kept.begin(), kept.end(), [&](std::size_t k) {
      return (candidates[k].point - candidates[i].point).squaredNorm() >= distance * distance;
    });
    if (is_free) kept.push_back(i);
  }
  return kept;
}

/// The largest spacing that still leaves `count` samples.
std::vector<std::size_t> poisson_disk(const std::vector<Candidate>& candidates, std::size_t count,
                                      double size) {
  double low = 1e-4 * size, high = size;
  std::vector<std::size_t> best = throw_darts(candidates, low, count);
  for (int i = 0; i < 24; ++i) {
    const double middle = 0.5 * (low + high);
    std::vector<std::size_t> kept = throw_darts(candidates, middle, count);
    if (kept.size() >= count) {
      low = middle;
      best = std::move(kept);
    } else {
      high = middle;
    }
  }
  if (best.size() > count) best.resize(count);
  return best;
}

double nearest_distance(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& joint) {
  double nearest = std::numeric_limits<double>::max();
  for (const Eigen::Vector3d& p : points) nearest = std::min(nearest, (p - joint).norm());
  return nearest;
}

std::vector<Eigen::Vector3d> skin_of(const TriMesh& mesh, const FieldBone& bone) {
  std::vector<Eigen::Vector3d> skin;
  for (const int v : bone.vertices) skin.emplace_back(mesh.V.row(v));
  return skin;
}

/// Closes a field at one joint: at its own head against its parent, or at the head of a child. The
/// skin of the bone beyond (`child`, or the bone itself) says how thick the joint is.
CapSamples close_joint(const TriMesh& mesh, const FieldBone& child, const FieldBone& other,
                       const BoneEnd& end, const SamplingOptions& options) {
  std::vector<Eigen::Vector3d> skin = skin_of(mesh, child);
  if (skin.empty()) return {};
  const double pole = options.cap_scale * nearest_distance(skin, end.joint);
  if (options.caps == CapKind::point) return point_cap(end, pole);
  const std::vector<Eigen::Vector3d> beyond = skin_of(mesh, other);
  skin.insert(skin.end(), beyond.begin(), beyond.end());
  return dome_cap(end, skin, pole);
}

/// Caps of a bone at every joint that it shares with another bone: a hand has one for each finger.
CapSamples close_ends(const TriMesh& mesh, const BonePartition& partition, int bone_index,
                      const SamplingOptions& options) {
  CapSamples caps;
  if (options.caps == CapKind::none) return caps;
  const auto close = [&](int child_index, int other_index, double direction) {
    const FieldBone& child = partition.bones[child_index];
    const FieldBone& other = partition.bones[other_index];
    const Eigen::Vector3d axis = child.tail - child.head;
    if (!(axis.norm() > 0)) return;
    const CapSamples cap =
        close_joint(mesh, child, other, {child.head, direction * axis.normalized()}, options);
    caps.points.insert(caps.points.end(), cap.points.begin(), cap.points.end());
    caps.normals.insert(caps.normals.end(), cap.normals.begin(), cap.normals.end());
  };
  const int parent = partition.bones[bone_index].parent;
  if (parent >= 0) close(bone_index, parent, -1);
  for (int b = 0; b < std::ssize(partition.bones); ++b) {
    if (partition.bones[b].parent == bone_index) close(b, bone_index, 1);
  }
  return caps;
}

}  // namespace

BoneSamples sample_bone(const TriMesh& mesh, const Eigen::MatrixX3d& normals,
                        const BonePartition& partition, int bone_index,
                        const SamplingOptions& options, RandomStream random) {
  const FieldBone& bone = partition.bones[bone_index];
  const std::vector<int> triangles = bone_triangles(mesh, partition.bone_of_vertex, bone_index);
  std::vector<Candidate> candidates =
      spread(mesh, normals, triangles, options.samples * kCandidatesPerSample, random);
  if (candidates.empty()) {
    for (const int v : bone.vertices) candidates.push_back({mesh.V.row(v), normals.row(v)});
  }
  candidates = usable(candidates, bone, options);
  const std::vector<std::size_t> chosen =
      poisson_disk(candidates, options.samples, bounding_box_diagonal(mesh.V));

  std::vector<Eigen::Vector3d> points, normals_of_points;
  for (const std::size_t i : chosen) {
    points.push_back(candidates[i].point);
    normals_of_points.push_back(candidates[i].normal);
  }
  const CapSamples caps = close_ends(mesh, partition, bone_index, options);
  points.insert(points.end(), caps.points.begin(), caps.points.end());
  normals_of_points.insert(normals_of_points.end(), caps.normals.begin(), caps.normals.end());

  BoneSamples samples;
  samples.cap_count = static_cast<int>(caps.points.size());
  samples.points.resize(points.size(), 3);
  samples.normals.resize(samples.points.rows(), 3);
  for (Eigen::Index i = 0; i < samples.points.rows(); ++i) {
    samples.points.row(i) = points[i].transpose();
    samples.normals.row(i) = normals_of_points[i].transpose();
  }
  return samples;
}

}  // namespace geoprior::skinning
