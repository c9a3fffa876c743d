#include "solvers/paper/shell/bending_guide.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/meshing/uniform_mesh.h"

namespace geoprior::paper {
namespace {

/// Length of the step from rest (s). A wave of 4 cm of office paper swings within 4 ms, so that
/// what is shorter has settled after it.
constexpr double kStep = 0.006;

Eigen::MatrixX3d vertex_means(const ShellMesh& mesh, const Eigen::MatrixX3d& of_triangles) {
  Eigen::MatrixX3d sum = Eigen::MatrixX3d::Zero(mesh.vertex_count(), 3);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      sum.row(mesh.triangles(f, k)) += of_triangles.row(f);
      count[mesh.triangles(f, k)] += 1;
    }
  }
  return sum.array().colwise() / count.array();
}

}  // namespace

BendingField::BendingField(ShellState sheet, Eigen::MatrixX3d curvature)
    : sheet_(std::move(sheet)), curvature_(std::move(curvature)), locator_(sheet_.mesh) {}

Eigen::Matrix2d BendingField::at(const Eigen::Vector2d& p) const {
  const PatternLocator::Place place = locator_.locate(p);
  Eigen::RowVector3d s = Eigen::RowVector3d::Zero();
  for (int k = 0; k < 3; ++k)
    s += place.weights[k] * curvature_.row(sheet_.mesh.triangles(place.triangle, k));
  Eigen::Matrix2d S;
  S << s[0], s[1], s[1], s[2];
  return S;
}

BendingGuide::BendingGuide(const Sheet& sheet, const Pattern& pattern, double edge,
                           const StepperOptions& options, std::uint64_t seed)
    : stepper_(sheet, options, seed) {
  require_lattice(pattern, edge);
  const double triangles = signed_area(pattern) / (std::sqrt(3.0) / 4 * edge * edge);
  mesh_ = uniform_mesh(pattern, std::max(2, static_cast<int>(std::lround(triangles))),
                       UniformLayout::equilateral, handle_points(sheet, edge), seed);
}

BendingField BendingGuide::relaxed(const ShellState& sheet) {
  ShellState even = transfer_state(sheet, mesh_);
  if (!analysed_) stepper_.set_mesh(even);
  analysed_ = true;
  try {
    stepper_.relax(even, kStep);
  } catch (const Error&) {
    // What the step does not follow is taken as it is.
    even = transfer_state(sheet, mesh_);
  }
  Eigen::MatrixX3d curvature = vertex_means(mesh_, stepper_.shape_operators(even));
  return {std::move(even), std::move(curvature)};
}

}  // namespace geoprior::paper
