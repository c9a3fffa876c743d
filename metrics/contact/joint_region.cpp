#include "metrics/contact/joint_region.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/inputs/rig.h"
#include "metrics/tracks/of_values.h"

namespace geoprior {
namespace {

constexpr double kRadialLimit = 2.5;   // skin farther from the bones, in radii, is no part of it
constexpr double kHeldByBoth = 0.1;    // weights of both bones in the blended skin
constexpr double kRigidEnough = 0.95;  // skin that one rigid part holds so far is not blended
constexpr int kEnoughBlended = 8;      // vertices that give a median
constexpr double kIslandShare = 0.05;  // of the region's area

Eigen::Vector3d row(const Eigen::MatrixX3d& V, int v) { return V.row(v).transpose(); }

Eigen::Vector3d bisector(const JointRegion::Hinge& h) {
  const Eigen::Vector3d m = h.distal - h.proximal;
  return m.norm() > 1e-9 ? m.normalized() : h.distal;
}

/// Distance of a rest point from the half line of the bone on its side of the joint.
double bone_distance(const JointRegion::Hinge& h, const Eigen::Vector3d& x) {
  const Eigen::Vector3d r = x - h.head;
  const Eigen::Vector3d& bone = r.dot(bisector(h)) >= 0 ? h.distal : h.proximal;
  return (r - std::max(r.dot(bone), 0.0) * bone).norm();
}

double distance_to_segment(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                           const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp((x - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (x - a - t * d).norm();
}

/// Direction and length of the bone of a joint; by its tail, else by the mean of its children.
std::optional<Eigen::Vector3d> bone_vector(const Skeleton& skeleton, int joint) {
  const Joint& j = skeleton.joints[joint];
  if (j.tail) return *j.tail - j.head;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Joint& child : skeleton.joints) {
    if (child.parent != joint) continue;
    sum += child.head - j.head;
    ++count;
  }
  if (count == 0 || sum.norm() < 1e-12) return std::nullopt;
  return sum / count;
}

JointRegion::Hinge bones_of_joint(const Skeleton& skeleton, int joint,
                                  const Eigen::Vector3d& bend_axis) {
  if (joint < 0 || joint >= skeleton.size()) {
    throw Error("joint index " + std::to_string(joint) + " does not exist", "joint region",
                "0 to " + std::to_string(skeleton.size() - 1));
  }
  const Joint& j = skeleton.joints[joint];
  if (j.parent < 0) {
    throw Error("the joint has no parent to turn against", "joint '" + j.name + "'",
                "joints below the root");
  }
  JointRegion::Hinge hinge;
  hinge.joint = joint;
  hinge.proximal_joint = j.parent;
  hinge.head = j.head;
  const Eigen::Vector3d back = skeleton.joints[j.parent].head - j.head;
  const Eigen::Vector3d along = bone_vector(skeleton, joint).value_or(-back);
  if (back.norm() < 1e-12 && along.norm() < 1e-12) {
    throw Error("neither the joint nor its parent has a bone", "joint '" + j.name + "'",
                "a tail, a child or a parent at another place");
  }
  hinge.proximal = back.norm() < 1e-12 ? Eigen::Vector3d(-along.normalized()) : back.normalized();
  hinge.distal = along.norm() < 1e-12 ? Eigen::Vector3d(-hinge.proximal) : along.normalized();
  hinge.proximal_reach = back.norm();
  hinge.distal_reach = along.norm();
  if (bend_axis.norm() > 0) hinge.bend_axis = bend_axis.normalized();
  return hinge;
}

double local_radius(const RiggedMesh& rig, const JointRegion::Hinge& hinge) {
  std::vector<double> blended;
  std::vector<double> near;
  double nearest = std::numeric_limits<double>::infinity();
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    nearest = std::min(nearest, (row(rig.mesh.V, v) - hinge.head).norm());
  }
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const Eigen::Vector3d x = row(rig.mesh.V, v);
    const double distance = bone_distance(hinge, x);
    if (std::min(rig.weights.coeff(v, hinge.joint), rig.weights.coeff(v, hinge.proximal_joint)) >=
        kHeldByBoth)
      blended.push_back(distance);
    if ((x - hinge.head).norm() <= 3 * nearest) near.push_back(distance);
  }
  const bool enough = blended.size() >= static_cast<std::size_t>(kEnoughBlended);
  const double radius =
      percentile_of(enough ? std::move(blended) : std::move(near), 50).value_or(0);
  if (radius <= 0) {
    throw NoSkinAboutJoint("the joint has no skin around it",
                           "joint '" + rig.skeleton.joints[hinge.joint].name + "'",
                           "a joint inside the mesh");
  }
  return radius;
}

/// How far the region goes along the bones of a hinge.
struct Band {
  double proximal;
  double distal;
};

bool holds_joint(const std::vector<int>& joints, int joint) {
  return std::find(joints.begin(), joints.end(), joint) != joints.end();
}

/// Sets the reaches of the sections (half a bone between two hinges) and returns the band of the
/// region (the whole bone between two hinges). On entry the reaches hold the bones' lengths.
Band limit_reach(JointRegion::Hinge& hinge, const Skeleton& skeleton,
                 const std::vector<int>& joints, double extent) {
  const double full = extent * hinge.radius;
  bool child_turns = false;
  for (const int j : joints) {
    child_turns |= skeleton.joints[j].parent == hinge.joint;
  }
  const bool parent_turns = holds_joint(joints, hinge.proximal_joint);
  const Band band{parent_turns ? hinge.proximal_reach : full,
                  child_turns ? hinge.distal_reach : full};
  hinge.proximal_reach = std::min(full, (parent_turns ? 0.5 : 1.0) * hinge.proximal_reach);
  hinge.distal_reach = std::min(full, (child_turns ? 0.5 : 0.9) * hinge.distal_reach);
  return band;
}

bool in_band(const JointRegion::Hinge& hinge, const Band& band, const Eigen::Vector3d& x) {
  const double s = chain_coordinate(hinge, x);
  return s <= band.distal && -s <= band.proximal;
}

/// Joints of sibling limbs (the next finger, the other leg): below a parent of a hinge, but not
/// below the hinge. A helper joint that lies on the parent's bone (twist joints) is the limb's own.
std::vector<bool> sibling_joints(const Skeleton& skeleton, const JointRegion& region) {
  std::vector<bool> sibling(skeleton.size(), false);
  for (int j = 0; j < skeleton.size(); ++j) {
    const Joint& joint = skeleton.joints[j];
    if (joint.parent >= 0 && sibling[joint.parent]) {
      sibling[j] = true;
      continue;
    }
    bool turns = false;
    bool beside = false;
    for (const JointRegion::Hinge& h : region.hinges) {
      turns |= h.joint == j;
      if (joint.parent != h.proximal_joint) continue;
      const Eigen::Vector3d& near = skeleton.joints[h.proximal_joint].head;
      beside |= distance_to_segment(joint.head, near, h.head) > h.radius;
    }
    sibling[j] = beside && !turns;
  }
  return sibling;
}

/// Joints that no hinge separates move as one: the hinge's joint, or root, that leads each.
std::vector<int> rigid_groups(const Skeleton& skeleton, const JointRegion& region) {
  std::vector<int> group(skeleton.size());
  for (int j = 0; j < skeleton.size(); ++j) {
    const int parent = skeleton.joints[j].parent;
    const bool turns = std::any_of(region.hinges.begin(), region.hinges.end(),
                                   [&](const JointRegion::Hinge& h) { return h.joint == j; });
    const bool leads = turns || parent < 0;
    group[j] = leads ? j : group[parent];
  }
  return group;
}

/// Largest sum of weights of joints that move as one: 1 for skin that moves rigidly.
double rigidity(const SkinWeights& weights, int v, const std::vector<int>& group) {
  std::map<int, double> sum;
  for (SkinWeights::InnerIterator it(weights, v); it; ++it) {
    sum[group[it.col()]] += it.value();
  }
  double largest = 0;
  for (const auto& [joint, weight] : sum) largest = std::max(largest, weight);
  return largest;
}

/// What a vertex may contribute to the region.
struct VertexRole {
  bool own = false;   ///< near the bones, and blended or not held by a sibling limb
  bool near = false;  ///< within the band of a hinge, or blended within twice the band
};

std::vector<VertexRole> vertex_roles(const RiggedMesh& rig, const JointRegion& region,
                                     const std::vector<Band>& bands) {
  const std::vector<bool> sibling = sibling_joints(rig.skeleton, region);
  const std::vector<int> group = rigid_groups(rig.skeleton, region);
  std::vector<VertexRole> roles(rig.mesh.vertex_count());
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    double foreign = 0;
    for (SkinWeights::InnerIterator it(rig.weights, v); it; ++it) {
      if (sibling[it.col()]) foreign += it.value();
    }
    const bool blended = rigidity(rig.weights, v, group) < kRigidEnough;
    VertexRole& role = roles[v];
    const Eigen::Vector3d x = row(rig.mesh.V, v);
    for (std::size_t h = 0; h < region.hinges.size(); ++h) {
      const JointRegion::Hinge& hinge = region.hinges[h];
      const Band wide{2 * bands[h].proximal, 2 * bands[h].distal};
      const bool close = bone_distance(hinge, x) <= kRadialLimit * hinge.radius;
      role.own |= close && (blended || foreign <= 0.5);
      role.near |= close && in_band(hinge, blended ? wide : bands[h], x);
    }
  }
  return roles;
}

