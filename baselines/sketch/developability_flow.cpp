#include "baselines/sketch/developability_flow.h"

#include "baselines/sketch/shared/symmetric_eigen.h"
#include "core/parallel.h"

namespace geoprior::sketch {
namespace {

constexpr std::size_t kHingesTogether = 256;

}  // namespace

double HingeEnergy::add_vertex(int v) {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  for (const int c : stars_.corners().of(v)) {
    const Eigen::Vector3d n = stars_.normal(c);
    normals += stars_.angle(c) * n * n.transpose();
  }
  const Eigen::Vector3d axis = smallest_eigenvector(normals);
  double energy = 0;
  for (const int c : stars_.corners().of(v)) {
    const double off = stars_.normal(c).dot(axis);
    energy += stars_.angle(c) * off * off;
    derivatives_.by_angle(c) = off * off;
    derivatives_.by_normal.col(c) = 2 * stars_.angle(c) * off * axis;
  }
  return energy;
}

double HingeEnergy::operator()(const Eigen::MatrixX3d& x, Eigen::MatrixX3d* gradient) {
  stars_.measure(x);
  derivatives_.by_angle.setZero(stars_.corner_count());
  derivatives_.by_normal.setZero(3, stars_.corner_count());
  at_vertex_.setZero(stars_.vertex_count());
  parallel_blocks(stars_.vertex_count(), kHingesTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int v = static_cast<int>(i);
      if (stars_.interior(v)) at_vertex_(v) = add_vertex(v);
    }
  });
  if (gradient != nullptr) stars_.gradient(derivatives_, *gradient);
  return at_vertex_.sum();
}

void describe(OptionVisitor& v, DevelopabilityFlowOptions& options) {
  describe_group(v, "descent", options.descent, {.doc = "how the hinge energy is descended"});
}

DevelopabilityFlow::DevelopabilityFlow(const TriMesh& mesh,
                                       const DevelopabilityFlowOptions& options)
    : descent_(mesh, HingeEnergy(mesh.F, mesh.vertex_count()), options.descent) {}

}  // namespace geoprior::sketch
