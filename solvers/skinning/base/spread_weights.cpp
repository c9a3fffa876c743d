#include "solvers/skinning/base/spread_weights.h"

#include <algorithm>
#include <vector>

#include "baselines/skinning/direct_delta_mush/implicit_smoothing.h"
#include "models/skinning/surface_diffusion.h"

namespace geoprior::skinning {
namespace {

constexpr int kSteps = 4;              // of the diffusion
constexpr double kLeastWeight = 1e-3;  // that is kept

}  // namespace

SkinWeights spread_weights(const RiggedMesh& rig, const Eigen::VectorXd& radius, double width) {
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Columns dense = rig.weights;
  const Eigen::VectorXd area = vertex_areas(rig.mesh);
  const double least_area = std::max(area.maxCoeff() * 1e-9, 1e-300);
  const Eigen::VectorXd mass = area.cwiseMax(least_area).cwiseQuotient(radius.cwiseAbs2());
  ImplicitSmoothing(rig.mesh, mass, width * width / kSteps, kSteps).apply(dense);

  dense = (dense.array() >= kLeastWeight).select(dense, 0.0);
  const Eigen::VectorXd sum = dense.rowwise().sum();
  SkinWeights spread = dense.sparseView();
  for (Eigen::Index v = 0; v < spread.rows(); ++v) {
    if (sum(v) > 0)
      for (SkinWeights::InnerIterator w(spread, v); w; ++w) w.valueRef() /= sum(v);
  }
  spread.makeCompressed();
  return spread;
}

}  // namespace geoprior::skinning
