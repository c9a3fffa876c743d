#include "experiments/skinning/weights/narrow_weights.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "experiments/skinning/weights/bone_skins.h"
#include "experiments/skinning/weights/weight_rows.h"
#include "models/skinning/surface_diffusion.h"

namespace geoprior::skinning {
namespace {

/// Width of the falloff over the length l of the blur. Where k bones meet, u reaches 1/k, and the
/// falloff covers u > exp(-kWidthOverBlur / 2) / 2 = 0.11: one bone of eight still holds the skin.
constexpr double kWidthOverBlur = 3;

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
  require_influence_limit(options.max_influences, "narrow weights");
}

}  // namespace

void describe(OptionVisitor& v, NarrowWeightsOptions& options) {
  v.value(
      "width", options.width,
      {.doc = "width of the band across a joint over which the weight passes from bone to bone, "
              "in local radii",
       .min = 0.01,
       .max = 20});
  describe_influence_limit(v, options.max_influences);
}

SkinWeights narrow_weights(const TriMesh& mesh, const Skeleton& skeleton,
                           const NarrowWeightsOptions& options) {
  check(options);
  const std::vector<Bone> bones = require_bones(mesh, skeleton);
  if (mesh.vertex_count() == 0) return {0, skeleton.size()};
  const std::vector<BoneContact> contacts = bone_contacts(mesh, bones);
  const Eigen::MatrixXd skin = bone_skins(mesh, bones, contacts);
  const Eigen::VectorXd blur = options.width / kWidthOverBlur * local_radii(mesh, bones, contacts);
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