/// Triangle across each edge of each triangle; -1 at a border.
using Neighbours = std::vector<std::array<int, 3>>;

/// Marks, from the triangles in `stack` on, every triangle that `enter` allows; returns them.
template <class Enter>
std::vector<int> flood(const Neighbours& neighbours, std::vector<int> stack,
                       std::vector<bool>& seen, const Enter& enter) {
  std::vector<int> found;
  for (const int t : stack) seen[t] = true;
  while (!stack.empty()) {
    const int t = stack.back();
    stack.pop_back();
    found.push_back(t);
    for (const int n : neighbours[t]) {
      if (n < 0 || seen[n] || !enter(n)) continue;
      seen[n] = true;
      stack.push_back(n);
    }
  }
  return found;
}

/// The triangle next to each joint, where the flood fill starts.
std::vector<int> seeds(const RiggedMesh& rig, const JointRegion& region,
                       const std::vector<bool>& candidate) {
  std::vector<int> found;
  for (const JointRegion::Hinge& hinge : region.hinges) {
    int best = -1;
    double best_distance = std::numeric_limits<double>::infinity();
    for (int t = 0; t < rig.mesh.triangle_count(); ++t) {
      if (!candidate[t]) continue;
      const Eigen::Vector3d centre =
          (row(rig.mesh.V, rig.mesh.F(t, 0)) + row(rig.mesh.V, rig.mesh.F(t, 1)) +
           row(rig.mesh.V, rig.mesh.F(t, 2))) /
          3;
      const double distance = (centre - hinge.head).norm();
      if (distance >= best_distance) continue;
      best_distance = distance;
      best = t;
    }
    if (best < 0) {
      throw NoSkinAboutJoint("no skin of its own lies near the joint",
                             "joint '" + rig.skeleton.joints[hinge.joint].name + "'",
                             "a joint inside the mesh, with weights");
    }
    if (!holds_joint(found, best)) found.push_back(best);
  }
  return found;
}

