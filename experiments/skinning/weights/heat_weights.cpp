#include "experiments/skinning/weights/heat_weights.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "experiments/skinning/weights/bone_contacts.h"
#include "models/skinning/surface_diffusion.h"

namespace geoprior::skinning {
namespace {

/// Temperatures, one column a bone.
Eigen::MatrixXd equilibrium(const TriMesh& mesh, const std::vector<BoneContact>& contacts,
                            std::size_t bone_count, double c) {
  const Eigen::VectorXd area = vertex_areas(mesh);
  Eigen::SparseMatrix<double> system = positive_cotangent_laplacian(mesh);
  const double smallest_area = 1e-9 * area.mean();
  const double smallest_distance = 1e-9 * bounding_box_diagonal(mesh.V);
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(mesh.vertex_count(), bone_count);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const std::vector<int>& nearest = contacts[v].bones;
    if (nearest.empty()) continue;
    const auto count = static_cast<double>(nearest.size());
    const double d = std::max(contacts[v].distance, smallest_distance);
    const double heat = count * c / (d * d);
    const double h = std::max(area(v), smallest_area > 0 ? smallest_area : 1.0) * heat;
    system.coeffRef(v, v) += h;
    for (const int bone : nearest) rhs(v, bone) = h / count;
  }
  return solve_columns(system, rhs, "the heat equation");
}

/// The strongest entries of each row, renormalised.
SkinWeights strongest(const Eigen::MatrixXd& temperature, const std::vector<Bone>& bones,
                      int joint_count, const HeatWeightsOptions& options) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<std::pair<double, int>> row;
  for (Eigen::Index v = 0; v < temperature.rows(); ++v) {
    row.clear();
    for (std::size_t j = 0; j < bones.size(); ++j)
      row.emplace_back(temperature(v, j), bones[j].joint);
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

void check(const HeatWeightsOptions& options) {
  if (!(options.heat > 0) || !std::isfinite(options.heat))
    throw Error("heat is not positive", "heat weights", "> 0");
  if (options.max_influences < 0) throw Error("max_influences is negative", "heat weights", ">= 0");
  if (!(options.smallest_weight >= 0 && options.smallest_weight < 0.1))
    throw Error("smallest_weight is out of range", "heat weights", "0 to 0.1");
}

}  // namespace

void describe(OptionVisitor& v, HeatWeightsOptions& options) {
  v.value("heat", options.heat,
          {.doc = "c in H = c / d^2: how strongly a bone holds the skin nearest to it",
           .min = 1e-6,
           .max = 1e6});
  v.value(
      "max_influences", options.max_influences,
      {.doc =
           "influences of a vertex that are kept, strongest first, and renormalised; 0 keeps all",
       .min = 0,
       .max = 65535});
  v.value("smallest_weight", options.smallest_weight,
          {.doc = "weight below which an influence is dropped", .min = 0, .max = 0.1});
}

SkinWeights heat_weights(const TriMesh& mesh, const Skeleton& skeleton,
                         const HeatWeightsOptions& options) {
  check(options);
  const std::vector<Bone> bones = require_bones(mesh, skeleton);
  if (mesh.vertex_count() == 0) return {0, skeleton.size()};
  const Eigen::MatrixXd temperature =
      equilibrium(mesh, bone_contacts(mesh, bones), bones.size(), options.heat);
  SkinWeights weights = strongest(temperature, bones, skeleton.size(), options);
  validate(weights, mesh.vertex_count(), skeleton.size());
  return weights;
}

}  // namespace geoprior::skinning
