#include "experiments/skinning/weights/bounded_weights.h"

#include <cmath>

#include "core/error.h"
#include "experiments/skinning/weights/bone_skins.h"
#include "experiments/skinning/weights/weight_rows.h"
#include "models/skinning/surface_diffusion.h"

namespace geoprior::skinning {
namespace {

/// Changes of a bone's active set after which the weights are refused: a guard of ours, for meshes
/// whose active set never settles.
constexpr int kMostPivots = 300;

/// Half the integral of l^4 (laplacian w)^2 is w^T (this) w / 2.
Eigen::SparseMatrix<double> biharmonic_energy(const TriMesh& mesh, const Eigen::VectorXd& area,
                                              const Eigen::VectorXd& length) {
  const Eigen::SparseMatrix<double> laplacian = positive_cotangent_laplacian(mesh);
  const Eigen::VectorXd scale = length.array().pow(4) / area.array();
  return laplacian * scale.asDiagonal() * laplacian;
}

void require_bounded_options(const BoundedWeightsOptions& options) {
  if (!(options.length > 0) || !std::isfinite(options.length))
    throw Error("length is not positive", "bounded weights", "> 0");
  require_influence_limit(options.max_influences, "bounded weights");
}

}  // namespace

void describe(OptionVisitor& v, BoundedWeightsOptions& options) {
  v.value("length", options.length,
          {.doc = "l: how far a joint is smoothed to both sides, in local radii",
           .min = 0.01,
           .max = 20});
  describe_influence_limit(v, options.max_influences);
}

BoxSolution bounded_biharmonic(const TriMesh& mesh, const std::vector<Bone>& bones,
                               const BoundedWeightsOptions& options) {
  const std::vector<BoneContact> contacts = bone_contacts(mesh, bones);
  BoxProgram program;
  program.C = bone_skins(mesh, bones, contacts);
  const Eigen::VectorXd area = vertex_areas(mesh);
  program.Q = biharmonic_energy(mesh, area.cwiseMax(1e-3 * area.mean()),
                                options.length * local_radii(mesh, bones, contacts));
  program.Q.diagonal() += program.C.rowwise().sum();
  return solve_in_box(program, kMostPivots);
}

SkinWeights bounded_weights(const TriMesh& mesh, const Skeleton& skeleton,
                            const BoundedWeightsOptions& options) {
  require_bounded_options(options);
  const std::vector<Bone> bones = require_bones(mesh, skeleton);
  if (mesh.vertex_count() == 0) return {0, skeleton.size()};
  const BoxSolution solution = bounded_biharmonic(mesh, bones, options);
  SkinWeights weights =
      strongest_influences(solution.X, bones, skeleton.size(), options.max_influences);
  validate(weights, mesh.vertex_count(), skeleton.size());
  return weights;
}

}  // namespace geoprior::skinning
