#include "baselines/sketch/angle_defect_flow.h"

#include "core/angles.h"
#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::sketch {
namespace {

constexpr std::size_t kDefectsTogether = 1024;

/// closeness A_v / (A h^2) of every vertex; zeros for a closeness of zero.
Eigen::VectorXd hold_weights(const TriMesh& mesh, double closeness) {
  Eigen::VectorXd hold = Eigen::VectorXd::Zero(mesh.vertex_count());
  if (closeness < 0) throw Error("closeness is negative", "angle defect flow", "0 or more");
  const Eigen::VectorXd areas = triangle_areas(mesh.V, mesh.F);
  if (!(closeness > 0) || !(areas.sum() > 0)) return hold;
  double edge = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      hold(mesh.F(t, k)) += areas(t) / 3;
      edge += (mesh.V.row(mesh.F(t, k)) - mesh.V.row(mesh.F(t, (k + 1) % 3))).norm();
    }
  }
  edge /= static_cast<double>(3 * mesh.F.rows());
  return hold * (closeness / (areas.sum() * edge * edge));
}

}  // namespace

AngleDefectEnergy::AngleDefectEnergy(const TriMesh& mesh, double closeness)
    : stars_(mesh.F, mesh.vertex_count()), start_(mesh.V), hold_(hold_weights(mesh, closeness)) {
  derivatives_.by_angle.setZero(stars_.corner_count());
  derivatives_.by_normal.setZero(3, stars_.corner_count());
}

double AngleDefectEnergy::operator()(const Eigen::MatrixX3d& x, Eigen::MatrixX3d* gradient) {
  stars_.measure(x);
  at_vertex_.setZero(stars_.vertex_count());
  const auto add_star = [&](int v) {
    double defect = kFullTurn;
    for (const int c : stars_.corners().of(v)) defect -= stars_.angle(c);
    at_vertex_(v) = defect * defect;
    for (const int c : stars_.corners().of(v)) derivatives_.by_angle(c) = -2 * defect;
  };
  parallel_blocks(stars_.vertex_count(), kDefectsTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (stars_.interior(static_cast<int>(i))) add_star(static_cast<int>(i));
  });
  const Eigen::MatrixX3d moved = x - start_;
  if (gradient != nullptr) {
    stars_.gradient(derivatives_, *gradient);
    *gradient += 2 * hold_.asDiagonal() * moved;
  }
  return at_vertex_.sum() + hold_.dot(moved.rowwise().squaredNorm());
}

void describe(OptionVisitor& v, AngleDefectFlowOptions& options) {
  v.value("closeness", options.closeness,
          {.doc = "weight of the term that holds vertices near where they were", .min = 0});
  describe_group(v, "descent", options.descent, {.doc = "how the squared defects are descended"});
}

AngleDefectFlow::AngleDefectFlow(const TriMesh& mesh, const AngleDefectFlowOptions& options)
    : descent_(mesh, AngleDefectEnergy(mesh, options.closeness), options.descent) {}

}  // namespace geoprior::sketch
