#include "solvers/skinning/base/spread_weights.h"

#include <algorithm>
#include <vector>

#include "baselines/skinning/direct_delta_mush/implicit_smoothing.h"
#include "models/skinning/surface_diffusion.h"

namespace geoprior::skinning {
namespace {

constexpr int kSteps = 4;              // of the diffusion
constexpr double kLeastWeight = 1e-3;  // that is kept
constexpr Eigen::Index kColumns = 12;  // of joints that are spread together

using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Largest {
  int joint = 0;
  double weight = -1;
};

}  // namespace

SkinWeights spread_weights(const RiggedMesh& rig, const Eigen::VectorXd& length, double width) {
  const Eigen::VectorXd area = vertex_areas(rig.mesh);
  const double least_area = std::max(area.maxCoeff() * 1e-9, 1e-300);
  const Eigen::VectorXd mass = area.cwiseMax(least_area).cwiseQuotient(length.cwiseAbs2());
  const ImplicitSmoothing smoothing(rig.mesh, mass, width * width / kSteps, kSteps);

  const Eigen::SparseMatrix<double> by_joint = rig.weights;
  const Eigen::Index vertices = by_joint.rows(), joints = by_joint.cols();
  std::vector<Eigen::Triplet<double>> kept;
  std::vector<Largest> largest(vertices);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(vertices);
  for (Eigen::Index first = 0; first < joints; first += kColumns) {
    Columns some = by_joint.middleCols(first, std::min(kColumns, joints - first));
    smoothing.apply(some);
    for (Eigen::Index v = 0; v < vertices; ++v) {
      for (Eigen::Index k = 0; k < some.cols(); ++k) {
        const auto joint = static_cast<int>(first + k);
        if (some(v, k) > largest[v].weight) largest[v] = {joint, some(v, k)};
        if (some(v, k) < kLeastWeight) continue;
        kept.emplace_back(static_cast<int>(v), joint, some(v, k));
        sum(v) += some(v, k);
      }
    }
  }
  // A vertex that hundreds of joints share keeps one.
  for (Eigen::Index v = 0; v < vertices; ++v) {
    if (sum(v) > 0) continue;
    kept.emplace_back(static_cast<int>(v), largest[v].joint, 1.0);
    sum(v) = 1;
  }
  SkinWeights spread(vertices, joints);
  spread.setFromTriplets(kept.begin(), kept.end());
  for (Eigen::Index v = 0; v < vertices; ++v)
    for (SkinWeights::InnerIterator w(spread, v); w; ++w) w.valueRef() /= sum(v);
  return spread;
}

}  // namespace geoprior::skinning
