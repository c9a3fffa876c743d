#include "metrics/contact/bone_rings.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr double kSliceShare = 1.0 / 3;  // length of a slice over the radius of the bone's skin
constexpr int kEnoughVertices = 6;       // of a ring

/// Squared distance from the line through the origin along the direction.
double squared_distance_from_axis(const Eigen::Vector3d& x, const Eigen::Vector3d& direction) {
  return (x - x.dot(direction) * direction).squaredNorm();
}

/// Quarter about the direction that x lies in.
int quarter(const Eigen::Vector3d& x, const Eigen::Vector3d& direction) {
  Eigen::Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d u = direction.cross(Eigen::Vector3d::Unit(least));
  return (x.dot(u) > 0 ? 1 : 0) + (x.dot(direction.cross(u)) > 0 ? 2 : 0);
}

int strongest_joint(const SkinWeights& weights, int v) {
  int strongest = -1;
  double largest = 0;
  for (SkinWeights::InnerIterator it(weights, v); it; ++it) {
    if (it.value() <= largest) continue;
    largest = it.value();
    strongest = static_cast<int>(it.col());
  }
  return strongest;
}

}  // namespace

BoneRings::BoneRings(const RiggedMesh& rig)
    : ring_of_(rig.mesh.vertex_count(), -1),
      quarter_of_(rig.mesh.vertex_count(), 0),
      vertex_area_(Eigen::VectorXd::Zero(rig.mesh.vertex_count())) {
  const Eigen::VectorXd areas = triangle_areas(rig.mesh.V, rig.mesh.F);
  for (Eigen::Index t = 0; t < rig.mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) vertex_area_(rig.mesh.F(t, k)) += areas(t) / 3;
  }
  make_axes(rig.skeleton);
  make_rings(rig);
}

void BoneRings::make_axes(const Skeleton& skeleton) {
  const std::vector<std::vector<int>> children = skeleton.children();
  for (int j = 0; j < skeleton.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    Eigen::Vector3d end = Eigen::Vector3d::Zero();
    for (const int child : children[j]) {
      end += skeleton.joints[child].head / static_cast<double>(children[j].size());
    }
    if (children[j].empty() && joint.parent >= 0) {
      end = 2 * joint.head - skeleton.joints[joint.parent].head;
    } else if (children[j].empty()) {
      end = joint.head;
    }
    const Eigen::Vector3d bone = joint.tail.value_or(end) - joint.head;
    const bool has_bone = bone.norm() > 1e-9;
    axes_.push_back(
        {joint.head, has_bone ? Eigen::Vector3d(bone.normalized()) : Eigen::Vector3d::Zero()});
  }
}

void BoneRings::make_rings(const RiggedMesh& rig) {
  const int n = rig.mesh.vertex_count();
  std::vector<int> joint_of(n);
  std::vector<double> joint_area(axes_.size(), 0.0), joint_moment(axes_.size(), 0.0);
  const auto from_head = [&](int v) -> Eigen::Vector3d {
    return rig.mesh.V.row(v).transpose() - axes_[joint_of[v]].origin;
  };
  for (int v = 0; v < n; ++v) {
    joint_of[v] = strongest_joint(rig.weights, v);
    const Eigen::Vector3d& direction = axes_[joint_of[v]].direction;
    joint_area[joint_of[v]] += vertex_area_(v);
    joint_moment[joint_of[v]] +=
        vertex_area_(v) * squared_distance_from_axis(from_head(v), direction);
  }
  std::map<std::pair<int, long>, int> ring_at;
  for (int v = 0; v < n; ++v) {
    const int j = joint_of[v];
    const double radius = std::sqrt(joint_moment[j] / joint_area[j]);
    if (axes_[j].direction.isZero(0) || !(radius > 0)) continue;
    const Eigen::Vector3d x = from_head(v);
    const long slice = std::lround(x.dot(axes_[j].direction) / (kSliceShare * radius));
    const auto [it, is_new] = ring_at.emplace(std::pair{j, slice}, static_cast<int>(rings_.size()));
    if (is_new) rings_.push_back({j, 0, {}, {}});
    ring_of_[v] = it->second;
    quarter_of_[v] = quarter(x, axes_[j].direction);
    Ring& ring = rings_[it->second];
    ++ring.vertices;
    const double moment = vertex_area_(v) * squared_distance_from_axis(x, axes_[j].direction);
    for (Sector* sector : {&ring.whole, &ring.quarters[quarter_of_[v]]}) {
      sector->area += vertex_area_(v);
      sector->moment += moment;
    }
  }
}

std::optional<double> BoneRings::radius(int vertex) const {
  if (ring_of_[vertex] < 0) return std::nullopt;
  const Ring& ring = rings_[ring_of_[vertex]];
  if (ring.vertices < kEnoughVertices || !(ring.whole.moment > 0)) return std::nullopt;
  return std::sqrt(ring.whole.moment / ring.whole.area);
}

Eigen::VectorXd BoneRings::radii() const {
  Eigen::VectorXd all(vertex_count());
  for (int v = 0; v < vertex_count(); ++v)
    all(v) = radius(v).value_or(std::numeric_limits<double>::quiet_NaN());
  return all;
}

Eigen::VectorXd BoneRings::section_ratios(const Eigen::MatrixX3d& posed, const Pose& pose) const {
  if (posed.rows() != std::ssize(ring_of_)) {
    throw Error(std::to_string(posed.rows()) + " posed vertices", "rings of skin",
                std::to_string(ring_of_.size()) + ", as at rest");
  }
  std::vector<std::array<double, kQuarters>> moments(rings_.size(), {0, 0, 0, 0});
  for (int v = 0; v < vertex_count(); ++v) {
    if (ring_of_[v] < 0) continue;
    const int j = rings_[ring_of_[v]].joint;
    const Eigen::Vector3d x = posed.row(v).transpose() - pose[j] * axes_[j].origin;
    const Eigen::Vector3d direction = (pose[j].linear() * axes_[j].direction).normalized();
    moments[ring_of_[v]][quarter_of_[v]] +=
        vertex_area_(v) * squared_distance_from_axis(x, direction);
  }
  Eigen::VectorXd ratios(posed.rows());
  for (int v = 0; v < vertex_count(); ++v) {
    ratios(v) = std::numeric_limits<double>::quiet_NaN();
    if (radius(v)) ratios(v) = most_changed(rings_[ring_of_[v]], moments[ring_of_[v]]);
  }
  return ratios;
}

double BoneRings::most_changed(const Ring& ring, const std::array<double, kQuarters>& moments) {
  double most = std::accumulate(moments.begin(), moments.end(), 0.0) / ring.whole.moment;
  for (int q = 0; q < kQuarters; ++q) {
    if (!(ring.quarters[q].moment > 0)) continue;
    const double ratio = moments[q] / ring.quarters[q].moment;
    if (std::abs(ratio - 1) > std::abs(most - 1)) most = ratio;
  }
  return most;
}

}  // namespace geoprior