/// Takes in the small patches that the region encloses.
void absorb_islands(const TriMesh& mesh, const Neighbours& neighbours,
                    std::vector<bool>& in_region) {
  const Eigen::VectorXd area = triangle_areas(mesh.V, mesh.F);
  double region_area = 0;
  for (std::size_t t = 0; t < in_region.size(); ++t) {
    if (in_region[t]) region_area += area(t);
  }
  std::vector<bool> seen = in_region;
  const std::vector<bool> region = in_region;
  for (std::size_t t = 0; t < region.size(); ++t) {
    if (!region[t]) continue;
    for (const int n : neighbours[t]) {
      if (n < 0 || seen[n]) continue;
      const std::vector<int> patch = flood(neighbours, {n}, seen, [](int) { return true; });
      double patch_area = 0;
      for (const int p : patch) patch_area += area(p);
      if (patch_area > kIslandShare * region_area) continue;
      for (const int p : patch) in_region[p] = true;
    }
  }
}

/// Closed loops of the region's boundary edges, each without repeated vertices.
std::vector<std::vector<int>> trace_loops(const Eigen::MatrixX3i& F, const Neighbours& neighbours,
                                          const std::vector<bool>& in_region) {
  std::multimap<int, int> next;
  for (std::size_t t = 0; t < in_region.size(); ++t) {
    if (!in_region[t]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const int n = neighbours[t][k];
      if (n >= 0 && in_region[n]) continue;
      next.emplace(F(t, k), F(t, (k + 1) % 3));
    }
  }
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int> path{next.begin()->first};
    while (true) {
      const auto edge = next.find(path.back());
      if (edge == next.end()) break;
      const int v = edge->second;
      next.erase(edge);
      const auto repeated = std::find(path.begin(), path.end(), v);
      if (repeated == path.end()) {
        path.push_back(v);
        continue;
      }
      loops.emplace_back(repeated, path.end());
      path.erase(repeated + 1, path.end());
    }
  }
  return loops;
}

}  // namespace

