#include "models/skinning/narrow_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "models/skinning/bone_contacts.h"
#include "models/skinning/surface_diffusion.h"
#include "models/skinning/weight_rows.h"

namespace geoprior::skinning {
namespace {

/// Width of the falloff over the length l of the blur. Where k bones meet, u reaches 1/k, and the
/// falloff covers u > exp(-kWidthOverBlur / 2) / 2 = 0.11: one bone of eight still holds the skin.
constexpr double kWidthOverBlur = 3;

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

Eigen::VectorXd squared_at_triangles(const TriMesh& mesh, const Eigen::VectorXd& length) {
  Eigen::VectorXd squared(mesh.triangle_count());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const double mean = (length(mesh.F(t, 0)) + length(mesh.F(t, 1)) + length(mesh.F(t, 2))) / 3;
    squared(t) = mean * mean;
  }
  return squared;
}

/// Distance to the nearest bone (seen, where one is), averaged along the surface.
Eigen::VectorXd local_radius(const TriMesh& mesh, const std::vector<Bone>& bones,
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

/// Integral of every vertex' hat function over the skin of every bone (m^2): n x bones.
Eigen::MatrixXd skin_of_bones(const TriMesh& mesh, const std::vector<Bone>& bones,
                              const std::vector<BoneContact>& contacts) {
  const std::vector<Eigen::Vector3d> centroids = cut_centroids();
  const Eigen::VectorXd area = triangle_areas(mesh.V, mesh.F);
  Eigen::MatrixXd skin =
      Eigen::MatrixXd::Zero(mesh.vertex_count(), static_cast<Eigen::Index>(bones.size()));
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
  return skin;
}

/// A vertex without triangles has no area of its own: it holds to its bones.
void hold_lone_vertices(const std::vector<BoneContact>& contacts, Eigen::MatrixXd& skin) {
  const double mean = skin.sum() / static_cast<double>(skin.rows());
  for (Eigen::Index v = 0; v < skin.rows(); ++v) {
    const std::vector<int>& bones = contacts[static_cast<std::size_t>(v)].bones;
    if (bones.empty() || skin.row(v).sum() > 0) continue;
    for (const int b : bones) skin(v, b) = mean / static_cast<double>(bones.size());
  }
}

double smoothstep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Falloff at a value of the blurred skin of a bone: 1/2 + d / width, with d the signed distance
/// from the border of its skin.
double falloff(double u) {
  const double tail = std::clamp(std::min(u, 1 - u), 1e-300, 0.5);
  const double distance = -std::log(2 * tail) / kWidthOverBlur;
  return smoothstep(0.5 + (u > 0.5 ? distance : -distance));
}

void check(const NarrowWeightsOptions& options) {
  if (!(options.width > 0) || !std::isfinite(options.width))
    throw Error("width is not positive", "narrow weights", "> 0");
  if (options.max_influences < 0)
    throw Error("max_influences is negative", "narrow weights", ">= 0");
}

}  // namespace

void describe(OptionVisitor& v, NarrowWeightsOptions& options) {
  v.value("width", options.width,
          {.doc = "of the band across a joint over which the weight passes from bone to bone, in "
                  "local radii",
           .min = 0.01,
           .max = 20});
  v.value("max_influences", options.max_influences,
          {.doc = "strongest influences kept, less the largest left out, and renormalised; 0 keeps "
                  "all",
           .min = 0,
           .max = 65535});
}

SkinWeights narrow_weights(const TriMesh& mesh, const Skeleton& skeleton,
                           const NarrowWeightsOptions& options) {
  check(options);
  const std::vector<Bone> bones = require_bones(mesh, skeleton);
  if (mesh.vertex_count() == 0) return {0, skeleton.size()};
  const std::vector<BoneContact> contacts = bone_contacts(mesh, bones);
  Eigen::MatrixXd skin = skin_of_bones(mesh, bones, contacts);
  if (!(skin.sum() > 0)) throw Error("the mesh has no area", "narrow weights");
  hold_lone_vertices(contacts, skin);
  const Eigen::VectorXd blur = options.width / kWidthOverBlur * local_radius(mesh, bones, contacts);
  Eigen::SparseMatrix<double> system =
      positive_cotangent_laplacian(mesh, squared_at_triangles(mesh, blur));
  system.diagonal() += skin.rowwise().sum();
  const Eigen::MatrixXd blurred = solve_columns(system, skin, "the blur of the bones' skins");
  SkinWeights weights = strongest_influences(blurred.unaryExpr(&falloff), bones, skeleton.size(),
                                             options.max_influences);
  validate(weights, mesh.vertex_count(), skeleton.size());
  return weights;
}

}  // namespace geoprior::skinning
