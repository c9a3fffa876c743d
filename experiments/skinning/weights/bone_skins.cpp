#include "experiments/skinning/weights/bone_skins.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "models/skinning/surface_diffusion.h"

namespace geoprior::skinning {
namespace {

/// Length over which the local radius is averaged, over itself: once around a limb it varies by a
/// fifth of what the distance to the bone does.
constexpr double kRadiusBlur = 2;

/// A triangle that several bones share is cut into kCuts^2 similar ones, each of one bone.
constexpr int kCuts = 6;

double nearest_distance(const Eigen::Vector3d& x, const std::vector<Bone>& bones) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Bone& bone : bones) nearest = std::min(nearest, (bone.nearest(x) - x).norm());
  return nearest;
}

/// How far a point lies on a bone's side of the joint at the bone's end, up to what all bones with
/// the same nearest point share.
double lean(const Bone& bone, const Eigen::Vector3d& x) {
  const Eigen::Vector3d axis = (bone.tail - bone.head).normalized();
  const Eigen::Vector3d r = x - bone.nearest(x);
  return (x - bone.head).dot(axis) < 0 ? r.dot(axis) : -r.dot(axis);
}

/// The nearest of some bones; of equally near ones, that on whose side of their joint's bisector
/// plane the point lies.
int nearest_of(const std::vector<int>& candidates, const std::vector<Bone>& bones,
               const Eigen::Vector3d& x) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const int b : candidates) nearest = std::min(nearest, (bones[b].nearest(x) - x).norm());
  int chosen = -1;
  double most = 0;
  for (const int b : candidates) {
    if ((bones[b].nearest(x) - x).norm() > nearest * (1 + kEqualDistances)) continue;
    const double side = lean(bones[b], x);
    if (chosen >= 0 && side <= most) continue;
    chosen = b;
    most = side;
  }
  return chosen;
}

/// Bones that hold the corners of a triangle, ascending.
std::vector<int> bones_at(const TriMesh& mesh, Eigen::Index t,
                          const std::vector<BoneContact>& contacts) {
  std::vector<int> bones;
  for (int k = 0; k < 3; ++k) {
    const std::vector<int>& here = contacts[mesh.F(t, k)].bones;
    bones.insert(bones.end(), here.begin(), here.end());
  }
  std::sort(bones.begin(), bones.end());
  bones.erase(std::unique(bones.begin(), bones.end()), bones.end());
  return bones;
}

/// Barycentric coordinates of the centroids of the similar triangles that a triangle is cut into.
std::vector<Eigen::Vector3d> cut_centroids() {
  std::vector<Eigen::Vector3d> centroids;
  const auto add = [&](double i, double j) {
    centroids.emplace_back(i / kCuts, j / kCuts, 1 - (i + j) / kCuts);
  };
  for (int i = 0; i < kCuts; ++i) {
    for (int j = 0; i + j < kCuts; ++j) {
      add(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j + 1 < kCuts) add(i + 2.0 / 3, j + 2.0 / 3);
    }
  }
  return centroids;
}

/// A vertex without triangles has no area of its own: it holds to its bones.
void hold_lone_vertices(const std::vector<BoneContact>& contacts, Eigen::MatrixXd& skin) {
  const double mean = skin.sum() / static_cast<double>(skin.rows());
  for (Eigen::Index v = 0; v < skin.rows(); ++v) {
    const std::vector<int>& bones = contacts[v].bones;
    if (bones.empty() || skin.row(v).sum() > 0) continue;
    for (const int b : bones) skin(v, b) = mean / static_cast<double>(bones.size());
  }
}

}  // namespace

Eigen::MatrixXd bone_skins(const TriMesh& mesh, const std::vector<Bone>& bones,
                           const std::vector<BoneContact>& contacts) {
  const std::vector<Eigen::Vector3d> centroids = cut_centroids();
  const Eigen::VectorXd area = triangle_areas(mesh.V, mesh.F);
  Eigen::MatrixXd skin = Eigen::MatrixXd::Zero(mesh.vertex_count(), bones.size());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const std::vector<int> candidates = bones_at(mesh, t, contacts);
    if (candidates.empty()) continue;
    if (candidates.size() == 1) {
      for (int k = 0; k < 3; ++k) skin(mesh.F(t, k), candidates[0]) += area(t) / 3;
      continue;
    }
    for (const Eigen::Vector3d& centroid : centroids) {
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) x += centroid(k) * mesh.V.row(mesh.F(t, k)).transpose();
      const int bone = nearest_of(candidates, bones, x);
      for (int k = 0; k < 3; ++k)
        skin(mesh.F(t, k), bone) += area(t) * centroid(k) / static_cast<double>(centroids.size());
    }
  }
  if (!(skin.sum() > 0))
    throw Error("no skin lies nearest to any bone", "skin weights", "triangles with an area");
  hold_lone_vertices(contacts, skin);
  return skin;
}

Eigen::VectorXd local_radii(const TriMesh& mesh, const std::vector<Bone>& bones,
                            const std::vector<BoneContact>& contacts) {
  const double least = 1e-6 * bounding_box_diagonal(mesh.V);
  Eigen::VectorXd distance(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double d =
        contacts[v].bones.empty() ? nearest_distance(mesh.V.row(v), bones) : contacts[v].distance;
    distance(v) = std::max(d, least);
  }
  Eigen::VectorXd area = vertex_areas(mesh);
  area = area.cwiseMax(1e-9 * area.mean());
  Eigen::SparseMatrix<double> system =
      positive_cotangent_laplacian(mesh, squared_at_triangles(mesh, kRadiusBlur * distance));
  system.diagonal() += area;
  return solve_columns(system, area.cwiseProduct(distance), "the average of the local radius");
}

}  // namespace geoprior::skinning