double chain_coordinate(const JointRegion::Hinge& hinge, const Eigen::Vector3d& rest_point) {
  const Eigen::Vector3d r = rest_point - hinge.head;
  return r.dot(bisector(hinge)) >= 0 ? r.dot(hinge.distal) : -r.dot(hinge.proximal);
}

JointRegion make_joint_region(const RiggedMesh& rig, const std::string& name,
                              const std::vector<int>& joints,
                              const std::vector<Eigen::Vector3d>& bend_axes, double extent) {
  if (joints.empty() || joints.size() != bend_axes.size()) {
    throw Error(std::to_string(joints.size()) + " joints and " + std::to_string(bend_axes.size()) +
                    " bend axes",
                "joint region '" + name + "'", "at least one joint, one axis each");
  }
  JointRegion region;
  region.name = name;
  region.extent = extent;
  std::vector<Band> bands;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    JointRegion::Hinge hinge = bones_of_joint(rig.skeleton, joints[i], bend_axes[i]);
    hinge.radius = local_radius(rig, hinge);
    bands.push_back(limit_reach(hinge, rig.skeleton, joints, extent));
    region.hinges.push_back(hinge);
  }
  const std::vector<VertexRole> roles = vertex_roles(rig, region, bands);
  std::vector<bool> candidate(rig.mesh.triangle_count());
  for (int t = 0; t < rig.mesh.triangle_count(); ++t) {
    bool own = true;
    bool near = false;
    for (int k = 0; k < 3; ++k) {
      const VertexRole& role = roles[rig.mesh.F(t, k)];
      own &= role.own;
      near |= role.near;
    }
    candidate[t] = own && near;
  }
  const Neighbours neighbours = EdgeConnectivity(rig.mesh.F).across();
  std::vector<bool> in_region(candidate.size(), false);
  flood(neighbours, seeds(rig, region, candidate), in_region, [&](int t) { return candidate[t]; });
  absorb_islands(rig.mesh, neighbours, in_region);
  for (int t = 0; t < std::ssize(in_region); ++t) {
    if (in_region[t]) region.triangles.push_back(t);
  }
  region.border_loops = trace_loops(rig.mesh.F, neighbours, in_region);
  return region;
}

double border_rigidity(const RiggedMesh& rig, const JointRegion& region) {
  const std::vector<int> group = rigid_groups(rig.skeleton, region);
  double least = 1;
  for (const std::vector<int>& loop : region.border_loops) {
    for (const int v : loop) least = std::min(least, rigidity(rig.weights, v, group));
  }
  return least;
}

std::vector<int> region_vertices(const JointRegion& region, const Eigen::MatrixX3i& F) {
  std::vector<int> vertices;
  vertices.reserve(region.triangles.size() * 3);
  for (const int t : region.triangles) {
    for (int k = 0; k < 3; ++k) vertices.push_back(F(t, k));
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace geoprior
