#include "models/skinning/heat_weights.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "core/parallel.h"
#include "models/skinning/bone_visibility.h"
#include "models/skinning/cotangent_laplacian.h"

namespace geoprior::skinning {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Heat that a vertex exchanges with bones: H and the bones (indices) it is shared by.
struct Contact {
  double heat = 0;
  std::vector<int> bones;
};

/// Distances that differ by less than this share are equal (the two bones at a joint).
constexpr double kTie = 1e-4;

/// The nearest bones that `visible(bone, nearest point)` accepts.
template <class Visible>
Contact nearest_bones(const Eigen::Vector3d& p, const std::vector<Bone>& bones, double heat,
                      double smallest_distance, const Visible& visible) {
  std::vector<std::pair<double, int>> by_distance;
  for (std::size_t j = 0; j < bones.size(); ++j)
    by_distance.emplace_back((bones[j].nearest(p) - p).norm(), static_cast<int>(j));
  std::sort(by_distance.begin(), by_distance.end());
  Contact contact;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [distance, bone] : by_distance) {
    if (distance > nearest * (1 + kTie)) break;
    if (!visible(bones[bone].nearest(p))) continue;
    if (contact.bones.empty()) nearest = distance;
    contact.bones.push_back(bone);
  }
  const double d = std::max(nearest, smallest_distance);
  if (!contact.bones.empty())
    contact.heat = static_cast<double>(contact.bones.size()) * heat / (d * d);
  return contact;
}

/// Vertices joined by common triangles.
DisjointSets components(const TriMesh& mesh) {
  DisjointSets sets(mesh.vertex_count());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 2; ++k) sets.join(mesh.F(t, k), mesh.F(t, k + 1));
  }
  return sets;
}

std::vector<Contact> bone_contacts(const TriMesh& mesh, const std::vector<Bone>& bones,
                                   double heat) {
  const auto n = static_cast<std::size_t>(mesh.vertex_count());
  const double smallest_distance = 1e-9 * bounding_box_diagonal(mesh.V);
  std::vector<Contact> contacts(n);
  const InsideVisibility visibility(mesh);
  parallel_blocks(n, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto row = static_cast<int>(v);
      contacts[v] =
          nearest_bones(mesh.V.row(row), bones, heat, smallest_distance,
                        [&](const Eigen::Vector3d& q) { return visibility.sees(row, q); });
    }
  });
  DisjointSets component = components(mesh);
  std::vector<bool> heated(n, false);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (contacts[v].heat > 0) heated[component.find(v)] = true;
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (heated[component.find(v)]) continue;
    contacts[v] = nearest_bones(mesh.V.row(v), bones, heat, smallest_distance,
                                [](const Eigen::Vector3d&) { return true; });
  }
  return contacts;
}

/// A third of the area of the triangles around each vertex (m^2).
Eigen::VectorXd barycentric_areas(const TriMesh& mesh) {
  Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector3d p = mesh.V.row(mesh.F(t, k));
      const Eigen::RowVector3d to_a = mesh.V.row(mesh.F(t, (k + 1) % 3)) - p;
      const Eigen::RowVector3d to_b = mesh.V.row(mesh.F(t, (k + 2) % 3)) - p;
      area(mesh.F(t, k)) += to_a.cross(to_b).norm() / 6;
    }
  }
  return area;
}

/// Temperatures, one column a bone.
Eigen::MatrixXd equilibrium(const TriMesh& mesh, const std::vector<Contact>& contacts,
                            std::size_t bone_count) {
  const Eigen::VectorXd area = barycentric_areas(mesh);
  Sparse system = positive_cotangent_laplacian(mesh);
  const double smallest_area = 1e-9 * area.mean();
  Eigen::MatrixXd rhs =
      Eigen::MatrixXd::Zero(mesh.vertex_count(), static_cast<Eigen::Index>(bone_count));
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Contact& contact = contacts[v];
    if (contact.bones.empty()) continue;
    const double h = std::max(area(v), smallest_area > 0 ? smallest_area : 1.0) * contact.heat;
    system.coeffRef(v, v) += h;
    for (const int bone : contact.bones)
      rhs(v, bone) = h / static_cast<double>(contact.bones.size());
  }
  const Eigen::SimplicialLDLT<Sparse> factor(system);
  if (factor.info() != Eigen::Success)
    throw Error("the heat equation of the skin weights has no unique solution", "heat weights");
  Eigen::MatrixXd temperature(rhs.rows(), rhs.cols());
  parallel_blocks(bone_count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      temperature.col(column) = factor.solve(rhs.col(column));
    }
  });
  return temperature;
}

/// The strongest entries of each row, renormalised.
SkinWeights strongest(const Eigen::MatrixXd& temperature, const std::vector<Bone>& bones,
                      int joint_count, const HeatWeightsOptions& options) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<std::pair<double, int>> row;
  for (Eigen::Index v = 0; v < temperature.rows(); ++v) {
    row.clear();
    for (std::size_t j = 0; j < bones.size(); ++j)
      row.emplace_back(temperature(v, static_cast<Eigen::Index>(j)), bones[j].joint);
    std::stable_sort(row.begin(), row.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (options.max_influences > 0)
      row.resize(std::min(row.size(), static_cast<std::size_t>(options.max_influences)));
    while (row.size() > 1 && !(row.back().first > options.smallest_weight)) row.pop_back();
    double sum = 0;
    for (const auto& entry : row) sum += entry.first;
    for (const auto& [w, joint] : row) entries.emplace_back(static_cast<int>(v), joint, w / sum);
  }
  SkinWeights weights(temperature.rows(), joint_count);
  weights.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

void check(const TriMesh& mesh, const HeatWeightsOptions& options) {
  if (!(options.heat > 0) || !std::isfinite(options.heat))
    throw Error("heat is not positive", "heat weights", "> 0");
  if (options.max_influences < 0) throw Error("max_influences is negative", "heat weights", ">= 0");
  if (!(options.smallest_weight >= 0 && options.smallest_weight < 0.1))
    throw Error("smallest_weight is out of range", "heat weights", "0 to 0.1");
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (!mesh.V.row(v).allFinite())
      throw Error("position is not finite", "vertex " + std::to_string(v));
  }
}

}  // namespace

void describe(OptionVisitor& v, HeatWeightsOptions& options) {
  v.value("heat", options.heat,
          {.doc = "c in H = c / d^2: how strongly a bone holds the skin nearest to it",
           .min = 1e-6,
           .max = 1e6});
  v.value(
      "max_influences", options.max_influences,
      {.doc = "strongest influences kept and renormalised; 0 keeps all", .min = 0, .max = 65535});
  v.value("smallest_weight", options.smallest_weight,
          {.doc = "weaker influences are dropped", .min = 0, .max = 0.1});
}

SkinWeights heat_weights(const TriMesh& mesh, const Skeleton& skeleton,
                         const HeatWeightsOptions& options) {
  validate(skeleton);
  check(mesh, options);
  const std::vector<Bone> bones = bones_of(skeleton);
  if (bones.empty())
    throw Error("no joint has a bone (a tail)", "skeleton", "at least one joint with a tail");
  if (mesh.vertex_count() == 0) return {0, skeleton.size()};
  const std::vector<Contact> contacts = bone_contacts(mesh, bones, options.heat);
  SkinWeights weights =
      strongest(equilibrium(mesh, contacts, bones.size()), bones, skeleton.size(), options);
  validate(weights, mesh.vertex_count(), skeleton.size());
  return weights;
}

}  // namespace geoprior::skinning
